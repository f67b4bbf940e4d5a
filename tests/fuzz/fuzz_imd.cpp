// Any bytes are messages of IMD that are sound, or a problem; pieces of any size give the same.
#include "imd/frame.h"
#include "tests/fuzz/expect.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

using namespace palpa;

namespace {

constexpr std::size_t max_atoms = 300;

bool are_finite(const std::vector<Vec3>& vectors) {
    return std::ranges::all_of(vectors, [](const Vec3& vector) { return vector.allFinite(); });
}

void expect_sound(const ImdMessage& message, const ImdDecoder& decoder) {
    const bool has_atoms = message.type == ImdType::Positions ||
                           message.type == ImdType::Velocities || message.type == ImdType::Forces;
    if (has_atoms) PALPA_EXPECT(message.values.size() == 3 * decoder.atoms());
    if (message.type != ImdType::ClientForces) return;
    PALPA_EXPECT(message.values.size() == 3 * message.atoms.size());
    PALPA_EXPECT(std::ranges::all_of(
        message.values, [](float value) { return std::abs(value) <= imd_strongest_pull; }));
    PALPA_EXPECT(std::ranges::all_of(message.atoms, [&](std::int32_t atom) {
        return atom >= 0 && static_cast<std::size_t>(atom) < decoder.atoms();
    }));
}

// All that a stream comes to.
struct Outcome {
    std::size_t messages = 0, frames = 0;
    std::string problem, place;

    bool operator==(const Outcome&) const = default;
};

Outcome read(ImdDecoder decoder, std::span<const std::byte> bytes, std::size_t piece_size) {
    Outcome outcome;
    ImdFrameBuilder builder(imd_units_of_version_3);
    ImdFrame frame;
    while (!bytes.empty() && decoder.problem().empty()) {
        auto piece = bytes.first(std::min(piece_size, bytes.size()));
        bytes = bytes.subspan(piece.size());
        while (!piece.empty() && decoder.problem().empty()) {
            piece = piece.subspan(decoder.take(piece));
            if (!decoder.message()) continue;
            ++outcome.messages;
            expect_sound(*decoder.message(), decoder);
            if (!builder.add(*decoder.message(), frame)) continue;
            ++outcome.frames;
            PALPA_EXPECT(are_finite(frame.coordinates) && are_finite(frame.velocities) &&
                         are_finite(frame.forces));
            PALPA_EXPECT(frame.coordinates.size() <= max_atoms);
        }
    }
    outcome.problem = decoder.problem();
    outcome.place = decoder.find_place();
    PALPA_EXPECT(outcome.problem.find('\n') == std::string::npos && !outcome.place.empty());
    return outcome;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    // The first byte: 0 an engine; else a client of version 2 or 3, little or big endian.
    const std::uint8_t kind = data[0];
    const auto bytes = std::as_bytes(std::span(data, size)).subspan(1);
    const ImdDecoder decoder =
        kind == 0
            ? ImdDecoder::of_engine({.max_atoms = max_atoms})
            : ImdDecoder::of_client(2 + kind % 2, kind & 2 ? std::endian::big : std::endian::little,
                                    {.atoms = 4});
    const Outcome whole = read(decoder, bytes, bytes.size() + 1);
    PALPA_EXPECT(whole == read(decoder, bytes, 1));
    PALPA_EXPECT(whole == read(decoder, bytes, 13));
    return 0;
}
