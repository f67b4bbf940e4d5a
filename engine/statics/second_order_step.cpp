#include "statics/second_order_step.h"

#include "core/repeatable.h"
#include "statics/joint_answers.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// ---- hands -------------------------------------------------------------------------------------

HandPlace find_place(const TorsionModel& model, const TorsionState& state, const HandHold& hand) {
    if (hand.spring) return {state.springs[*hand.spring].place, Quat::Identity()};
    return {state.positions[model.bases[hand.molecule].pivot], state.turns[hand.molecule]};
}

std::vector<HandPlace> find_places(const TorsionModel& model, const TorsionState& state,
                                   std::span<const HandHold> hands) {
    std::vector<HandPlace> places;
    for (const HandHold& hand : hands) places.push_back(find_place(model, state, hand));
    return places;
}

// The hands' coordinates about where they were.
Eigen::VectorXd find_hand_coordinates(std::span<const HandHold> hands,
                                      std::span<const HandPlace> from,
                                      std::span<const HandPlace> to) {
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        const Vec3 way = to[i].place - from[i].place;
        if (hands[i].turns) {
            const Vec3 turn = rotation_vector_of(to[i].turn * from[i].turn.conjugate());
            coordinates.insert(coordinates.end(), turn.begin(), turn.end());
        }
        coordinates.insert(coordinates.end(), way.begin(), way.end());
    }
    return Eigen::Map<Eigen::VectorXd>(coordinates.data(),
                                       static_cast<Eigen::Index>(coordinates.size()));
}

// By how much the force on a hand would change if the model relaxed from here: -G^T H^-1 g.
double find_unrelaxed(std::span<const HandHold> hands, const SecondOrderStatics& statics) {
    const LinearisedModel& linear = *statics.linear;
    const Eigen::VectorXd change =
        linear.answer().transpose() * statics.value.gradient.head(linear.mobile());
    return find_largest_force(hands, change);
}

// ---- steps on the model ------------------------------------------------------------------------

// The model's energy over the mobile coordinates while hands stay.
class ModelDescent {
public:
    ModelDescent(const TorsionModel& model, const SecondOrderSettings& settings,
                 TorsionState& state, SecondOrderStatics& statics)
        : model_(model), settings_(settings), state_(state), statics_(statics) {
        forces_ = -statics.value.gradient.head(mobile());
    }

    double value() const { return statics_.value.energy; }
    const Eigen::VectorXd& forces() const { return forces_; }
    const Eigen::VectorXd& trial_forces() const { return trial_forces_; }
    const Eigen::VectorXd& trial_move() const { return move_; }

    Eigen::VectorXd precondition(const Eigen::VectorXd& forces) {
        return statics_.linear->balance(forces);
    }
    static Eigen::VectorXd limit(Eigen::VectorXd direction) { return direction; }

    double try_move(Eigen::VectorXd& direction, double& length) {
        direction *= std::exchange(length, 1);
        Eigen::VectorXd at = statics_.at;
        at.head(mobile()) += direction;
        evaluate(at);
        const double moved =
            find_largest_move(model_.mobile_atoms, state_.positions, statics_.trial.positions);
        if (moved > settings_.largest_move) {
            direction *= settings_.largest_move / moved;
            at = statics_.at;
            at.head(mobile()) += direction;
            evaluate(at);
        }
        at_ = std::move(at);
        move_ = direction;
        trial_forces_ = -statics_.trial_value.gradient.head(mobile());
        return statics_.trial_value.energy;
    }

    // Single precision rounds energies by more than a step near rest gains, so slopes decide.
    bool accepts(double /*value*/, double /*linear_change*/) const {
        constexpr double turned = 0.9;
        return trial_forces_.allFinite() && trial_forces_.dot(move_) > -turned * forces_.dot(move_);
    }

