#include "session/journal.h"

#include "haptics/exchange.h"
#include "scene/read_scene.h"
#include "session/play_journal.h"
#include "tests/support/load_error_of.h"
#include "tests/support/water_scene.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

const HandDevice omni{{.name = "an \"Omni\"\n",
                       .peak_force_newton = 3.3,
                       .continuous_force_newton = 0.88,
                       .viscosity_N_s_per_m = 0.1,
                       .cap_N_per_m = 1234.5,
                       .half_workspace_m = {0.08, 0.06, 0.035}},
                      true};

const std::string hand_line =
    R"(hand {"name":"a","rate_hz":1000,"peak_force_N":3,"continuous_force_N":1,)"
    R"("viscosity_N_s_per_m":0,"cap_N_per_m":1000,"half_workspace_m":[1,1,1],"is_real":false,"stands_still":true})"
    "\n";

Journal parse(const std::string& lines) {
    return parse_journal(fmt::format("{}2.1\n{}{}", journal_mark, hand_line, lines), "journal.txt");
}

std::string error_of(const std::string& lines) {
    return test::load_error_of([&] { (void)parse(lines); });
}

LiveTick tick_of(double time_s, const Vec3& place_m) {
    LiveTick tick;
    tick.tick.reading.time_s = time_s;
    tick.tick.reading.position_m = place_m;
    tick.tick.reading.valid = true;
    tick.now_s = time_s;
    tick.order = 1;
    return tick;
}

template <class Kind>
const Kind& command_of(const Journal& journal, std::size_t event) {
    return std::get<Kind>(std::get<CommandEvent>(journal.events[event].event).command);
}

}  // namespace

