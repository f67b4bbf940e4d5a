#include "session/recording.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_run.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

Summary record(const fs::path& scene_path, const fs::path& folder,
               const std::vector<std::string>& settings, bool overwrites = false) {
    const SceneDescription scene = read_scene(scene_path, settings);
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    Recording recording(folder, scene, overwrites);
    return run_headless(scene, simulation, device, {}, &recording, {});
}

const fs::path water = test::in_project("scenes/water");

}  // namespace

TEST_CASE("the same run twice, and its session run again, give one trace to the byte",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    const std::vector<std::string> settings{"mode=1",       "period_ms=14", "seconds=2",
                                            "stroke_s=0.7", "every=3",      "kick_N_s=0.002"};
    record(water, folder.path() / "a", settings);
    record(water, folder.path() / "b", settings);
    record(folder.path() / "a" / "session.toml", folder.path() / "c", {});

    const std::string trace = read_text_file(folder.path() / "a" / "trace.csv");
    CHECK(trace == read_text_file(folder.path() / "b" / "trace.csv"));
    CHECK(trace == read_text_file(folder.path() / "c" / "trace.csv"));
    CHECK(read_text_file(folder.path() / "a" / "session.toml") ==
          read_text_file(folder.path() / "c" / "session.toml"));
    CHECK(split_lines(trace).size() == 1 + 667);
}

TEST_CASE("a recording can be run again in its own place", "[session][recording]") {
    const test::TemporaryFolder folder;
    record(water, folder.path(), {"seconds=0.3"});
    const std::string trace = read_text_file(folder.path() / "trace.csv");

    record(folder.path() / "session.toml", folder.path(), {}, true);

    CHECK(read_text_file(folder.path() / "trace.csv") == trace);
}

TEST_CASE("the trace has the columns that scripts rely on, in SI where the name says so",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    record(water, folder.path(), {"seconds=0.1"});
    const std::string text = read_text_file(folder.path() / "trace.csv");
    const std::vector<std::string_view> lines = split_lines(text);

    for (const char* const column :
         {"time_s", "handle_x_m", "handle_z_m", "molecule_x_angstrom", "molecule_z_angstrom",
          "force_x_nN", "force_z_nN", "device_force_x_N", "device_force_z_N", "force_gain",
          "displacement_gain", "stiffness_N_per_m", "hand_energy_J", "potential_kcal_per_mol",
          "active_joints", "period_ms"}) {
        CHECK_THAT(std::string(lines[0]), Catch::Matchers::Contains(column));
    }
    CHECK(lines.size() == 101);
    const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
    for (const std::string_view line : lines)
        CHECK(std::count(line.begin(), line.end(), ',') == commas);
    CHECK(lines[1].starts_with("0,"));
    CHECK(lines[100].starts_with("0.099,"));
}

TEST_CASE("the summary tells scene, settings and results", "[session][recording]") {
    const test::TemporaryFolder folder;
    record(water, folder.path(), {"mode=3", "seconds=0.5", "seed=7"});

    const auto json = nlohmann::json::parse(read_text_file(folder.path() / "summary.json"));

    CHECK(json["scene"] == "Two waters");
    CHECK(json["scene_hash"].get<std::string>().size() == 16);
    CHECK(json["mode"] == "3");
    CHECK(json["seed"] == 7);
    CHECK(json["steps"] == 500);
    CHECK(json["overruns"] == 0);
    for (const char* const key :
         {"versions", "device", "hand", "period_ms", "step_median_us", "step_p99_us", "ripple_N",
          "net_work_J", "largest_attraction_N", "clamped_share", "neglected", "warnings"}) {
        CHECK(json.contains(key));
    }
}

TEST_CASE("another scene has another hash, wherever the difference is", "[session][recording]") {
    const test::TemporaryFolder folder;
    fs::copy(water, folder.path());
    const std::string same = scene_hash(test::water_scene());
    CHECK(scene_hash(read_scene(folder.path())) == same);

    CHECK(scene_hash(test::water_scene({"mode=4"})) != same);
    std::ofstream(folder.path() / "tip3p.str", std::ios::app) << "! a remark\n";
    CHECK(scene_hash(read_scene(folder.path())) != same);
}

TEST_CASE("a folder that holds something else is left alone", "[session][recording]") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "thesis.tex") << "years of work";

    CHECK_THROWS_AS(Recording(folder.path(), test::water_scene()), LoadError);
    CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
    CHECK_THROWS_AS(Recording(folder.path() / "thesis.tex", test::water_scene()), LoadError);
    CHECK_THROWS_AS(Recording(folder.path() / "thesis.tex" / "run", test::water_scene()),
                    LoadError);
}

TEST_CASE("inputs of one name from several folders stay apart", "[session][recording]") {
    const test::TemporaryFolder folder;
    const fs::path scene = folder.path() / "scene";
    fs::copy(water, scene);
    fs::create_directories(scene / "sub");
    // The same file name twice, and a third file that is called as a naive copy would be.
    const std::string dimer = read_text_file(scene / "dimer.crd");
    std::ofstream(scene / "sub" / "dimer.crd") << dimer;
    std::ofstream(scene / "2-dimer.crd") << dimer;
    const std::vector<std::string> settings{
        "seconds=0.1", "molecules.moved.structure=sub/dimer.crd",
        "molecules.third.structure=2-dimer.crd", "molecules.third.segment=FIX",
        "molecules.third.reference_atom=OH2"};

    record(scene, folder.path() / "a", settings);
    record(folder.path() / "a" / "session.toml", folder.path() / "b", {});

    CHECK(std::distance(fs::directory_iterator(folder.path() / "a" / "inputs"), {}) == 4);
    CHECK(read_text_file(folder.path() / "a" / "trace.csv") ==
          read_text_file(folder.path() / "b" / "trace.csv"));
}

TEST_CASE("only our own recordings are replaced, and only where that is said",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "session.toml") << "title = \"a scene of that name\"\n";
    CHECK_THROWS_AS(Recording(folder.path(), test::water_scene(), true), LoadError);

    fs::remove(folder.path() / "session.toml");
    record(water, folder.path(), {"seconds=0.1"});
    CHECK_THROWS_AS(Recording(folder.path(), test::water_scene()), LoadError);
    std::ofstream(folder.path() / "inputs" / "other.crd") << "of somebody else";
    record(water, folder.path(), {"seconds=0.1"}, true);
    CHECK(read_text_file(folder.path() / "inputs" / "other.crd") == "of somebody else");

    fs::remove(folder.path() / "trace.csv");
    fs::create_directory(folder.path() / "trace.csv");
    CHECK_THROWS_AS(Recording(folder.path(), test::water_scene(), true), LoadError);
    CHECK(fs::exists(folder.path() / "summary.json"));
}

TEST_CASE("the summary says which safety chain guarded the run", "[session][recording]") {
    const test::TemporaryFolder folder;
    const std::string mode = GENERATE("1", "2", "3", "4", "5", "guarded");

    record(water, folder.path(), {"seconds=0.1", "mode=" + mode});

    const auto summary = nlohmann::json::parse(read_text_file(folder.path() / "summary.json"));
    CHECK(summary.at("safety") == (mode == "guarded" ? "full" : "paper"));
}
