#include "session/pack_recording.h"

#include "core/file_versions.h"
#include "core/files.h"
#include "devices/played_handle.h"
#include "loading/load.h"
#include "session/journal.h"
#include "session/recording.h"
#include "session/replay.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_run.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

void record(const fs::path& folder, bool overwrites = false) {
    const SceneDescription scene = test::water_scene({"seconds=1"});
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    Recording recording(folder, scene, overwrites);
    (void)run_headless(scene, world, device, {}, &recording, {});
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::path& file : list_folder(folder)) names.push_back(file.filename().string());
    return names;
}

// Differing rows of the recorded trace and the run of its scene.
std::uint64_t count_different(const fs::path& folder) {
    const SceneDescription scene = read_recorded_scene(folder);
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    TraceCheck check(folder, 1000, scene.every);
    CHECK(check.recorded() == 1000);
    std::vector<Device*> devices{&device};
    (void)run_headless(scene, world, devices, {}, nullptr, {}, {},
                       [&](std::span<const ServoTick> ticks) { check.add(ticks); });
    CHECK(check.compared() == 1000);
    return check.different();
}

}  // namespace

TEST_CASE("a compressed recording is read as the plain one", "[session][recording]") {
    const test::TemporaryFolder folder;
    const fs::path recording = folder.path() / "recording";
    record(recording);
    const std::string trace = read_text_file(recording / "trace.csv");
    const std::vector<PlayedRow> rows = read_trace(recording);
    (void)folder.add_file("recording/journal.txt", "a journal");
    double last = 0;

    pack_recording(recording, [&](double share) {
        CHECK(share >= last);
        last = share;
    });

    CHECK(last > 0.9);
    CHECK(last <= 1);
    CHECK(names_in(recording) == std::vector<std::string>{"inputs", "journal.txt.gz",
                                                          "session.toml", "summary.json",
                                                          "trace.csv.gz"});
    CHECK(read_recorded_file(recording / "trace.csv") == trace);
    CHECK(fs::file_size(recording / "trace.csv.gz") < trace.size() / 3);
    CHECK(has_journal(recording));
    CHECK(count_different(recording) == 0);
    const std::vector<PlayedRow> packed_rows = read_trace(recording);
    REQUIRE(packed_rows.size() == rows.size());
    CHECK(packed_rows.back().handle_m == rows.back().handle_m);
    CHECK(read_trace(recording / "trace.csv.gz").size() == rows.size());

    pack_recording(recording);  // nothing is left to be done
    CHECK(read_recorded_file(recording / "trace.csv") == trace);
}

TEST_CASE(
    "a recording takes the place of a compressed one, and of one whose compression was killed",
    "[session][recording]") {
    const test::TemporaryFolder folder;
    record(folder.path());
    pack_recording(folder.path());
    for (const char* const name : {"trace.csv.gz.draft", "journal.txt.gz", "mine.csv.gz"})
        (void)folder.add_file(name, "left");

    record(folder.path(), true);

    CHECK(names_in(folder.path()) == std::vector<std::string>{"inputs", "mine.csv.gz",
                                                              "session.toml", "summary.json",
                                                              "trace.csv"});
    CHECK(count_different(folder.path()) == 0);
}

TEST_CASE("a damaged trace is named with its ending", "[session][recording]") {
    const test::TemporaryFolder folder;
    record(folder.path());
    pack_recording(folder.path());
    std::string packed = read_text_file(folder.path() / "trace.csv.gz");
    const auto error = [&] {
        return test::load_error_of([&] { TraceCheck(folder.path(), 1000, 1); });
    };
    write_text_file(folder.path() / "trace.csv.gz", packed.substr(0, packed.size() / 2),
                    Existing::Replace);
    CHECK_THAT(error(), Contains("trace.csv.gz: is cut off"));
    packed[packed.size() / 2] ^= 4;
    write_text_file(folder.path() / "trace.csv.gz", packed, Existing::Replace);
    CHECK_THAT(error(), Contains("trace.csv.gz: is damaged"));
}

TEST_CASE("nobody compresses what another run writes", "[session][recording]") {
    const test::TemporaryFolder folder;
    const Recording recording(folder.path(), test::water_scene());
    CHECK_THAT(test::load_error_of([&] { pack_recording(folder.path()); }),
               Contains("another run is writing into this folder"));
    CHECK(fs::exists(folder.path() / "trace.csv"));
}