TEST_CASE("a journal reads as it was written, to the last bit", "[session][journal]") {
    JournalWriter writer(std::array{omni, omni});
    std::vector<LiveTick> ticks{tick_of(0.1 + 0.2, {1.0 / 3, -0.0, 5e-324}), tick_of(7, {1, 2, 3})};
    ticks[0].is_fresh = true;
    ticks[1].tick.reading.orientation = Quat(0.1, -0.2, 0.3, std::sqrt(0.86));
    ticks[1].tick.reading.trouble = DeviceTrouble::WarmMotors;
    ticks[1].tick.reading.buttons = 5;
    ticks[1].tick.reading.at_stop = true;
    writer.add(ticks);
    ticks[0] = tick_of(
        1, {std::numeric_limits<double>::quiet_NaN(), 0, -std::numeric_limits<double>::infinity()});
    ticks[0].tick.reading.valid = false;
    ticks[0].is_ending = true;
    ticks[0].tick.contact.number = 12;
    writer.begin_recording();
    writer.add(ticks);
    LiveSettings settings;
    settings.coupling.mode = CouplingMode::NoForce;
    settings.coupling.A_d = 1 + 0.1 + 0.2;
    settings.coupling.feel_pN = {50, 400};
    settings.period_ms = 14;
    settings.hand = 1;
    const EditDescription edit{0, 1, RestraintEdit{{"a:25 CA"}, {{{1, 2, 3}}}, 7, 0.5}, {}};
    for (const LiveEvent& event : std::vector<LiveEvent>{
             PublishEvent{}, StepEvent{123.4, true}, HoldEvent{}, CommandEvent{settings},
             CommandEvent{Pause{false}}, CommandEvent{StepOnce{}}, CommandEvent{Reset{}},
             CommandEvent{Reset{5.5}}, CommandEvent{edit, true, true}, AdoptEvent{true},
             AdoptEvent{}, DeviceEvent{1, omni}, CommandEvent{ViewAdditions{{}, {"resid 1"}, {}}},
             CommandEvent{HandLead{1, true}}})
        writer.add(PlayedEvent{event, {1, 2}});

    const std::string text = writer.take();
    const Journal journal = parse_journal(text, "journal.txt");

    REQUIRE(journal.devices.size() == 2);
    CHECK(journal.devices[1].spec.name == omni.spec.name);
    CHECK(journal.devices[1].spec.half_workspace_m == omni.spec.half_workspace_m);
    CHECK(journal.devices[1].spec.cap_N_per_m == 1234.5);
    CHECK(journal.devices[1].spec.is_real);
    CHECK(journal.devices[1].stands_still);
    REQUIRE(journal.ticks.size() == 2);
    CHECK(journal.first_recorded == 1);
    CHECK(journal.ticks[0].is_fresh);
    CHECK(journal.ticks[1].is_ending);
    const JournalHand& first = journal.hands_of(0)[0];
    CHECK(first.reading.time_s == 0.1 + 0.2);
    CHECK(first.reading.position_m.x() == 1.0 / 3);
    CHECK(std::signbit(first.reading.position_m.y()));
    CHECK(first.reading.position_m.z() == 5e-324);
    CHECK(first.order == 1);
    const JournalHand& second = journal.hands_of(0)[1];
    CHECK(second.reading.orientation.coeffs() == Quat(0.1, -0.2, 0.3, std::sqrt(0.86)).coeffs());
    CHECK(second.reading.trouble == DeviceTrouble::WarmMotors);
    CHECK(second.reading.buttons == 5);
    CHECK(second.reading.at_stop == true);
    CHECK(journal.hands_of(1)[1].reading.buttons == 5);
    CHECK(std::isnan(journal.hands_of(1)[0].reading.position_m.x()));
    CHECK(std::isinf(journal.hands_of(1)[0].reading.position_m.z()));
    CHECK_FALSE(journal.hands_of(1)[0].reading.valid);
    CHECK(journal.hands_of(1)[0].contact == 12);

    REQUIRE(journal.events.size() == 14);
    CHECK(command_of<HandLead>(journal, 13).hand == 1);
    CHECK(command_of<HandLead>(journal, 13).leads);
    CHECK(command_of<ViewAdditions>(journal, 12) == ViewAdditions{});  // only that it changed
    CHECK(journal.events[4].poses == std::vector<std::uint64_t>{1, 2});
    CHECK(std::get<StepEvent>(journal.events[1].event).took_us == 123.4);
    CHECK(std::get<StepEvent>(journal.events[1].event).adopts_renewal);
    CHECK(command_of<LiveSettings>(journal, 3) == settings);
    CHECK_FALSE(command_of<Pause>(journal, 4).paused);
    CHECK_FALSE(command_of<Reset>(journal, 6).start_angstrom);
    CHECK(command_of<Reset>(journal, 7).start_angstrom == 5.5);
    CHECK(command_of<EditDescription>(journal, 8).action == edit.action);
    CHECK(command_of<EditDescription>(journal, 8).hand == 1);
    CHECK(std::get<CommandEvent>(journal.events[8].event).settles);
    CHECK(std::get<CommandEvent>(journal.events[8].event).is_long);
    CHECK_FALSE(std::get<CommandEvent>(journal.events[7].event).is_long);
    CHECK(std::get<AdoptEvent>(journal.events[9].event).settles);
    CHECK_FALSE(std::get<AdoptEvent>(journal.events[10].event).settles);
    CHECK(std::get<DeviceEvent>(journal.events[11].event).slot == 1);
    // What was cut off in its last line is what is whole of it.
    CHECK(parse_journal(text.substr(0, text.size() - 5), "j").events.size() == 13);
}

