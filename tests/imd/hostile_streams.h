// Streams of bytes that are no IMD, or almost: the same ones for the same number.
#pragma once
#include "tests/imd/wire.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace palpa::test {

class HostileStreams {
public:
    explicit HostileStreams(std::uint64_t number) : random_(number) {}

    std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_() % limit); }

    // From an engine of two atoms.
    Wire from_engine() { return spoilt(below(2) == 0 ? engine_of_2() : engine_of_3()); }
    // From a client of an engine of `version` with two atoms.
    Wire from_client(int version) { return spoilt(client(version)); }

    // Where a stream is cut into pieces: seldom, often, or at each byte.
    std::vector<std::size_t> splits(std::size_t size) {
        const std::array<std::size_t, 4> longest{1, 5, 50, 5000};
        const std::size_t most = longest[below(longest.size())];
        std::vector<std::size_t> ends;
        for (std::size_t at = 0; at < size;) {
            at = std::min(size, at + 1 + below(most));
            ends.push_back(at);
        }
        return ends;
    }

private:
    std::endian order() { return below(2) == 0 ? native : turned; }

    std::vector<float> some_floats(std::size_t count) {
        std::vector<float> values(count);
        for (float& value : values) value = static_cast<float>(below(2000)) / 16 - 50;
        return values;
    }

    Wire engine_of_2() {
        const std::endian order = this->order();
        Wire wire = handshake(order, 2);
        for (std::size_t frames = below(6); frames > 0; --frames) {
            if (below(2) == 0) wire = std::move(wire) + energies(order, 7, some_floats(9));
            wire = std::move(wire) + vectors(order, 2, some_floats(6));
        }
        return wire;
    }

    Wire engine_of_3() {
        const std::endian order = this->order();
        Wire wire = handshake(order, 3) + header(10, 7);
        std::array<bool, 7> has{};
        for (bool& flag : has) flag = below(4) > 0;
        for (const bool flag : has) wire.push_back(static_cast<std::byte>(flag));
        for (std::size_t frames = below(6); frames > 0; --frames) {
            if (has[0]) {
                wire = ((std::move(wire) + header(12, 1) + number(order, 0.002)) +
                        number(order, 1.0)) +
                       number(order, std::int64_t{500});
            }
            if (has[1]) wire = std::move(wire) + energies(order, 7, some_floats(9));
            if (has[2]) wire = std::move(wire) + header(13, 1) + floats(order, some_floats(9));
            if (has[3]) wire = std::move(wire) + vectors(order, 2, some_floats(6));
            if (has[5]) wire = std::move(wire) + vectors(order, 14, some_floats(6));
            if (has[6]) wire = std::move(wire) + vectors(order, 15, some_floats(6));
        }
        return wire;
    }

    Wire client(int version) {
        Wire wire = go;
        for (std::size_t messages = below(8); messages > 0; --messages) {
            switch (below(5)) {
                case 0:
                    wire = std::move(wire) + header(8, static_cast<std::int32_t>(below(9)));
                    break;
                case 1:
                    wire = std::move(wire) + header(below(2) == 0 ? 5 : 7, 0);
                    break;
                case 2:
                    wire = std::move(wire) + header(version == 3 ? 11 : 7, 0);
                    break;
                default:
                    wire = std::move(wire) + client_forces(native, {1, 0}, some_floats(6));
            }
        }
        return wire;
    }

    Wire random_bytes(std::size_t size) {
        Wire wire(size);
        for (std::byte& byte : wire) byte = static_cast<std::byte>(below(256));
        return wire;
    }

    // Bytes of any kind, or a good stream with some places changed, and mostly cut off somewhere.
    Wire spoilt(Wire wire) {
        if (below(8) == 0) return random_bytes(below(200));
        for (std::size_t changes = below(5); changes > 0; --changes) change(wire);
        if (below(4) > 0) wire.resize(below(wire.size() + 1));
        return wire;
    }

    void change(Wire& wire) {
        if (wire.empty()) return;
        const std::size_t at = below(wire.size());
        const auto place = wire.begin() + static_cast<std::ptrdiff_t>(at);
        const std::size_t length = std::min(wire.size() - at, 1 + below(30));
        const auto end = place + static_cast<std::ptrdiff_t>(length);
        switch (below(5)) {
            case 0:
                *place ^= static_cast<std::byte>(1 << below(8));
                return;
            case 1:
                wire.erase(place, end);
                return;
            case 2: {
                const Wire copy(place, end);
                wire.insert(place, copy.begin(), copy.end());
                return;
            }
            case 3: {
                const Wire more = random_bytes(length);
                wire.insert(place, more.begin(), more.end());
                return;
            }
            default: {
                // A word at a place where one stands: lengths and types that are none, numbers that
                // are none, or far out.
                constexpr std::array<std::uint32_t, 12> words{
                    0,          1,          2,          3,          6,          0x7FFFFFFF,
                    0x80000000, 0xFFFFFFFF, 0x7FC00000, 0xFF800000, 0x4B000000, 0x00100000};
                const Wire word = number(order(), words[below(words.size())]);
                const std::size_t start = at / 4 * 4;
                for (std::size_t i = 0; i < 4 && start + i < wire.size(); ++i) {
                    wire[start + i] = word[i];
                }
            }
        }
    }

    std::mt19937_64 random_;
};

}  // namespace palpa::test