    void accept() {
        swap_coordinates(statics_.trial, state_);
        statics_.at = at_;
        std::swap(statics_.value, statics_.trial_value);
        std::swap(forces_, trial_forces_);
    }

private:
    Eigen::Index mobile() const { return statics_.linear->mobile(); }
    void evaluate(const Eigen::VectorXd& at) {
        evaluate_model(model_, settings_.forces, *statics_.linear, at, statics_.near,
                       statics_.trial, statics_.trial_value);
        ++statics_.model_evaluations;
    }

    const TorsionModel& model_;
    const SecondOrderSettings& settings_;
    TorsionState& state_;
    SecondOrderStatics& statics_;
    Eigen::VectorXd forces_, trial_forces_, move_, at_;
};

// The rms force along the coordinates of the model that counts as rest.
double find_rest(const SecondOrderSettings& settings, const LinearisedModel& linear) noexcept {
    return linear.span ? settings.span_rest : settings.rest;
}

// Evaluates the model where the state is, and goes towards its rest.
void relax_model(const TorsionModel& model, const SecondOrderSettings& settings,
                 TorsionState& state, SecondOrderStatics& statics) {
    const std::span<const HandHold> hands = statics.renewals.lineariser.held.hands;
    evaluate_placed(model, settings.forces, *statics.linear, statics.at, statics.near, state,
                    statics.value);
    ++statics.model_evaluations;
    ModelDescent descent(model, settings, state, statics);
    constexpr LineSearch search{.tries = 6};
    const double rest = find_rest(settings, *statics.linear);
    const std::size_t most = settings.tolerance ? 3 * settings.evaluations : settings.evaluations;
    for (std::size_t i = 1; i < most; ++i) {
        if (!descent.forces().allFinite() || rms_of(descent.forces()) < rest) return;
        if (i >= settings.evaluations && 4 * find_unrelaxed(hands, statics) < *settings.tolerance)
            return;
        if (!step_downhill(descent, statics.pairs, search)) return;
    }
}

// Hands go by `by`, and everything follows linearly, as far as no atom goes too far at once.
void follow_linearly(const TorsionModel& model, const SecondOrderSettings& settings,
                     const Eigen::VectorXd& by, TorsionState& state, SecondOrderStatics& statics) {
    const LinearisedModel& linear = *statics.linear;
    const Eigen::VectorXd answer = linear.answer() * by;
    statics.at.tail(linear.hands()) += by;
    Eigen::VectorXd at = statics.at;
    at.head(linear.mobile()) += answer;
    place_by(model, linear, at, statics.trial);
    const double moved =
        find_largest_move(model.mobile_atoms, state.positions, statics.trial.positions);
    const double most = 2 * settings.largest_move;
    if (moved > most) {
        statics.at.head(linear.mobile()) += most / moved * answer;
        place_by(model, linear, statics.at, state);
    } else {
        statics.at = std::move(at);
        swap_coordinates(statics.trial, state);
    }
}

bool is_finite(const SecondOrderStatics& statics) {
    return std::isfinite(statics.value.energy) && statics.value.gradient.allFinite();
}

RenewalRequest request_renewal(const TorsionModel& model, const SecondOrderSettings& settings,
                               const TorsionState& state, const SecondOrderStatics& statics) {
    RenewalRequest request{state, statics.near_reach, 0, {}, {}, {}, {}};
    if (!statics.linear) return request;
    request.age = find_relative_age(model, settings, state, statics);
    const LinearisedModel& linear = *statics.linear;
    request.old = statics.linear;
    request.old_gradient = statics.value.gradient.head(linear.mobile());
    request.felt = statics.value.gradient.tail(linear.hands());
    request.at_rest =
        request.felt + linear.answer().transpose() * statics.value.gradient.head(linear.mobile());
    return request;
}

// By the age at which the model's error comes to the tolerance.
void choose_reach(const SecondOrderSettings& settings, SecondOrderStatics& statics) {
    constexpr double early = 0.7, late = 1.5, change = 1;  // Å
    double& reach = statics.near_reach;
    if (reach <= 0) reach = settings.near_reach;
    const double age = std::sqrt(*settings.tolerance / statics.error_growth);
    if (age < early) reach = std::max(reach, std::min(reach + change, settings.farthest_reach));
    if (age > late) reach = std::min(reach, std::max(reach - change, settings.nearest_reach));
}

