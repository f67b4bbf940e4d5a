// Any text, plain or compressed, is a journal or a LoadError; a journal reads the same once
// written, and a session of water plays it or refuses it.
#include "core/load_error.h"
#include "formats/gzip.h"
#include "scene/read_scene.h"
#include "session/journal.h"
#include "session/play_journal.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"
#include "tests/support/paths.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

std::optional<Journal> read_or_refuse(std::string_view text) {
    return test::or_refused([&] { return parse_journal(text, "journal.txt"); });
}

std::string formatted(const Journal& journal) {
    JournalWriter writer(journal.devices);
    for (const PlayedEvent& event : journal.events) writer.add(event);
    for (std::size_t tick = 0; tick < journal.ticks.size(); ++tick) {
        std::vector<LiveTick> hands(journal.devices.size());
        for (std::size_t slot = 0; slot < hands.size(); ++slot) {
            const JournalHand& hand = journal.hands_of(tick)[slot];
            LiveTick& written = hands[slot];
            written.tick.reading = hand.reading;
            written.tick.contact.number = hand.contact;
            written.order = hand.order;
            written.now_s = journal.ticks[tick].now_s;
            written.is_ending = journal.ticks[tick].is_ending;
            written.is_fresh = journal.ticks[tick].is_fresh;
        }
        if (tick == journal.first_recorded) writer.begin_recording();
        writer.add(hands);
    }
    if (journal.first_recorded == journal.ticks.size()) writer.begin_recording();
    return writer.take();
}

void play(const Journal& journal) {
    static const SceneDescription scene =
        read_scene(test::in_project("scenes/water/scene.toml"), {});
    std::size_t ticks = 0;
    try {
        play_journal(scene, journal, [&](std::span<const LiveTick> hands) {
            PALPA_EXPECT(hands.size() == journal.devices.size());
            for (const LiveTick& hand : hands) PALPA_EXPECT(hand.tick.sent_newton.allFinite());
            ++ticks;
        });
    } catch (const LoadError&) {
        return;
    }
    PALPA_EXPECT(ticks ==
                 journal.ticks.size() - journal.first_recorded.value_or(journal.ticks.size()));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t most = 1 << 16;
    std::string text(reinterpret_cast<const char*>(data), size);
    if (is_gzip(text)) {
        const auto unpacked = test::or_refused([&] { return unpack_gzip(text, "fuzz.gz", most); });
        if (!unpacked) return 0;
        text = *unpacked;
    }
    const std::optional<Journal> journal = read_or_refuse(text);
    if (!journal) return 0;
    const std::string written = formatted(*journal);
    const std::optional<Journal> back = read_or_refuse(written);
    PALPA_EXPECT(back);
    PALPA_EXPECT(formatted(*back) == written);
    play(*journal);
    return 0;
}
