// Emulated operators find the place without force as well as theory says that each mode lets them.
#include "tools/lab/experiments/study_operators.h"
#include "tests/support/paths.h"

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

OperatorStudyOptions waters(const std::vector<std::string>& settings, std::size_t operators) {
    OperatorStudyOptions options;
    options.scene = test::in_project("scenes/water");
    options.settings = settings;
    options.operators = operators;
    return options;
}

StudyRow row_of(CouplingMode mode, const OperatorStudyOptions& options,
                const std::vector<StudyResult>& results) {
    for (const StudyRow& row : summarise_study(options.modes, results))
        if (row.mode == mode) return row;
    FAIL("no such mode");
    return {};
}

}  // namespace

TEST_CASE(
    "with friction variable force is several times more precise than constant force, and no "
    "force far worse",
    "[experiments][coupling]") {
    const OperatorStudyOptions options = waters({"hand.grip=medium", "device.friction_N=0.26"}, 5);

    const std::vector<StudyResult> results = play_study(options);

    const auto row = [&](CouplingMode mode) { return row_of(mode, options, results); };
    const StudyRow variable = row(CouplingMode::VariableForceConstantDisplacement);
    const StudyRow constant = row(CouplingMode::ConstantForceConstantDisplacement);
    const StudyRow nothing = row(CouplingMode::NoForce), guarded = row(CouplingMode::Guarded);
    INFO(format_study_table(summarise_study(options.modes, results)));
    CHECK(variable.distance_angstrom.mean < constant.distance_angstrom.mean / 4);
    CHECK(constant.distance_angstrom.mean < nothing.distance_angstrom.mean / 5);
    CHECK(guarded.distance_angstrom.mean < constant.distance_angstrom.mean / 3);
    for (const StudyRow& each : {variable, constant, nothing, guarded})
        CHECK(each.finished_share == 1);
    CHECK(variable.through_share == 0);
    CHECK(constant.through_share == 0);
    CHECK(guarded.through_share == 0);
    // Variable displacement, as printed, leads some through the other molecule.
    CHECK(row(CouplingMode::VariableForceVariableDisplacement).through_share > 0);
}

TEST_CASE("guarded, the place without force is found three times better than with constant gains",
          "[experiments][coupling]") {
    const std::string grip = GENERATE("medium", "firm");
    const std::string friction_N = GENERATE("0", "0.26");
    INFO(grip << ", friction " << friction_N << " N");
    OperatorStudyOptions options =
        waters({"hand.grip=" + grip, "device.friction_N=" + friction_N}, 10);
    options.modes = {CouplingMode::ConstantForceConstantDisplacement, CouplingMode::Guarded};

    const std::vector<StudyResult> results = play_study(options);

    const StudyRow constant = row_of(options.modes[0], options, results);
    const StudyRow guarded = row_of(options.modes[1], options, results);
    INFO(format_study_table(summarise_study(options.modes, results)));
    CHECK(guarded.distance_angstrom.mean <= constant.distance_angstrom.mean / 3);
    CHECK(guarded.finished_share == 1);
    CHECK(guarded.through_share == 0);
    CHECK(guarded.time_s.mean <= constant.time_s.mean + 2);
}

TEST_CASE("a trial is the same whatever is played beside it", "[experiments][coupling]") {
    OperatorStudyOptions options = waters({}, 2);
    options.rounds = 1;
    const StudyTrial trial{.participant = 2, .round = 1, .place = 1, .mode = CouplingMode::Guarded};

    const StudyResult alone = play_trial(options, trial);

    bool was_played = false;
    for (const StudyResult& result : play_study(options)) {
        if (result.trial.participant != 2 || result.trial.mode != CouplingMode::Guarded) continue;
        was_played = true;
        CHECK(result.found_angstrom == alone.found_angstrom);
        CHECK(result.seconds == alone.seconds);
    }
    CHECK(was_played);
}
