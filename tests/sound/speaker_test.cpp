// The sound library plays into a file: no sound output is needed, and none is used.
#include "sound/speaker.h"

#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// Everything that is played from now on is written there.
void play_into(const std::filesystem::path& file) {
    setenv("SDL_AUDIODRIVER", "disk", 1);
    setenv("SDL_DISKAUDIOFILE", file.c_str(), 1);
}

std::vector<float> read_samples(const std::filesystem::path& path) {
    std::vector<float> samples(std::filesystem::file_size(path) / sizeof(float));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(samples.data()),
              static_cast<std::streamsize>(samples.size() * sizeof(float)));
    return samples;
}

bool is_sound(float sample) { return sample != 0; }

}  // namespace

TEST_CASE("what is played is the tone's wave, sample by sample, and fades at the end", "[sound]") {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "played.raw";
    play_into(file);
    const Tone tone = tone_of(1);
    {
        Speaker speaker;
        test::wait_until([&] { return std::filesystem::file_size(file) > 10'000; }, "silence");
        CHECK(speaker.is_there());
        const std::size_t before = std::filesystem::file_size(file);
        const auto is_played = [&] {
            speaker.play(tone);
            return std::filesystem::file_size(file) > before + 40'000;
        };
        test::wait_until(is_played, "the tone");
        CHECK(speaker.is_there());
    }

    const std::vector<float> played = read_samples(file);
    const auto begin = std::find_if(played.begin(), played.end(), is_sound);
    CHECK(begin - played.begin() > 1000);  // silent until the first tone
    std::vector<float> wave(8000);
    ToneState state;
    render_tone(tone, state, wave);
    // The first sample of a tone is zero.
    REQUIRE(played.end() - begin > 8000);
    CHECK(std::equal(wave.begin() + 1, wave.end(), begin));
    CHECK(played.back() == 0);
}

TEST_CASE("a tone that nobody renews for a second fades", "[sound]") {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "played.raw";
    play_into(file);
    setenv("SDL_DISKAUDIODELAY", "1", 1);  // ms for each 512 samples: faster than it sounds
    {
        Speaker speaker;
        speaker.play(tone_of(3));
        // 1.2 s and what was played before the tone.
        test::wait_until([&] { return std::filesystem::file_size(file) > 60'000 * sizeof(float); },
                         "what follows the tone");
    }
    unsetenv("SDL_DISKAUDIODELAY");

    const std::vector<float> played = read_samples(file);
    const auto begin = std::find_if(played.begin(), played.end(), is_sound);
    const auto end = std::find_if(played.rbegin(), played.rend(), is_sound).base();
    // A second, to a block of 512, and 0.101 s of fading.
    CHECK(end - begin == Approx(48'000 + 4'860).margin(600));
}

TEST_CASE("an output that goes away is noticed, and ends quietly", "[sound]") {
    play_into("/dev/full");  // to which nothing can be written
    Speaker speaker;
    const auto is_away = [&] {
        speaker.play(tone_of(1));
        return !speaker.is_there();
    };
    test::wait_until(is_away, "the end of the output");
}

TEST_CASE("without a sound output that is said in a sentence", "[sound]") {
    for (int attempt = 0; attempt < 2; ++attempt) {  // a failure leaves nothing behind
        setenv("SDL_AUDIODRIVER", "none of that name", 1);
        CHECK_THROWS_WITH(Speaker(), Catch::Matchers::StartsWith("no sound output was found ("));
        play_into("/nowhere/played.raw");
        CHECK_THROWS_WITH(Speaker(),
                          Catch::Matchers::StartsWith("the sound output cannot be opened ("));
    }
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    const Speaker speaker;
    CHECK(speaker.is_there());
}

TEST_CASE("the sound library takes no signals", "[sound]") {
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    const int number = GENERATE(SIGINT, SIGTERM);
    const auto before = std::signal(number, SIG_DFL);  // or it would leave them alone

    const Speaker speaker;

    CHECK(std::signal(number, before) == SIG_DFL);
}
