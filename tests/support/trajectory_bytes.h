// Trajectories for tests: what other programs' files hold, as text, and bytes put together by hand.
#pragma once
#include "formats/trajectory.h"
#include "tests/support/paths.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
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

}  // namespace palpa::test
