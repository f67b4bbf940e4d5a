// Bytes of IMD written by hand, without the engine's encoder.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::test {

using Wire = std::vector<std::byte>;

// "00 00 00 04" to four bytes; blanks and line ends are skipped, two digits make a byte.
inline Wire hex(std::string_view digits) {
    Wire bytes;
    std::string pair;
    for (const char digit : digits) {
        if (digit == ' ' || digit == '\n') continue;
        pair += digit;
        if (pair.size() < 2) continue;
        bytes.push_back(static_cast<std::byte>(std::stoi(pair, nullptr, 16)));
        pair.clear();
    }
    return bytes;
}

inline Wire operator+(Wire a, const Wire& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// A number as this machine has it, or turned round.
template <class Number>
Wire number(std::endian order, Number value) {
    std::array<std::byte, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    Wire wire(bytes.begin(), bytes.end());
    if (order != std::endian::native) wire = Wire(wire.rbegin(), wire.rend());
    return wire;
}

inline Wire header(std::int32_t type, std::int32_t length) {
    return number(std::endian::big, type) + number(std::endian::big, length);
}

inline Wire handshake(std::endian order, std::int32_t version) {
    return number(std::endian::big, std::int32_t{4}) + number(order, version);
}

inline Wire floats(std::endian order, const std::vector<float>& values) {
    Wire wire;
    for (const float value : values) wire = std::move(wire) + number(order, value);
    return wire;
}

// Of type 2 coordinates, 14 velocities, 15 forces.
inline Wire vectors(std::endian order, std::int32_t type, const std::vector<float>& values) {
    return header(type, static_cast<std::int32_t>(values.size() / 3)) + floats(order, values);
}

inline Wire energies(std::endian order, std::int32_t step, const std::vector<float>& nine) {
    return header(1, 1) + number(order, step) + floats(order, nine);
}

inline Wire client_forces(std::endian order, const std::vector<std::int32_t>& atoms,
                          const std::vector<float>& values) {
    Wire wire = header(6, static_cast<std::int32_t>(atoms.size()));
    for (const std::int32_t atom : atoms) wire = std::move(wire) + number(order, atom);
    return std::move(wire) + floats(order, values);
}

constexpr std::endian native = std::endian::native;
constexpr std::endian turned =
    native == std::endian::little ? std::endian::big : std::endian::little;

// Messages of clients.
inline const Wire go = hex("00000003 00000000");
inline const Wire leave = hex("00000000 00000000");
inline const Wire pause_or_resume = hex("00000007 00000000");

}  // namespace palpa::test