TEST_CASE("a journal has the forces of clients, within their bounds", "[session][journal]") {
    const ClientPull pull{{7, 0}, {{1.0 / 3, -0.0, 1e-300}, {0, 0, -143.9}}, 9};
    JournalWriter writer(std::array{omni});
    writer.add({CommandEvent{pull}, {1}});
    writer.add({CommandEvent{ClientPull{{}, {}, 9}}, {1}});
    const Journal journal = parse_journal(writer.take(), "journal.txt");
    REQUIRE(journal.events.size() == 2);
    CHECK(command_of<ClientPull>(journal, 0) == pull);
    CHECK(command_of<ClientPull>(journal, 1) == ClientPull{{}, {}, 9});

    const auto error_of_pull = [](const std::string& pulls) {
        return error_of(fmt::format("c 1 {{\"pull\":{},\"of\":3}}\n", pulls));
    };
    CHECK(parse("c 1 {\"pull\":[[2,0,0,143.9]],\"of\":3}\n").events.size() == 1);
    CHECK_THAT(error_of_pull("5"), Contains("'pull' is not a list"));
    CHECK_THAT(error_of_pull("[[1,2,3]]"), Contains("four numbers"));
    CHECK_THAT(error_of_pull("[[1,2,3,null]]"), Contains("four numbers"));
    CHECK_THAT(error_of_pull("[[3,1,0,0]]"), Contains("atom 3 is pulled"));
    CHECK_THAT(error_of_pull("[[-1,1,0,0]]"), Contains("atom -1 is pulled"));
    CHECK_THAT(error_of_pull("[[0.5,1,0,0]]"), Contains("atom 0.5 is pulled"));
    CHECK_THAT(error_of_pull("[[1,1,0,0],[1,1,0,0]]"), Contains("one of 3, once"));
    CHECK_THAT(error_of_pull("[[1,100,110,0]]"), Contains("too strong"));
    std::string many = "[0,0,0,0]";
    for (std::size_t i = 0; i < most_client_pulls; ++i) many += ",[0,0,0,0]";
    CHECK_THAT(error_of_pull("[" + many + "]"), Contains("at most 1000"));
    CHECK_THAT(error_of("c 1 {\"pull\":[]}\n"), Contains("has no 'of'"));
    CHECK_THAT(error_of("c 1 {\"pull\":[],\"of\":1e99}\n"), Contains("'of' is"));
}

TEST_CASE("a journal states its version, and one of another major version is refused",
          "[session][journal][format]") {
    const auto read = [&](const std::string& version, const std::string& lines) {
        return parse_journal(fmt::format("{}{}\n{}{}", journal_mark, version, hand_line, lines),
                             "journal.txt");
    };
    const auto error_of_version = [&](const std::string& version, const std::string& lines) {
        return test::load_error_of([&] { (void)read(version, lines); });
    };
    CHECK(JournalWriter(std::span(&omni, 1)).take().starts_with("# Palpa journal 2.2\n"));
    CHECK_THAT(error_of_version("1.0", "p 1\n"), Contains("journal format 1.0 is older"));
    const Journal newer = read("2.7", "p 1\n");
    REQUIRE(newer.notes.size() == 1);
    CHECK_THAT(newer.notes[0], Contains("journal format 2.7 is newer than 2.2"));
    CHECK_THAT(error_of_version("2.7", "q 1\n"), Contains("'q' is not a kind of line") &&
                                                     Contains("a newer Palpa, since the journal"));
    CHECK_THAT(error_of_version("3.0", "p 1\n"),
               Contains("journal.txt:1:1: journal format 3.0 is newer than this program reads"));
    CHECK_THAT(error_of_version("two", "p 1\n"),
               Contains("is not a journal; expected # Palpa journal 2.2"));
}

TEST_CASE("devices of a journal before 2.1 have the cap that the scene gave them",
          "[session][journal][format]") {
    SceneDescription scene;
    scene.device.viscosity_N_s_per_m = 0.25;
    const auto read = [&](const std::string& version) {
        Journal journal =
            parse_journal(fmt::format("{}{}\n{}d 1 {{\"slot\":0,{}", journal_mark, version,
                                      hand_line, hand_line.substr(hand_line.find('"'))),
                          "journal.txt");
        complete_caps(scene, journal);
        return journal;
    };
    const Journal journal = read("2.0");
    CHECK(journal.devices[0].spec.cap_N_per_m == 0);
    CHECK(journal.devices[0].spec.viscosity_N_s_per_m == 0.25);
    CHECK(std::get<DeviceEvent>(journal.events.at(0).event).device.spec.viscosity_N_s_per_m ==
          0.25);
    CHECK(read("2.1").devices[0].spec.cap_N_per_m == 1000);
    CHECK(read("2.1").devices[0].spec.viscosity_N_s_per_m == 0);
}