constexpr double near_end = 0.8;  // of the region in which a model is valid

// Whether a hand has come to the end of that region.
bool is_near_end(const SecondOrderSettings& settings, const SecondOrderStatics& statics) {
    return statics.refused_way || find_farthest_way(statics.renewals.lineariser.held.hands,
                                                    statics.at.tail(statics.linear->hands())) >=
                                      near_end * find_farthest_hand(settings, statics);
}

void adopt_renewal(const TorsionModel& model, const SecondOrderSettings& settings,
                   const Renewal& renewal, SecondOrderStatics& statics) {
    if (!renewal.linear) return;
    statics.hand_waited =
        !settings.renews_at_once && statics.linear && is_near_end(settings, statics);
    statics.steps_with_model = 0;
    note_joint_answers(model, settings, renewal, statics);
    statics.linear = renewal.linear;
    statics.near = renewal.linear->near;
    statics.at = Eigen::VectorXd::Zero(renewal.linear->gradient.size());
    statics.value = {renewal.linear->at.energy(), renewal.linear->gradient};
    statics.pairs.clear();
    statics.refused_way.reset();
    statics.is_spent = false;
    statics.is_settled =
        renewal.relaxed.rms_force <= settings.relaxed || renewal.relaxed.end == RelaxEnd::Stuck;
    constexpr double at_rest = 0.002;  // Å
    statics.is_at_rest = renewal.relaxed.largest_move < at_rest;
    if (renewal.error) {
        const double age = std::max(renewal.error_age, least_error_age);
        const double growth = renewal.model_error / (age * age);
        statics.error_growth =
            statics.error_growth > 0 ? 0.5 * (statics.error_growth + growth) : growth;
        if (settings.tolerance) choose_reach(settings, statics);
    }
    ++statics.renewed;
}

// ---- one step ----------------------------------------------------------------------------------

class Step {
public:
    Step(const TorsionModel& model, const SecondOrderSettings& settings, TorsionState& state,
         SecondOrderStatics& statics, const AwaitFunction& await)
        : model_(model), settings_(settings), state_(state), statics_(statics), await_(await) {
        places_ = find_places(model, state, hands());
    }

    SecondOrderReport run() {
        statics_.start = state_.positions;
        ++statics_.steps_with_model;
        const std::size_t before = statics_.model_evaluations;
        if (!statics_.linear && !renew(true)) return report_;
        if (!place_with_springs()) return report_;
        const double way = find_farthest_way(hands(), left());
        if (prepare_still(way)) follow(way);
        describe(before);
        if (wants_renewal_ && report_.is_finite && !statics_.pending)
            statics_.pending = {request_renewal(model_, settings_, state_, statics_), {}};
        return report_;
    }

private:
    std::span<const HandHold> hands() const { return statics_.renewals.lineariser.held.hands; }
    const LinearisedModel& linear() const { return *statics_.linear; }

    // The hands' coordinates that the model has not followed yet.
    Eigen::VectorXd left() const {
        return find_hand_coordinates(hands(), find_places(model_, linear().at, hands()), places_) -
               statics_.at.tail(linear().hands());
    }

    void place() { place_by(model_, linear(), statics_.at, state_); }

    // Springs that no hand moves may be others than the model knows: then it is made anew.
    bool place_with_springs() {
        std::vector<ModelSpring> springs = state_.springs;
        place();
        for (const HandHold& hand : hands()) {
            if (hand.spring && *hand.spring < springs.size())
                springs[*hand.spring].place = state_.springs[*hand.spring].place;
        }
        if (springs == state_.springs) return true;
        if (statics_.pending && !adopt(finish_pending())) return false;
        state_.springs = std::move(springs);
        return adopt(make_now());
    }

