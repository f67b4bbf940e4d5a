#include "core/files.h"
#include "session/pack_recording.h"
#include "session/session_recorder.h"

#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <sys/resource.h>
#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// While it exists no file can grow beyond so many bytes: to the program, a full disk.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        REQUIRE(getrlimit(RLIMIT_FSIZE, &before_) == 0);
        const rlimit limit{bytes, before_.rlim_max};
        REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    }
    ~FullDisk() {
        (void)setrlimit(RLIMIT_FSIZE, &before_);
        (void)std::signal(SIGXFSZ, handler_);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

private:
    void (*handler_)(int);
    rlimit before_{};
};

std::string journal_in(const std::filesystem::path& folder) {
    std::ifstream file(folder / "journal.txt", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void play_ten(SessionRecorder& recorder) {
    for (int k = 0; k < 10; ++k) {
        LiveTick tick;
        tick.tick.reading.position_m.x() = 1e-7 * k;
        recorder.add(std::array{tick});
    }
}

SessionRecorder new_recorder() { return {test::water_scene({}), std::array<HandDevice, 1>{}}; }

// The journal of a recording of ten ticks, begun after so many times ten.
std::string undisturbed_journal(const test::TemporaryFolder& folder, int tens) {
    SessionRecorder recorder = new_recorder();
    for (int k = 0; k < tens; ++k) play_ten(recorder);
    recorder.begin(folder.path() / "undisturbed", false);
    play_ten(recorder);
    recorder.end();
    return journal_in(folder.path() / "undisturbed");
}

}  // namespace

TEST_CASE("a recording that a full disk refuses at its begin leaves none, and another can begin",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    SessionRecorder recorder = new_recorder();
    for (int k = 0; k < 300; ++k) play_ten(recorder);
    recorder.begin(folder.path() / "first", false);  // so that all is in the temporary file
    recorder.end();
    {
        const FullDisk full(16 << 10);  // the scene's files fit, the journal does not
        CHECK_THAT(test::load_error_of([&] { recorder.begin(folder.path() / "second", false); }),
                   Catch::Contains("second") && Catch::Contains("written"));
    }
    CHECK_FALSE(recorder.is_recording());
    CHECK(recorder.recorded_s() == 0);
    play_ten(recorder);
    CHECK(recorder.take_failure().empty());

    recorder.begin(folder.path() / "third", false);
    play_ten(recorder);
    CHECK(recorder.recorded_s() == Approx(0.010));
    recorder.end();
    const std::string journal = journal_in(folder.path() / "third");
    CHECK(journal.size() > 16 << 10);
    CHECK(journal == undisturbed_journal(folder, 301));
}

TEST_CASE("a recording that fills the disk ends and says so, and the session is still whole",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    SessionRecorder recorder = new_recorder();
    recorder.begin(folder.path() / "first", false);
    int tens = 0;
    {
        const FullDisk full(128 << 10);  // of the trace; the journal is shorter
        for (; recorder.is_recording() && tens < 2000; ++tens) play_ten(recorder);
    }
    REQUIRE_FALSE(recorder.is_recording());
    CHECK_THAT(recorder.take_failure(), Catch::Contains("first") && Catch::Contains("written"));
    CHECK(recorder.take_failure().empty());
    CHECK_NOTHROW(recorder.end());

    recorder.begin(folder.path() / "second", false);
    play_ten(recorder);
    recorder.end();
    CHECK(journal_in(folder.path() / "second") == undisturbed_journal(folder, tens));
}

TEST_CASE("a recording that a full disk keeps from being compressed stays as it is",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    SessionRecorder recorder = new_recorder();
    const std::filesystem::path recording = folder.path() / "recording";
    recorder.begin(recording, false);
    for (int k = 0; k < 300; ++k) play_ten(recorder);
    recorder.end();
    const std::vector<std::filesystem::path> files = list_folder(recording);
    {
        const FullDisk full(1 << 7);
        CHECK_THAT(test::load_error_of([&] { pack_recording(recording); }),
                   Catch::Contains(".gz") && Catch::Contains("written"));
    }
    CHECK(list_folder(recording) == files);
    pack_recording(recording);  // with room again
    CHECK_FALSE(std::filesystem::exists(recording / "trace.csv"));
}
