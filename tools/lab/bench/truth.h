// What the force on the hand is where everything is completely relaxed: at poses, and after small
// moves of the hand from there.
#pragma once
#include "core/units.h"
#include "simulation/resources.h"
#include "simulation/second_order.h"
#include "statics/second_order_step.h"
#include "tools/lab/bench/stroke.h"
#include "tools/lab/experiments/rest_poses.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

inline constexpr double pN = units::piconewton_per_kcal_per_mol_angstrom;
inline constexpr double way_angstrom = 3;      // poses are evenly spaced over it, along x
inline constexpr double least_change_pN = 20;  // errors are relative to no less

// Complete relaxation, with second derivatives at every end.
class Truth {
public:
    // Forces as `second` has them. Throws LoadError where a pose is not finite.
    Truth(const TorsionModel& model, const SecondOrder& second);

    const HandHold& hand() const { return memory_.lineariser.held.hands.front(); }
    const std::shared_ptr<const LinearisedModel>& linear() const { return memory_.last; }
    const SecondOrderSettings& settings() const { return settings_; }

    // The force on the hand at rest, pN, and the state there.
    Vec3 relax(TorsionState& state);
    // The same of the state as it is.
    Vec3 evaluate(TorsionState& state);
    // Moves the hand by strides, Å, and relaxes after each.
    Vec3 follow(TorsionState& state, const Vec3& by, double stride);

    double rms() const { return rms_; }  // that was left by the last relaxation

private:
    Vec3 renew(const SecondOrderSettings& settings, TorsionState& state);
    void move(TorsionState& state, const Vec3& by) const;

    const TorsionModel& model_;
    SecondOrderSettings settings_;
    RenewalMemory memory_;
    double rms_ = 0;
};

// Along a way: how far the force on the hand is from that of complete relaxation of the same state.
struct WayErrors {
    std::vector<double> relative, squares, force_squares;

    void add(const Vec3& felt_pN, const Vec3& expected_pN);
    void add(const WayErrors& others);
    double rms() const;  // relative to the rms force
};

std::string describe(const WayErrors& errors);
// As error_median, error_90 and error_rms.
void add_way_errors(const WayErrors& errors, BenchRow& row);

// At rest, and what moves of the hand change there.
struct RestStart {
    TorsionState state;
    std::shared_ptr<const LinearisedModel> linear;
    std::vector<RestMove> moves;
};

struct AnswerPose {
    RestStart all_pairs, with_cutoff;
};

// Of both kinds of forces. In implicit water, whose forces have ends of their own, of one kind.
struct Truths {
    Truth all_pairs, with_cutoff;
    std::optional<double> cutoff;  // Å
};

// All pairs, and the scene's own cutoff or one of 12 Å.
Truths build_truths(const BenchStart& start);

SceneDescription second_order_scene(SceneDescription scene);
SceneDescription with_cutoff(SceneDescription scene, std::optional<double> cutoff);

// From a state at rest on; at each pose the hand moves by 0.1 Å along x, y and z in strides of
// 0.02 Å. Where those of 0.01 Å end elsewhere the move is a snap. Says how far it is.
std::vector<AnswerPose> find_poses(Truths& truths, TorsionState state, int count);

// To a file and back; `rest` is any state of the same model. Reading throws LoadError where energy
// or force of a pose are not those that the file has.
RestPoses rest_poses_of(const Truths& truths, const std::vector<AnswerPose>& poses);
std::vector<AnswerPose> read_poses(const std::filesystem::path& path, Truths& truths,
                                   const TorsionModel& model, const TorsionState& rest,
                                   std::optional<int> most);

}  // namespace palpa