    // False where the caller makes it later, and where it is not finite.
    bool renew(bool at_once) {
        wants_renewal_ = !at_once;
        return at_once && adopt(statics_.pending ? finish_pending() : make_now());
    }

    Renewal make_now() {
        return make_renewal(model_, settings_, request_renewal(model_, settings_, state_, statics_),
                            statics_.renewals);
    }

    Renewal finish_pending() {
        if (await_) await_();
        make_pending(model_, settings_, statics_);
        Renewal made = std::move(*statics_.pending->made);
        statics_.pending.reset();
        return made;
    }

    bool adopt(const Renewal& renewal) {
        report_.is_renewed = true;
        report_.is_finite = renewal.linear != nullptr;
        report_.full_evaluations += renewal.relaxed.evaluations;
        const double released = renewal.relaxed.energy_before - renewal.relaxed.energy_after;
        if (released > report_.released) report_.farthest_relaxed = renewal.farthest_atom;
        report_.released += released;
        if (renewal.error) report_.renewal_error = renewal.error;
        adopt_renewal(model_, settings_, renewal, statics_);
        if (report_.is_finite) place();
        return report_.is_finite;
    }

    static constexpr double moved = 0.01;  // of a stride: less is no move

    // Whether hands are not where they came to stand, however slowly they go.
    bool has_moved() {
        std::vector<HandPlace>& still = statics_.still_at;
        if (still.size() == places_.size() &&
            find_farthest_way(hands(), find_hand_coordinates(hands(), still, places_)) <=
                moved * settings_.stride)
            return false;
        still = places_;
        return true;
    }

    // Where hands stand still, after some steps everything relaxes on the whole energy alone: along
    // soft coordinates the model's minimum may lie where the energy is higher. Returns whether
    // the hands are still to be followed.
    bool prepare_still(double way) {
        constexpr double rounding = 1e-9;  // Å: a longer way is a hand that creeps
        // A hand that waited for this model goes on once the servo has it.
        constexpr std::size_t until_it_goes_on = 2;  // steps
        const bool goes_on = statics_.hand_waited && statics_.steps_with_model <= until_it_goes_on;
        if (has_moved() || goes_on || way > moved * settings_.stride) {
            statics_.still_steps = 0;
            statics_.is_at_rest = false;
            return true;
        }
        if (statics_.is_at_rest) return way > rounding;
        if (is_old()) statics_.still_steps = settings_.still_steps;
        if (statics_.still_steps < settings_.still_steps) {
            ++statics_.still_steps;
            return true;
        }
        (void)renew(settings_.renews_at_once);
        if (report_.is_finite && way > rounding) creep();
        return false;
    }

    // Hands go on with all that follows them linearly, without a relaxation on the model.
    void creep() {
        const Eigen::VectorXd by = left(), at = statics_.at;
        report_.lags = is_beyond(by);
        if (report_.lags) return;
        follow_linearly(model_, settings_, by, state_, statics_);
        if (!model_holds()) move_hands_alone(at, by);
        evaluate();
    }

    void move_hands_alone(const Eigen::VectorXd& from, const Eigen::VectorXd& by) {
        statics_.at = from;
        statics_.at.tail(linear().hands()) += by;
        place();
    }

    void evaluate() {
        evaluate_placed(model_, settings_.forces, linear(), statics_.at, statics_.near, state_,
                        statics_.value);
    }

    bool is_old() const {
        const double way = find_farthest_way(hands(), statics_.at.tail(linear().hands()));
        const double farthest =
            find_largest_move(model_.mobile_atoms, linear().at.positions, state_.positions);
        if (!statics_.is_settled || farthest > settings_.renew_atom) return true;
        // Hands that stay at the end of the region are to have another.
        constexpr double near = 0.7;
        const double end = near_end * find_farthest_hand(settings_, statics_);
        if (!settings_.tolerance) return way >= std::min(settings_.renew_hand, end);
        return way >= end || error_estimate() > near * *settings_.tolerance;
    }