TEST_CASE("what a journal cannot hold is refused with its line", "[session][journal]") {
    const auto whole = [](const std::string& text) {
        return test::load_error_of([&] { (void)parse_journal(text, "journal.txt"); });
    };
    CHECK_THAT(whole(""), Contains("journal.txt") && Contains("has no complete line for a hand"));
    CHECK_THAT(whole("time_s,handle_x_m\n"),
               Contains("journal.txt:1") && Contains("is not a journal"));
    CHECK_THAT(whole(fmt::format("{}2.0\nt 0 -\n", journal_mark)),
               Contains("has no hand before the first event"));
    CHECK_THAT(error_of("q 1\n"),
               Contains("journal.txt:3") && Contains("'q' is not a kind of line"));
    CHECK_THAT(error_of("s 1\n"), Contains("a step has no time"));
    CHECK_THAT(error_of("s 1 nan\n"), Contains("a step has no time"));
    CHECK_THAT(error_of("s 5 1\ns 4 1\n"), Contains("the number of a pose does not rise"));
    CHECK_THAT(error_of("p -1\n"), Contains("a pose has no number"));
    CHECK_THAT(error_of("p 1 2\n"), Contains("too many words"));
    CHECK_THAT(error_of("t x -\n"), Contains("a tick has no time"));
    CHECK_THAT(error_of("t 0 z\n"), Contains("a tick has no flags"));
    CHECK_THAT(error_of("t 0 - 1 2\n"), Contains("'2' is not a value"));
    CHECK_THAT(error_of("t 0 - | 1\n"), Contains("too many words"));
    CHECK_THAT(error_of("record\nrecord\n"), Contains("a second recording"));
    CHECK_THAT(error_of("c 1 [1]\n"), Contains("has no object"));
    CHECK_THAT(error_of("c 1 {}\n"), Contains("has no 'edit'"));
    CHECK_THAT(error_of("c 1 {\"pause\":1}\n"), Contains("has no 'pause'"));
    CHECK_THAT(error_of("c 1 {\"edit\":\"[[edits]]\\nat_s = 0\\ntake = 5\"}\n"),
               Contains("journal.txt:3:1: edit:3:8:") && Contains("take"));
    CHECK_THAT(error_of("c 1 {\"edit\":\"a = 1\"}\n"), Contains("journal.txt:3:1: edit:1:1:"));
    // A journal may come from anybody.
    for (const char* const file : {"/etc/passwd", "../x.crd", "inputs/../../x.crd"}) {
        CHECK_THAT(
            error_of(fmt::format("c 1 {{\"edit\":\"[[edits]]\\nat_s = 0\\nadd = {{ structure = "
                                 "'{}', name = 'w', at_angstrom = [0, 0, 0] }}\"}}\n",
                                 file)),
            Contains("journal.txt:3") && Contains("outside of the scene's folder"));
    }
    CHECK_THAT(
        error_of("c 1 {\"edit\":\"[[edits]]\\nat_s = 0\\nadd = { structure = 'inputs/no.crd', "
                 "name = 'w', at_angstrom = [0, 0, 0] }\"}\n"),
        Contains("journal.txt:3") && Contains("names a file that does not exist"));
    CHECK_THAT(error_of("c 1 {\"coupling\":[\"mode = 9\"],\"period_ms\":1}\n"), Contains("mode"));
    CHECK_THAT(error_of("c 1 {\"coupling\":[],\"period_ms\":0}\n"), Contains("period"));
    CHECK_THAT(error_of("d 1 {\"slot\":3}\n"), Contains("there is no hand 3"));
    CHECK_THAT(error_of("d 1 {\"slot\":0}\n"), Contains("has no 'name'"));
    CHECK_THAT(error_of("p 1\n" + hand_line), Contains("a hand is declared too late"));
}

TEST_CASE("a journal that is none of its scene is refused where that is seen",
          "[session][journal]") {
    const SceneDescription scene = test::water_scene();
    const auto error_of_playing = [&](const std::string& lines) {
        return test::load_error_of([&] { play_journal(scene, parse(lines), {}); });
    };
    CHECK(error_of_playing("t 0 f 0 1 0 0 0 1 1\nt 0.001 -\n") == "no error");
    CHECK_THAT(error_of_playing("t 0 f 0 1 0 0 0 2 1\n"),
               Contains("uses a result that no step has produced"));
    CHECK_THAT(error_of_playing("p 9\nt 0 f 0 1 0 0 0 2 1\n"), Contains("pose 9 of hand 1"));
    CHECK_THAT(error_of_playing("p 0\np 0\nt 0 f 0 1 0 0 0 3 1\nt 0 - = = = = = 2\n"),
               Contains("refers to result 2"));
    CHECK_THAT(error_of_playing(hand_line + "t 0 - 1 | 1\n"), Contains("2 hands"));
}
