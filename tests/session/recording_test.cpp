#include "session/recording.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "loading/load.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_run.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

Summary record(const fs::path& scene_path, const fs::path& folder,
               const std::vector<std::string>& settings, bool overwrites = false) {
    const SceneDescription scene = read_scene(scene_path, settings);
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    Recording recording(folder, scene, overwrites);
    return run_headless(scene, world, device, {}, &recording, {});
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

TEST_CASE("the summary says scene, settings and results", "[session][recording]") {
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

TEST_CASE("edits and a second hand are part of the hash, each of their keys",
          "[session][recording]") {
    const std::string restraint = "restraint = { atoms = [\"a:1\"], place_angstrom = [0, 0, 0], ";
    const std::string grab = "[second.grab]\nmolecule = \"moved\"\nmeasured_from = \"fixed\"\n";
    const std::vector<std::string> endings{
        "",
        grab,
        grab + "spring_kcal_per_mol_angstrom2 = 3\n",
        grab + "[second.hand]\ngrip = \"firm\"\n",
        grab + "[second.hand]\nstroke = \"hold\"\n",
        grab + "[second.hand]\nstart_angstrom = 3\n",
        grab + "[second.hand]\npeak_nN = 2\n",
        grab + "[second.hand]\nstroke_s = 2\n",
        grab + "[second.hand]\npause_s = 2\n",
        grab + "[second.hand]\ncycles = 2\n",
        grab + "[second.hand]\nrelease_s = 2\n",
        grab + "[second.hand]\nkick_N_s = 0.01\n",
        grab + "[second.hand]\npath = [[0, 1]]\n",
        "[[edits]]\nat_s = 1\nundo = true\n",
        "[[edits]]\nat_s = 2\nundo = true\n",
        grab + "[[edits]]\nat_s = 1\nundo = true\n",
        grab + "[[edits]]\nat_s = 1\nhand = \"second\"\nundo = true\n",
        "[[edits]]\nat_s = 1\nundo = true\n[[edits]]\nat_s = 1\nundo = true\n",
        "[[edits]]\nat_s = 1\nredo = true\n",
        "[[edits]]\nat_s = 1\nredo = true\n[[edits]]\nat_s = 1\nundo = true\n",
        "[[edits]]\nat_s = 1\nundo = true\n[[edits]]\nat_s = 1\nredo = true\n",
        "[[edits]]\nat_s = 1\nlet_go = true\n",
        "[[edits]]\nat_s = 1\ntake = \"a\"\n",
        "[[edits]]\nat_s = 1\ntake = \"a:1\"\n",
        "[[edits]]\nat_s = 1\nremove = \"a\"\n",
        "[[edits]]\nat_s = 1\npin = [\"a:1 A\"]\n",
        "[[edits]]\nat_s = 1\npin = [\"a:1 A\", \"a:1 B\"]\n",
        "[[edits]]\nat_s = 1\npin = [\"a:1 B\", \"a:1 A\"]\n",
        "[[edits]]\nat_s = 1\nadd = { residue = \"a\", name = \"b\", at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { copy_of = \"a\", name = \"b\", at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { copy_of = \"a\", name = \"c\", at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { copy_of = \"a\", name = \"b\", at_angstrom = [0, 0, 1] }\n",
        "[[edits]]\nat_s = 1\nadd = { structure = \"dimer.crd\", name = \"b\", "
        "at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { structure = \"three.crd\", name = \"b\", "
        "at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { structure = \"dimer.crd\", segment = \"FIX\", name = \"b\", "
        "at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nadd = { structure = \"dimer.crd\", topology = \"tip3p.str\", "
        "name = \"b\", at_angstrom = [0, 0, 0] }\n",
        "[[edits]]\nat_s = 1\nrestraint = { atoms = [\"a:1\", \"b:1\"] }\n",
        "[[edits]]\nat_s = 1\n" + restraint + "k_kcal_per_mol_angstrom2 = 3 }\n",
        "[[edits]]\nat_s = 1\n" + restraint + "length_angstrom = 3 }\n",
        "[[edits]]\nat_s = 1\nmobility = { molecule = \"a\", motion = \"free\" }\n",
        "[[edits]]\nat_s = 1\nmobility = { molecule = \"b\", motion = \"free\" }\n",
        "[[edits]]\nat_s = 1\nmobility = { molecule = \"a\", shape = \"rigid\" }\n",
        "[[edits]]\nat_s = 1\nappearance = { molecule = \"a\", visible = true }\n",
        "[[edits]]\nat_s = 1\nappearance = { molecule = \"a\", visible = false }\n",
        "[[edits]]\nat_s = 1\nappearance = { molecule = \"a\", colour = \"chain\" }\n",
        "[[edits]]\nat_s = 1\nappearance = { molecule = \"a\", representation = \"licorice\" }\n",
        "[[edits]]\nat_s = 1\ncoupling = { mode = 3 }\n",
        "[[edits]]\nat_s = 1\ncoupling = { mode = 3, clamp_N = 2 }\n"};

    std::map<std::string, std::string> ending_of;  // by hash
    for (const std::string& ending : endings) {
        const std::string hash = scene_hash(parse_scene(
            read_text_file(water / "scene.toml") + "\n" + ending, water / "scene.toml"));
        INFO(ending << "has the hash of\n" << ending_of[hash]);
        CHECK(ending_of[hash].empty());
        ending_of[hash] = ending.empty() ? "nothing added" : ending;
    }
    CHECK(ending_of.contains(scene_hash(test::water_scene())));
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

TEST_CASE("a file that an edit names is an input as others are", "[session][recording]") {
    const test::TemporaryFolder folder;
    const fs::path scene = folder.path() / "scene";
    fs::copy(water, scene);
    std::ofstream(scene / "scene.toml", std::ios::app)
        << "[[edits]]\nat_s = 0.02\nadd = { structure = \"added.crd\", segment = \"LEFT\", "
           "name = \"w2\", at_angstrom = [0, 4, 0] }\n";
    const std::string text = read_text_file(water / "three.crd");
    std::ofstream(scene / "added.crd", std::ios::binary) << text;
    const std::string hash = scene_hash(read_scene(scene));

    record(scene, folder.path() / "a", {"seconds=0.1"});
    record(folder.path() / "a" / "session.toml", folder.path() / "b", {});

    CHECK(read_text_file(folder.path() / "a" / "inputs" / "added.crd") == text);
    const std::string trace = read_text_file(folder.path() / "a" / "trace.csv");
    CHECK(trace == read_text_file(folder.path() / "b" / "trace.csv"));
    record(water, folder.path() / "c", {"seconds=0.1"});
    CHECK(trace != read_text_file(folder.path() / "c" / "trace.csv"));
    std::ofstream(scene / "added.crd", std::ios::app) << "\n";
    CHECK(scene_hash(read_scene(scene)) != hash);
}

TEST_CASE("an input that comes late is one of the recording, and goes with it",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    InputNames names(test::water_scene());
    const std::string first = names.add("/elsewhere/dimer.crd"), second = names.add("a \"b\".crd");
    CHECK(first == "inputs/2-dimer.crd");
    CHECK(second == "inputs/a__b_.crd");
    {
        Recording recording(folder.path(), test::water_scene());
        recording.add_input(first, "one");
        recording.add_input(second, "two");
        CHECK_THROWS_AS(recording.add_input(second, "three"), LoadError);
        recording.finish({});
    }
    CHECK(read_text_file(folder.path() / first) == "one");
    CHECK(read_text_file(folder.path() / second) == "two");
    CHECK_NOTHROW(read_scene(folder.path() / "session.toml"));

    record(water, folder.path(), {"seconds=0.1"}, true);

    CHECK_FALSE(fs::exists(folder.path() / first));
    CHECK_FALSE(fs::exists(folder.path() / second));
    CHECK(fs::exists(folder.path() / "inputs" / "dimer.crd"));
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

namespace {

// Two hands' ticks, told apart by every number that is a hand's own.
std::array<ServoTick, 2> ticks_of_two(double time_s) {
    std::array<ServoTick, 2> ticks;
    for (std::size_t i = 0; i < 2; ++i) {
        const double own = static_cast<double>(i + 1);
        ticks[i].reading.time_s = time_s;
        ticks[i].reading.position_m = Vec3(0.01 * own, 0, 0);
        ticks[i].contact.molecule.place_angstrom = Vec3(-own, 5, 0);
        ticks[i].contact.period_s = 0.014;
        ticks[i].contact.active_freedom = static_cast<int>(i) + 3;
        ticks[i].sent_newton = Vec3(0, 0, 0.25 * own);
        ticks[i].hand_energy_J = 0.5 * own;
        ticks[i].clutched = i == 1;
    }
    return ticks;
}

std::map<std::string, std::string> by_column(std::string_view header, std::string_view row) {
    const auto split = [](std::string_view line) {
        std::vector<std::string> values;
        for (std::size_t begin = 0; begin <= line.size();) {
            const std::size_t end = std::min(line.find(',', begin), line.size());
            values.emplace_back(line.substr(begin, end - begin));
            begin = end + 1;
        }
        return values;
    };
    const std::vector<std::string> names = split(header), values = split(row);
    REQUIRE(names.size() == values.size());
    std::map<std::string, std::string> result;
    for (std::size_t i = 0; i < names.size(); ++i)
        REQUIRE(result.emplace(names[i], values[i]).second);
    return result;
}

}  // namespace

TEST_CASE("the trace of two hands is that of the first and the second's own columns behind it",
          "[session][recording]") {
    const test::TemporaryFolder folder;
    const fs::path one = folder.path() / "one", two = folder.path() / "two";
    {
        Recording alone(one, test::water_scene()), both(two, test::water_scene(), false, 2);
        for (int i = 0; i < 5; ++i) {
            const std::array<ServoTick, 2> ticks = ticks_of_two(1e-3 * i);
            alone.add(ticks[0]);
            both.add(ticks);
        }
        alone.finish({});
        both.finish({});
    }
    const std::string text_one = read_text_file(one / "trace.csv"),
                      text_two = read_text_file(two / "trace.csv");

    const std::vector<std::string_view> alone = split_lines(text_one), both = split_lines(text_two);

    REQUIRE(both.size() == 6);
    for (std::size_t i = 0; i < both.size(); ++i)
        CHECK(both[i].starts_with(std::string(alone[i]) + ","));
    std::map<std::string, std::string> row = by_column(both[0], both[4]);
    CHECK(row["time_s"] == "0.003");
    CHECK(row["handle_x_m_2"] == "0.02");
    CHECK(row["molecule_x_angstrom_2"] == "-2");
    CHECK(row["molecule_y_angstrom_2"] == "5");
    CHECK(row["device_force_z_N_2"] == "0.5");
    CHECK(row["hand_energy_J_2"] == "1");
    CHECK(row["active_joints_2"] == "4");
    CHECK(row["clutch"] == "0");
    CHECK(row["clutch_2"] == "1");
    CHECK(row.count("time_s_2") + row.count("period_ms_2") == 0);
    CHECK(row.size() == 2 * by_column(alone[0], alone[4]).size() - 2);
}

TEST_CASE("the summary names a second hand under its own key, and only where there is one",
          "[session][recording]") {
    Summary summary;
    summary.largest_felt_N = 1;
    SceneDescription scene = test::water_scene();
    scene.hands.resize(2);
    const std::string alone = format_summary(scene, summary);
    Summary second;
    second.device = "a second Omni";
    second.largest_felt_N = 2;
    second.net_work_J = -0.01;
    second.is_on_axis = false;
    summary.other_hands.push_back(second);

    const auto json = nlohmann::json::parse(format_summary(scene, summary));

    CHECK(json["largest_felt_N"] == 1);
    CHECK(json["hand_2"]["device"] == "a second Omni");
    CHECK(json["hand_2"]["largest_felt_N"] == 2);
    CHECK(json["hand_2"]["net_work_J"] == -0.01);
    CHECK_FALSE(json["hand_2"].contains("largest_repulsion_N"));
    CHECK(json["hand_2"]["stopped"] == false);
    auto without = json;
    without.erase("hand_2");
    CHECK(without == nlohmann::json::parse(alone));
}