    double error_estimate() const {
        const double age = find_relative_age(model_, settings_, state_, statics_);
        return repeatable::hypot(find_unrelaxed(hands(), statics_),
                                 statics_.error_growth * age * age);
    }

    void follow(double way) {
        const double stride =
            std::max(settings_.stride, way / static_cast<double>(settings_.most_strides));
        bool is_tried = false;  // one renewal a step where a state does not settle, or at one point
        int tries = 0;          // of new models, where hands are to go
        for (bool is_there = false; !is_there;) {
            if (is_old() && !(is_tried && (is_at_point() || !statics_.is_settled))) {
                is_tried = true;
                if (renew(settings_.renews_at_once)) continue;
                if (!report_.is_finite) return;
            }
            const Eigen::VectorXd rest = left();
            const double length = find_farthest_way(hands(), rest);
            is_there = length <= stride;
            const Eigen::VectorXd by = is_there ? rest : Eigen::VectorXd(rest * (stride / length));
            report_.lags = (wants_renewal_ || statics_.refused_way) && is_beyond(by);
            if (report_.lags) {
                wants_renewal_ = true;
                relax_waiting();
                return;
            }
            const bool is_new = is_at_point();
            if (try_stride(by)) continue;
            // A state that new models cannot hold relaxes on in the steps that follow.
            constexpr int most_tries = 20;
            is_there = is_there && is_new && ++tries > most_tries;
            report_.lags = !settings_.renews_at_once;
            if (!renew(settings_.renews_at_once)) return;
        }
    }

    bool is_at_point() const { return statics_.at.squaredNorm() == 0; }

    bool is_beyond(const Eigen::VectorXd& by) const {
        const Eigen::VectorXd d = statics_.at.tail(linear().hands());
        const double next = find_farthest_way(hands(), d + by);
        if (statics_.refused_way && next >= *statics_.refused_way) return true;
        return next > find_farthest_hand(settings_, statics_) &&
               next > find_farthest_way(hands(), d);
    }

    // False, and everything is as it was, where an atom would leave the region of the model, or
    // come too close to another. With a model that is new nothing better can be had: then the hand
    // alone goes on, before everything relaxes on the whole energy.
    bool try_stride(const Eigen::VectorXd& by) {
        const Eigen::VectorXd at = statics_.at;
        const ModelValue value = statics_.value;
        follow_linearly(model_, settings_, by, state_, statics_);
        relax_model(model_, settings_, state_, statics_);
        if (model_holds()) return true;
        ++statics_.discarded;
        go_back(at, value);
        if (!is_at_point()) {
            statics_.refused_way = find_farthest_way(hands(), at.tail(linear().hands()) + by);
            if (!settings_.renews_at_once) go_part_of(by);
            return false;
        }
        move_hands_alone(at, by);
        if (!settings_.renews_at_once) evaluate();
        return false;
    }

    // Goes as much of a stride as the model allows.
    void go_part_of(const Eigen::VectorXd& by) {
        const Eigen::VectorXd at = statics_.at;
        const ModelValue value = statics_.value;
        for (const double share : {0.5, 0.25}) {
            follow_linearly(model_, settings_, share * by, state_, statics_);
            relax_model(model_, settings_, state_, statics_);
            if (model_holds()) return;
            go_back(at, value);
        }
    }

    void go_back(const Eigen::VectorXd& at, const ModelValue& value) {
        statics_.at = at;
        statics_.value = value;
        statics_.pairs.clear();
        place();
    }

    bool model_holds() const {
        return is_finite(statics_) &&
               find_largest_move(model_.mobile_atoms, linear().at.positions, state_.positions) <
                   settings_.farthest * (statics_.hand_waited ? wider_for_fast_hands : 1) &&
               !are_too_close(linear().close, state_.positions);
    }

    // While hands wait for a new model.
    void relax_waiting() {
        const double rms_force = rms_of(statics_.value.gradient.head(linear().mobile()));
        if (statics_.is_spent || rms_force < find_rest(settings_, linear())) return;
        const Eigen::VectorXd at = statics_.at;
        const ModelValue value = statics_.value;
        relax_model(model_, settings_, state_, statics_);
        statics_.is_spent = !model_holds();
        if (statics_.is_spent) go_back(at, value);
    }

