// What a live session's threads did is played again by one thread, to the last bit.
#include "session/journal.h"

#include "app/live_session.h"
#include "core/files.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "formats/gzip.h"
#include "formats/trajectory.h"
#include "imd/client.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/play_journal.h"
#include "session/replay.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

// A window's hands without the window: each is led by a mouse that a test moves.
struct TwoMice {
    TwoMice(const SceneDescription& scene, std::size_t hands, FrameServer* server = nullptr) {
        std::vector<LiveDevice> devices;
        for (std::size_t slot = 0; slot < hands; ++slot) {
            MouseHandleSettings settings = mouse_handle_of(hand_model(HandGrip::Medium));
            settings.orders = &orders[slot];
            mice.push_back(std::make_unique<MouseHandle>(settings));
            devices.push_back({mice.back().get(), &orders[slot]});
        }
        session = std::make_unique<LiveSession>(scene, ViewSettings{}, devices, nullptr, server);
    }

    bool wait_until(const std::function<bool(const LiveFrame&)>& is_so) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        std::vector<ServoTick> ticks(mice.size());
        while (std::chrono::steady_clock::now() < end) {
            while (session->pop_ticks(ticks)) {
            }
            if (session->read_frame(frame) && is_so(frame)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    bool wait_for_steps(std::uint64_t more) {
        const std::uint64_t from = frame.readout.steps;
        return wait_until([&](const LiveFrame& f) { return f.readout.steps >= from + more; });
    }
    void edit(EditAction action, std::size_t hand = 0) {
        EditDescription description = edit_now(std::move(action));
        description.hand = hand;
        session->send(description);
    }

    std::array<HandOrders, 2> orders;
    std::vector<std::unique_ptr<MouseHandle>> mice;
    std::unique_ptr<LiveSession> session;
    LiveFrame frame;
};

struct Played {
    std::uint64_t recorded, different;
    std::string first;
};

Played play_again(const std::filesystem::path& folder) {
    const SceneDescription scene = read_scene(folder / "session.toml");
    const std::filesystem::path file = folder / "journal.txt";
    const Journal journal = parse_journal(read_recorded_file(file), file.string());
    REQUIRE(journal.first_recorded);
    TraceCheck check(folder, journal.ticks.size() - *journal.first_recorded, scene.every,
                     journal.devices.size());
    std::vector<ServoTick> ticks(journal.devices.size());
    play_journal(scene, journal, [&](std::span<const LiveTick> all) {
        std::ranges::transform(all, ticks.begin(), &LiveTick::tick);
        check.add(ticks);
    });
    CHECK(check.compared() == check.recorded());
    CHECK(check.surplus() == 0);
    CHECK_FALSE(check.is_cut_off());
    const auto first = check.first();
    return {check.recorded(), check.different(),
            first ? first->column + " was " + first->recorded + ", now " + first->played : ""};
}

void check_same(const std::filesystem::path& folder, std::uint64_t at_least) {
    const Played played = play_again(folder);
    INFO(played.first);
    CHECK(played.recorded >= at_least);
    CHECK(played.different == 0);
}

}  // namespace

TEST_CASE("what a client pulls in a session is played again to the bit",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    const SceneDescription scene = test::water_scene({"statics.method=quasi-static", "mode=4"});
    FrameServer server({.port = 0}, load_world(scene));
    const std::string place = server.place();
    {
        TwoMice live(scene, 1, &server);
        live.edit(AddEdit{"TIP3", "", "free", {0, 0, 60}});
        live.edit(MobilityEdit{"free", Motion::Free, {}});
        live.edit(GrabEdit{"free:1"});  // the hand feels what a client pulls at
        REQUIRE(live.wait_until([](const LiveFrame& f) { return f.places.size() == 9; }));
        REQUIRE(live.wait_for_steps(5));
        live.session->begin_recording(recording);

        const auto port = static_cast<std::uint16_t>(std::stoi(place.substr(place.find(':') + 1)));
        ImdClient client({.port = port, .limits = {.atoms = 9}});
        const auto now_s = [] {
            return std::chrono::duration<double>(
                       std::chrono::steady_clock::now().time_since_epoch())
                .count();
        };
        const auto poll_until = [&](const std::function<bool()>& is_so) {
            return live.wait_until([&](const LiveFrame&) {
                (void)client.poll(now_s(), 1);
                return is_so();
            });
        };
        client.connect(now_s());
        REQUIRE(poll_until([&] { return client.frames() > 0; }));
        const std::int32_t atoms[] = {6, 7};
        const Vec3 forces[] = {{0, 3, 0}, {0.5, 0, 1.0 / 3}};
        REQUIRE(client.pull(atoms, forces).empty());
        const auto is_felt = [&] {
            const Vec3 felt = live.frame.hands[0].contact.force_newton;
            return felt.y() > 2 * units::newton_per_kcal_per_mol_angstrom;
        };
        REQUIRE(poll_until(is_felt));
        client.disconnect(now_s());
        REQUIRE(poll_until([&] { return client.state() == ImdState::Closed && !is_felt(); }));
        REQUIRE(live.wait_for_steps(50));
        const std::vector<std::string> notes = live.session->take_server_notes();
        CHECK(std::ranges::count(notes, "client 1 is watching") == 1);
        CHECK(std::ranges::count(notes, "client 1 is pulling") == 1);
        CHECK(std::ranges::count(notes, "client 1 disconnected normally") == 1);
        live.session->end_recording();
    }
    const std::string journal = read_recorded_file(recording / "journal.txt");
    CHECK(journal.find(R"("pull":[[6,0.0,3.0,0.0],[7,0.5,0.0,)") != std::string::npos);
    CHECK(journal.find(R"("pull":[])") != std::string::npos);
    check_same(recording, 30);
}

TEST_CASE("a session that was recorded from its middle is played again to the bit",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    {
        const auto settings = GENERATE(std::vector<std::string>{"mode=1", "period_ms=3"},
                                       std::vector<std::string>{"mode=guarded", "period_ms=7"});
        TwoMice live(test::water_scene(settings), 1);
        live.session->move_hand(Vec3(-0.05, 0.01, 0));
        REQUIRE(live.wait_for_steps(30));
        live.session->begin_recording(recording);
        CHECK_THAT(test::load_error_of([&] { live.session->begin_recording(folder.path() / "b"); }),
                   Contains("another recording is running"));
        live.session->move_hand(Vec3(-0.09, 0, 0.01));
        REQUIRE(live.wait_for_steps(40));
        live.edit(GrabEdit{"fixed"});
        REQUIRE(live.wait_for_steps(20));
        live.session->move_hand(Vec3(-0.04, 0.02, 0));
        REQUIRE(live.wait_for_steps(40));
        live.edit(UndoEdit{});
        live.edit(GrabEdit{"nothing of that name"});
        LiveSettings other{read_scene(test::in_project("scenes/water")).coupling, 5};
        other.coupling.mode = CouplingMode::VariableForceConstantDisplacement;
        live.session->send(other);
        REQUIRE(live.wait_for_steps(20));
        live.session->send(ViewAdditions{{}, {"resid 1"}, {}});
        for (int i = 0; i < 3; ++i) live.edit(UndoEdit{});
        live.edit(RedoEdit{});
        REQUIRE(live.wait_for_steps(20));
        live.session->send(Pause{true});
        REQUIRE(live.wait_until([](const LiveFrame& f) { return f.readout.paused; }));
        live.session->send(StepOnce{});
        REQUIRE(live.wait_for_steps(1));
        live.session->send(Pause{false});
        REQUIRE(live.wait_for_steps(20));
        live.session->send(Reset{5.5});
        REQUIRE(live.wait_for_steps(120));
        CHECK(live.session->recording().value().recorded_s > 0.3);
        live.session->end_recording();
        CHECK_FALSE(live.session->recording());
    }
    check_same(recording, 500);
    CHECK(read_text_file(recording / "summary.json").find("\"largest_felt_N\"") !=
          std::string::npos);
}

TEST_CASE("a session of two hands, and another device, is played again to the bit",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    {
        TwoMice live(read_scene(test::in_project("scenes/water/two-hands.toml")), 2);
        live.session->begin_recording(recording);
        live.session->move_hand(Vec3(-0.03, 0.01, 0), 0);
        live.session->move_hand(Vec3(0.02, -0.01, 0.01), 1);
        REQUIRE(live.wait_for_steps(100));
        CHECK(live.frame.hands.size() == 2);
        live.edit(ReleaseEdit{}, 1);
        REQUIRE(live.wait_for_steps(20));
        live.edit(UndoEdit{}, 1);
        MouseHandleSettings settings = mouse_handle_of(hand_model(HandGrip::Firm));
        HandOrders orders;
        settings.orders = &orders;
        MouseHandle other(settings);
        live.session->change_device(other, &orders, 1);
        REQUIRE(live.wait_for_steps(100));
        live.session->move_hand(Vec3(0.03, 0, 0), 1);
        REQUIRE(live.wait_for_steps(100));
        live.session.reset();  // ends the recording
    }
    check_same(recording, 300);
}

TEST_CASE("measured times that steer a choice are part of the journal", "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    const SceneDescription scene =
        read_scene(test::test_data("two_peptides"),
                   std::vector<std::string>{"statics.budget_us=150", "period_ms=5"});
    {
        TwoMice live(scene, 1);
        REQUIRE(live.wait_for_steps(10));
        live.session->begin_recording(recording);
        live.session->move_hand(Vec3(0.02, 0.01, 0));
        REQUIRE(live.wait_for_steps(60));
        live.edit(ReleaseEdit{});
        live.edit(GrabEdit{"resting:3"});
        REQUIRE(live.wait_for_steps(40));
        live.session->end_recording();
    }
    check_same(recording, 300);
    const Journal journal = parse_journal(read_recorded_file(recording / "journal.txt"), "j");
    std::vector<double> times;
    for (const PlayedEvent& event : journal.events) {
        if (const auto* const step = std::get_if<StepEvent>(&event.event))
            times.push_back(step->took_us.value_or(0));
    }
    REQUIRE(times.size() > 100);
    CHECK(std::ranges::min(times) > 0);
}

TEST_CASE("renewals that a thread of its own makes are played again to the bit",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    {
        const std::vector<std::string> settings{"method=second-order", "period_ms=4", "A_d=0.5e8"};
        TwoMice live(read_scene(test::in_project("tests/data/two_peptides"), settings), 1);
        live.session->begin_recording(recording);
        for (const double side : {1, -1, 1}) {
            live.session->move_hand(Vec3(0.03 * side, 0.02, 0));
            REQUIRE(live.wait_for_steps(30));
        }
        live.edit(PinEdit{{"resting:3 CA"}});  // while one may be under way
        live.session->move_hand(Vec3(-0.03, 0, 0));
        REQUIRE(live.wait_for_steps(30));
        live.edit(UndoEdit{});
        live.session->move_hand(Vec3(0.02, 0, 0));
        REQUIRE(live.wait_for_steps(30));
        live.session->end_recording();
    }
    check_same(recording, 500);
    const Journal journal = parse_journal(read_recorded_file(recording / "journal.txt"), "j");
    const auto adopts = std::ranges::count_if(journal.events, [](const PlayedEvent& event) {
        const auto* const step = std::get_if<StepEvent>(&event.event);
        return step && step->adopts_renewal;
    });
    CHECK(adopts > 0);  // how many depends on the machine
    const auto summary = nlohmann::json::parse(read_text_file(recording / "summary.json"));
    CHECK(summary.at("farthest_angstrom") > 0.5);  // what is in hand was moved to both sides
    CHECK(summary.at("closest_atoms_angstrom") <= summary.at("clearance_angstrom"));
}

TEST_CASE("edits that take longer than a step are played again to the bit",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    {
        SceneDescription scene = read_scene(test::in_project("scenes/hiv/two-hands.toml"));
        scene.edits.clear();
        TwoMice live(scene, 2);
        live.session->begin_recording(recording);
        REQUIRE(live.wait_for_steps(5));
        live.session->move_hand(Vec3(0.005, 0, 0));
        live.edit(GrabEdit{"protease_a:25"});
        live.edit(ReleaseEdit{}, 1);  // waits for the one before
        live.edit(PinEdit{{"protease_a:25 CA", "protease_a:27 CA"}});
        REQUIRE(live.wait_until([](const LiveFrame& f) {
            return f.hands[0].held_address == "protease_a:25" && f.hands[1].held.count == 0;
        }));
        REQUIRE(live.wait_for_steps(5));
        live.edit(GrabEdit{"protease_a:2500"});
        REQUIRE(live.wait_until([](const LiveFrame& f) { return f.readout.refused_edits > 0; }));
        live.edit(UndoEdit{});
        REQUIRE(live.wait_for_steps(5));
        live.session->end_recording();
    }
    const std::string journal = read_recorded_file(recording / "journal.txt");
    CHECK_THAT(journal, Contains("\"long\":true"));
    check_same(recording, 100);
}

TEST_CASE("what is added while a session runs is recorded with its files",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording",
                                elsewhere = folder.path() / "elsewhere";
    const std::string water = read_text_file(test::in_project("scenes/water/three.crd"));
    std::filesystem::create_directory(elsewhere);
    const std::filesystem::path before = folder.add_file("dimer.crd", water),
                                while_recording = folder.add_file("elsewhere/dimer.crd", water);
    {
        TwoMice live(test::water_scene({"period_ms=3"}), 1);
        const auto has_atoms = [&](std::size_t count) {
            return live.wait_until(
                [=](const LiveFrame& f) { return f.atoms->names.size() == count; });
        };
        live.edit(AddEdit{"", "", "first", {0, 5, 0}, before, "", "LEFT"});
        REQUIRE(has_atoms(9));
        std::filesystem::remove(before);
        live.edit(AddEdit{"", "", "none", {0, 20, 0}, before, "", "LEFT"});
        REQUIRE(live.wait_until([](const LiveFrame& f) { return f.readout.refused_edits == 1; }));
        CHECK_THAT(live.frame.readout.problem, Contains("dimer.crd"));
        live.session->begin_recording(recording);
        live.session->move_hand(Vec3(-0.06, 0.01, 0));
        REQUIRE(live.wait_for_steps(40));
        live.edit(AddEdit{"", "", "second", {0, -5, 0}, while_recording, "", "RIGH"});
        REQUIRE(has_atoms(12));
        live.edit(AddEdit{"TIP3", "", "third", {0, 0, 6}});
        REQUIRE(has_atoms(15));
        REQUIRE(live.wait_for_steps(40));
        live.edit(RemoveEdit{"first"});
        REQUIRE(has_atoms(12));
        live.edit(UndoEdit{});
        REQUIRE(has_atoms(15));
        REQUIRE(live.wait_for_steps(40));
        live.session->end_recording();
    }
    std::filesystem::remove_all(elsewhere);

    check_same(recording, 200);

    CHECK(read_text_file(recording / "inputs" / "2-dimer.crd") == water);
    CHECK(read_text_file(recording / "inputs" / "3-dimer.crd") == water);
    std::filesystem::remove(recording / "inputs" / "3-dimer.crd");
    CHECK_THAT(test::load_error_of([&] { (void)play_again(recording); }),
               Contains("3-dimer.crd; expected a file"));
}

TEST_CASE("a recording that is ended is compressed while the session goes on",
          "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path first = folder.path() / "first", second = folder.path() / "second";
    TwoMice live(test::water_scene(), 1);
    live.session->begin_recording(first);
    live.session->move_hand(Vec3(-0.05, 0.01, 0));
    REQUIRE(live.wait_for_steps(100));
    live.session->end_recording();
    live.session->begin_recording(second);  // at once
    std::vector<EndedRecording> ended;
    REQUIRE(live.wait_until([&](const LiveFrame&) {
        if (ended.empty()) ended = live.session->take_ended();
        return !ended.empty();
    }));
    CHECK_FALSE(live.session->packed_share());
    REQUIRE(ended.size() == 1);
    CHECK(ended[0].folder == first);
    CHECK(ended[0].problem.empty());
    CHECK(ended[0].bytes == measure_folder(first));
    for (const char* const name : {"trace.csv", "journal.txt"}) {
        CHECK_FALSE(std::filesystem::exists(first / name));
        CHECK(std::filesystem::exists(first / (std::string(name) + ".gz")));
    }
    REQUIRE(live.wait_for_steps(50));
    live.session->stop_packing();
    live.session.reset();  // ends the second, which stays as it is

    CHECK(std::filesystem::exists(second / "trace.csv"));
    check_same(first, 50);
    check_same(second, 20);
}

TEST_CASE("a replay gives the atoms that the session had", "[app][threads][journal]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    const SceneDescription scene = test::water_scene({"period_ms=4"});
    {
        TwoMice live(scene, 1);
        REQUIRE(live.wait_for_steps(20));
        live.session->begin_recording(recording, false, TrajectorySettings{.per_second = 1000});
        live.session->move_hand(Vec3(-0.05, 0.01, 0));
        REQUIRE(live.wait_for_steps(100));
        live.session->end_recording();
    }
    std::vector<std::vector<Vec3>> played;
    play_journal(
        scene, parse_journal(read_recorded_file(recording / "journal.txt"), "j"),
        [](std::span<const LiveTick>) {}, {},
        [&](const LiveSimulation& simulation) {
            played.push_back(simulation.world().resource<AtomTable>().positions);
        });
    const auto as_written = [](std::vector<Vec3> positions) {
        for (Vec3& position : positions) position = position.cast<float>().cast<double>();
        return positions;
    };
    const auto recorded = open_trajectory(recording / "trajectory.dcd");
    REQUIRE(recorded->frame_count() > 90);
    TrajectoryFrame frame;
    recorded->read_frame(0, frame);
    // The first steps may be from before the recording, since the tick that follows begins it.
    const auto begin = std::ranges::find_if(played, [&](const std::vector<Vec3>& positions) {
        return as_written(positions) == frame.positions;
    });
    const auto first = static_cast<std::size_t>(begin - played.begin());
    CHECK(first < 10);
    REQUIRE(first + recorded->frame_count() <= played.size());
    for (std::size_t i = 0; i < recorded->frame_count(); ++i) {
        recorded->read_frame(i, frame);
        CHECK(as_written(played[first + i]) == frame.positions);
    }
}
