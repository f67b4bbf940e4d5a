// Trajectories for tests: what other programs' files hold, as text, and bytes put together by hand.
#pragma once
#include "formats/trajectory.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpa::test {

inline std::string trajectory_path(const std::string& name) {
    return test_data("trajectories/" + name);
}

inline std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    return {std::istreambuf_iterator<char>(file), {}};
}

// One frame as make_trajectories.py writes it, in the units of its file.
struct TextFrame {
    std::int64_t step = 0;
    double time = 0;
    std::vector<double> box;                 // 9 numbers, edge by edge
    std::vector<std::vector<double>> atoms;  // 3 numbers each: place; 9: velocity and force as well
};

inline std::vector<TextFrame> read_text_frames(const std::string& name) {
    std::istringstream text(bytes_of(trajectory_path(name)));
    std::vector<TextFrame> frames;
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        if (line.starts_with("frame ")) {
            words.ignore(6);
            words >> frames.emplace_back().step >> frames.back().time;
            continue;
        }
        const bool is_box = line.starts_with("box");
        if (is_box) words.ignore(3);
        std::vector<double> numbers;
        for (double number = 0; words >> number;) numbers.push_back(number);
        if (is_box) {
            frames.back().box = numbers;
        } else {
            frames.back().atoms.push_back(numbers);
        }
    }
    return frames;
}

// Numbers in either byte order, put together without help from the code under test.
class Bytes {
public:
    explicit Bytes(std::endian order) : order_(order) {}

    template <class T>
    Bytes& add(T value) {
        std::string raw(sizeof(T), '\0');
        std::memcpy(raw.data(), &value, sizeof(T));
        text += order_ == std::endian::native ? raw : std::string(raw.rbegin(), raw.rend());
        return *this;
    }
    Bytes& integer(std::int32_t value) { return add(value); }
    Bytes& real(double value) { return add(static_cast<float>(value)); }

    // A record of Fortran: its length before and behind it.
    Bytes& record(const Bytes& content) {
        integer(static_cast<std::int32_t>(content.text.size()));
        text += content.text;
        return integer(static_cast<std::int32_t>(content.text.size()));
    }

    std::string text;

private:
    std::endian order_;
};

inline std::vector<Vec3> positions_of(Trajectory& trajectory, std::size_t frame) {
    TrajectoryFrame into;
    trajectory.read_frame(frame, into);
    return into.positions;
}

// Opens the file with each of these bits of each byte turned, and reads all its frames: finite
// positions, or a LoadError.
template <class Open>
void expect_frames_or_errors(const std::string& whole, std::initializer_list<int> bits,
                             const Open& open) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const int bit : bits) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
            load_error_of([&] {
                const auto trajectory = open(damaged);
                for (std::size_t i = 0; i < trajectory->frame_count(); ++i) {
                    for (const Vec3& position : positions_of(*trajectory, i))
                        REQUIRE(position.allFinite());
                }
            });
        }
    }
}

}  // namespace palpa::test