    void describe(std::size_t before) {
        if (!report_.is_finite) return;
        report_.energy = statics_.value.energy;
        report_.rms_force = rms_of(statics_.value.gradient.head(linear().mobile()));
        report_.age = find_farthest_way(hands(), statics_.at.tail(linear().hands()));
        report_.farthest =
            find_largest_move(model_.mobile_atoms, linear().at.positions, state_.positions);
        report_.largest_move =
            find_largest_move(model_.mobile_atoms, statics_.start, state_.positions);
        report_.error_estimate = error_estimate();
        report_.model_evaluations = statics_.model_evaluations - before;
    }

    const TorsionModel& model_;
    const SecondOrderSettings& settings_;
    TorsionState& state_;
    SecondOrderStatics& statics_;
    const AwaitFunction& await_;
    std::vector<HandPlace> places_;  // where hands want what they hold
    bool wants_renewal_ = false;     // by the caller, later
    SecondOrderReport report_;
};

}  // namespace

double find_farthest_hand(const SecondOrderSettings& settings,
                          const SecondOrderStatics& statics) noexcept {
    return settings.farthest_hand * (statics.hand_waited ? wider_for_fast_hands : 1);
}

SecondOrderStatics build_second_order_statics(const TorsionModel& model, HeldParts held) {
    SecondOrderStatics statics;
    statics.renewals.lineariser = build_lineariser(model, std::move(held));
    statics.renewals.full = build_quasi_statics(model);
    statics.trial = build_torsion_state(model);
    return statics;
}

void start_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                        const TorsionState& state, SecondOrderStatics& statics) {
    SecondOrderSettings as_it_is = settings;
    as_it_is.least_relaxation = as_it_is.most_relaxation = 0;
    adopt_renewal(model, settings,
                  make_renewal(model, as_it_is, request_renewal(model, settings, state, statics),
                               statics.renewals),
                  statics);
    statics.is_at_rest = false;
}

SecondOrderReport step_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                                    TorsionState& state, SecondOrderStatics& statics,
                                    const AwaitFunction& await) {
    return Step(model, settings, state, statics, await).run();
}

void make_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                  SecondOrderStatics& statics) {
    PendingRenewal& pending = *statics.pending;
    if (!pending.made)
        pending.made = make_renewal(model, settings, std::move(pending.request), statics.renewals);
}

Renewal adopt_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                      SecondOrderStatics& statics) {
    make_pending(model, settings, statics);
    Renewal renewal = std::move(*statics.pending->made);
    statics.pending.reset();
    adopt_renewal(model, settings, renewal, statics);
    return renewal;
}

double find_relative_age(const TorsionModel& model, const SecondOrderSettings& settings,
                         const TorsionState& state, const SecondOrderStatics& statics) {
    const LinearisedModel& linear = *statics.linear;
    return std::max(
        find_farthest_way(statics.renewals.lineariser.held.hands, statics.at.tail(linear.hands())) /
            settings.renew_hand,
        find_largest_move(model.mobile_atoms, linear.at.positions, state.positions) /
            settings.renew_atom);
}

Vec6 find_hand_pull(const SecondOrderStatics& statics, std::size_t hand) noexcept {
    const std::vector<HandHold>& hands = statics.renewals.lineariser.held.hands;
    Eigen::Index column = statics.linear->mobile();
    for (std::size_t i = 0; i < hand; ++i) column += hands[i].turns ? 6 : 3;
    Vec6 pull = Vec6::Zero();
    const Eigen::VectorXd& gradient = statics.value.gradient;
    if (hands[hand].turns) {
        pull = -gradient.segment<6>(column);
    } else {
        pull.tail<3>() = -gradient.segment<3>(column);
    }
    return pull;
}

}  // namespace palpa
