#include "session/live_simulation.h"

#include "core/assertion.h"
#include "core/load_error.h"
#include "loading/edit.h"
#include "loading/engine_atoms.h"
#include "loading/load.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/playback.h"
#include "simulation/remote_engine.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/follow_engine.h"
#include "simulation/systems/follow_hands.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

namespace palpa {
namespace {

// While nothing moves, the hand feels nothing and has no hold.
LocalContactModel without_force(const LocalContactModel& contact) {
    LocalContactModel still(contact.model);
    still.model.force_newton.setZero();
    still.model.is_still = true;
    return still;
}

void set_period(const SceneDescription& scene, World& world) {
    const double period_s = scene.period_ms * 1e-3;
    world.write<Clock>().period_s = period_s;
    world.write_each<Contact>(
        [&](Entity, Contact& contact) { contact.sent.model.period_s = period_s; });
}

// No step waits for a renewal of second order. Where forces must be exact by another method, real
// time is what limits the work for it, unless the scene does.
SceneDescription as_live(SceneDescription scene) {
    constexpr double share = 0.8;
    scene.statics.renews_beside = true;
    const bool is_second_order = method_of(scene.statics) == RelaxMethod::SecondOrder;
    bool is_asked = false;
    for (std::size_t hand = 0; hand < scene.hands.size(); ++hand)
        is_asked = is_asked || coupling_of(scene, hand).feel_within_pN;
    if (is_asked && !scene.statics.budget_us && !is_second_order)
        scene.statics.budget_us = share * 1e3 * scene.period_ms;
    return scene;
}

}  // namespace

LiveSimulation::LiveSimulation(const SceneDescription& scene, std::vector<HandDevice> devices,
                               ServoLine& line, const std::optional<PlaybackChoice>& playback,
                               const StageFunction& on_stage)
    : scene_(scene),
      devices_(std::move(devices)),
      line_(line),
      world_(load_world(as_live(scene), on_stage)),
      edits_(scene),
      lesson_(scene, world_),
      poses_(devices_.size()),
      felt_(devices_.size()),
      contacts_(devices_.size()),
      orders_(devices_.size()) {
    additions_ = additions_of(scene.view);
    leads_.resize(devices_.size());
    PALPA_ASSERT(!devices_.empty() && devices_.size() <= find_hands(world_).size());
    for (const HandDevice& device : devices_) check_period(device.spec, scene.period_ms * 1e-3);
    if (playback) start_playback(world_, playback->file, playback->order);
    // So that what is first seen is where the engine has it.
    if (lacks_coordinates(scene)) begin_with_engine(world_);
    play(PublishEvent{});
    post_orders();
}

LiveSimulation::~LiveSimulation() { leave_engine(world_); }

std::vector<EditDescription> LiveSimulation::list_edits() const {
    std::vector<EditDescription> edits = history_.list_edits();
    std::erase_if(edits, [](const EditDescription& edit) { return edit.place.line > 0; });
    return edits;
}

PersonChoices LiveSimulation::choices() const {
    PersonChoices choices{{}, additions_};
    for (std::size_t slot = 0; slot < devices_.size(); ++slot)
        choices.settings.push_back(settings_of(scene_, slot));
    return choices;
}

bool LiveSimulation::all_stand_still() const noexcept {
    return std::ranges::all_of(devices_, &HandDevice::stands_still);
}

void LiveSimulation::play(const LiveEvent& event, std::span<const HandPose> poses) {
    PALPA_ASSERT(poses.size() == poses_.size());
    std::ranges::copy(poses, poses_.begin());
    std::visit([this](const auto& one) { play(one); }, event);
}

void LiveSimulation::play(const PublishEvent& /*event*/) {
    const std::vector<Entity> hands = find_hands(world_);
    for (std::size_t slot = 0; slot < devices_.size(); ++slot)
        post(slot, contact_of(world_, hands[slot]).sent);
}

void LiveSimulation::play(const StepEvent& event) {
    if (draft_) return;  // or the edit would undo what the step did
    for (const EditDescription& due : edits_.take_due(time_s_)) edit(due, false);
    if (pull_) world_.set_resource(*pull_);  // what edits brought back has an older one
    begin_pulls();
    const StepReport& report = step_world(
        world_,
        {poses_, felt_, event.took_us, event.adopts_renewal, [this] { renewals_.await(); }});
    note_pulls();
    readout_.step_ms = 1e-3 * report.took_us;
    ++readout_.steps;
    readout_.engine = describe_engine(world_);
    lesson_.measure(world_);
    readout_.lesson = lesson_.measures();
    follow_unbinding();
    time_s_ += world_.resource<Clock>().period_s;
}

void LiveSimulation::play(const HoldEvent& /*event*/) {
    const std::vector<Entity> hands = find_hands(world_);
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) {
        begin_grip(world_, hands[slot], poses_[slot]);
        post(slot, without_force(contact_of(world_, hands[slot]).sent));
    }
}

void LiveSimulation::play(const CommandEvent& event) {
    if (const auto* const settings = std::get_if<LiveSettings>(&event.command)) {
        apply(*settings);
    } else if (const auto* const additions = std::get_if<ViewAdditions>(&event.command)) {
        if (!undoes_edits_alone_) history_.note_additions(additions_);
        additions_ = *additions;
        publish_history();
    } else if (const auto* const lead = std::get_if<HandLead>(&event.command)) {
        if (lead->hand < leads_.size()) leads_[lead->hand] = lead->leads;
    } else if (const auto* const pause = std::get_if<Pause>(&event.command)) {
        apply(*pause);
    } else if (std::holds_alternative<StepOnce>(event.command)) {
        readout_.paused = true;
        pause_engine(world_, true);
        post_orders();
    } else if (const auto* const anew = std::get_if<Reset>(&event.command)) {
        apply(*anew);
    } else if (const auto* const pull = std::get_if<ClientPull>(&event.command)) {
        pull_ = *pull;
    } else if (const auto* const change = std::get_if<EditDescription>(&event.command)) {
        if (!event.is_long) return edit(*change, event.settles);
        renewals_.await();
        draft_ = Draft{world_, *change, {}, {}};
        readout_.edit_under_way = undo_name(change->action);
    }
}

void LiveSimulation::play(const DeviceEvent& event) {
    devices_[event.slot] = event.device;
    begin_new_grips(list_grip_numbers());
    post_orders();  // or it would take one that was meant for the device before
}

void LiveSimulation::apply(const LiveSettings& settings) {
    const LiveSettings before = settings_of(scene_, settings.hand);
    set(settings);
    if (!undoes_edits_alone_)
        history_.note_settings(before, settings_of(scene_, settings.hand), poses_.front().time_s);
    publish_history();
}

void LiveSimulation::set(const LiveSettings& settings) {
    readout_.problem.clear();
    if (can_build_laws(settings.coupling)) {
        set_coupling(settings, scene_);
    } else {
        readout_.problem =
            "eq. 2 with these values cannot reach the slopes A_f_max and A_f_min, so the previous "
            "force law stays; change F_h1, F_h2 or F_0";
    }
    try {
        for (const HandDevice& device : devices_)
            check_period(device.spec, settings.period_ms * 1e-3);
        scene_.period_ms = settings.period_ms;
    } catch (const LoadError& error) {
        readout_.problem = error.what();
    }
    set_couplings(scene_, world_);
    set_period(scene_, world_);
    post_orders();
}

void LiveSimulation::apply(const Pause& pause) {
    if (!all_stand_still()) play(HoldEvent{});  // not what was travelled since the last look
    readout_.paused = pause.paused;
    pause_engine(world_, pause.paused);
    post_orders();
}

void LiveSimulation::apply(const Reset& reset) {
    ++readout_.resets;
    if (!places_atoms(world_)) {
        readout_.problem = "reset is not possible: a remote engine moves the atoms";
        return;
    }
    if (reset.start_angstrom) scene_.hands.front().start_angstrom = reset.start_angstrom;
    const std::vector<std::uint32_t> last_grip_numbers = list_grip_numbers();
    renewals_.await();
    try {
        World start = load_world(as_live(scene_));
        carry_playback(world_, start);
        lesson_ = LessonMeter(scene_, start);
        readout_.lesson = lesson_.measures();
        world_ = std::move(start);
    } catch (const LoadError& error) {  // the files changed meanwhile: what runs, runs on
        readout_.problem = error.what();
        return;
    }
    history_.forget_worlds();
    held_since_.clear();
    draft_.reset();
    unbinding_.reset();
    readout_.edit_under_way.clear();
    edits_ = EditPlayer(scene_);
    publish_history();
    time_s_ = 0;
    ++edition_;
    readout_.problem.clear();
    begin_new_grips(last_grip_numbers);
    post_orders();
}

bool LiveSimulation::takes_long(const EditDescription& edit) const noexcept {
    constexpr std::size_t many_atoms = 1000;
    return world_.resource<AtomTable>().positions.size() >= many_atoms && places_atoms(world_) &&
           (needs_mechanics(world_) || makes_mobile(edit.action)) && !kind_of(edit.action).is_quick;
}

void LiveSimulation::build_draft() noexcept {
    if (!draft_ || draft_->changed || !draft_->refusal.empty()) return;
    try {
        draft_->changed = make_edit(draft_->before, draft_->edit);
    } catch (const LoadError& error) {
        draft_->refusal = error.what();
    }
}

void LiveSimulation::play(const AdoptEvent& event) {
    if (!draft_) return;  // the scene was loaded anew meanwhile
    renewals_.await();
    build_draft();
    Draft draft = std::move(*draft_);
    draft_.reset();
    readout_.edit_under_way.clear();
    if (!draft.changed) return refuse(draft.edit, std::move(draft.refusal));
    history_.adopt(world_, std::move(*draft.changed), draft.edit);
    held_since_.clear();
    publish_edit(event.settles);
}

void LiveSimulation::start_renewal() {
    if (const std::optional<RenewalWork> work = find_renewal(world_))
        renewals_.start_if_pending(work->model, work->settings, work->statics);
}

bool LiveSimulation::has_renewal() {
    const std::optional<RenewalWork> work = find_renewal(world_);
    return work && renewals_.is_ready(work->statics);
}

void LiveSimulation::edit(const EditDescription& edit, bool settles) {
    renewals_.await();
    const PersonChoices before = choices();
    PersonChoices chosen = before;
    UndoHistory::Part part{};
    try {
        part = history_.apply(world_, edit, chosen);
    } catch (const LoadError& error) {
        return refuse(edit, error.what());
    }
    if (part == UndoHistory::Part::World) {
        held_since_.clear();
        return publish_edit(settles);
    }
    additions_ = chosen.additions;
    if (part == UndoHistory::Part::Settings)
        for (std::size_t hand = 0; hand < chosen.settings.size(); ++hand)
            if (chosen.settings[hand] != before.settings[hand]) set(chosen.settings[hand]);
    ++readout_.undo.restored;
    publish_history();
}

// Keeps the world in which each hand begins to hold, or last rested.
void LiveSimulation::begin_pulls() {
    constexpr double rest_s = 10, rest_angstrom = 0.02;
    if (undoes_edits_alone_ || !places_atoms(world_) || world_.find_resource<Playback>()) return;
    const std::vector<Entity> hands = find_hands(world_);
    held_since_.resize(poses_.size());
    for (std::size_t slot = 0; slot < poses_.size(); ++slot) {
        std::optional<HeldSince>& since = held_since_[slot];
        const Entity hand = hands[slot];
        // The handle of a mouse moves by itself while nobody leads it.
        const bool holds = devices_[slot].stands_still ? leads_[slot] : !poses_[slot].is_clutched;
        if (!holds || !world_.find<Grip>(hand)) {
            since.reset();
            continue;
        }
        const Vec3 place = held_place(world_, hand);
        if (since && (place - since->last).norm() > rest_angstrom) {
            since->last = place;
            since->moved_s = time_s_;
        }
        if (since && time_s_ - since->moved_s < rest_s) continue;
        since = HeldSince{world_.without_caches(), place, grip_of(world_, hand).pose.orientation,
                          poses_[slot].travel_m,   place, time_s_};
    }
}

// Adds the pulls in which a person has moved the handle and what it holds.
void LiveSimulation::note_pulls() {
    constexpr double least_angstrom = 0.2, least_rad = 0.05, least_m = 0.5e-3;
    const std::vector<Entity> hands = find_hands(world_);
    for (std::size_t slot = 0; slot < held_since_.size(); ++slot) {
        std::optional<HeldSince>& since = held_since_[slot];
        if (!since || since->is_noted) continue;
        const Grip& grip = grip_of(world_, hands[slot]);
        const double turn = grip.pose.orientation.angularDistance(since->turn);
        const double way = (held_place(world_, hands[slot]) - since->place).norm();
        const double travel = (poses_[slot].travel_m - since->travel_m).norm();
        const bool is_moved =
            way > least_angstrom && (devices_[slot].stands_still || travel > least_m);
        if (!is_moved && turn < least_rad) continue;
        history_.note_pull(std::exchange(since->before, {}),
                           world_.find<Molecule>(grip.molecule)->name);
        since->is_noted = true;
        // Other hands that have not pulled yet begin anew, so that the history stays in order.
        for (std::size_t other = 0; other < held_since_.size(); ++other) {
            if (held_since_[other] && !held_since_[other]->is_noted) held_since_[other].reset();
        }
        publish_history();
    }
}

void LiveSimulation::publish_history() {
    UndoReadout& undo = readout_.undo;
    undo.undo = history_.undo_name();
    undo.redo = history_.redo_name();
    undo.dropped = history_.dropped();
    undo.dropped_name = history_.dropped_name();
    undo.additions = additions_;
}

void LiveSimulation::refuse(const EditDescription& edit, std::string why) {
    readout_.problem = std::move(why);
    const bool is_back_or_forth = std::holds_alternative<UndoEdit>(edit.action) ||
                                  std::holds_alternative<RedoEdit>(edit.action);
    if (!is_back_or_forth) ++readout_.refused_edits;
}

// Between two steps. The hands hold on, and the servos glide from what was felt to what is felt
// now.
void LiveSimulation::publish_edit(bool settles) {
    readout_.problem.clear();
    if (history_.has_changed_coupling()) {
        keep_couplings(world_, scene_);
        ++readout_.undo.restored;
    }
    set_couplings(scene_, world_);
    set_period(scene_, world_);
    publish_history();
    ++edition_;
    post_orders();
    if (settles || (readout_.paused && !all_stand_still())) return play(HoldEvent{});
    if (!readout_.paused) return play(PublishEvent{});
    const std::vector<Entity> hands = find_hands(world_);
    for (std::size_t slot = 0; slot < devices_.size(); ++slot)
        felt_[slot] = contact_of(world_, hands[slot]).sent.model;
}

void LiveSimulation::follow_unbinding() {
    const bool is_held = world_.find<Grip>(hand_at(world_, 0)) != nullptr;
    if (!has_mobile(world_) || !is_held || !places_atoms(world_)) return;
    const bool is_other = std::exchange(unbinding_edition_, edition_) != edition_;
    if (!unbinding_ || (is_other && !unbinding_->suits(world_))) {
        unbinding_.emplace(world_, poses_.front().time_s);
    } else if (constexpr std::uint64_t steps_apart = 10;  // each looks at all pairs of heavy atoms
               world_.resource<Clock>().steps % steps_apart == 0) {
        unbinding_->add(world_, poses_.front().time_s);
    }
}

std::optional<UnbindingPath> LiveSimulation::unbinding() const {
    if (!unbinding_) return {};
    return unbinding_->unbinding();
}

std::vector<std::uint32_t> LiveSimulation::list_grip_numbers() const {
    std::vector<std::uint32_t> numbers;
    for (const Entity hand : find_hands(world_))
        numbers.push_back(contact_of(world_, hand).sent.model.grip_number);
    return numbers;
}

void LiveSimulation::begin_new_grips(std::span<const std::uint32_t> last_grip_numbers) {
    ++restarts_;
    const std::vector<Entity> hands = find_hands(world_);
    for (std::size_t slot = 0; slot < hands.size(); ++slot)
        world_.write<Contact>(hands[slot])->sent.model.grip_number = last_grip_numbers[slot] + 1;
    play(HoldEvent{});
}

void LiveSimulation::post(std::size_t slot, const LocalContactModel& contact) {
    felt_[slot] = contact.model;
    line_.post(slot, contact, ++contacts_[slot]);
}

// A hand takes hold quietly; laws that are exchanged glide.
void LiveSimulation::post_order(std::size_t slot) {
    const DeviceSpec& device = devices_[slot].spec;
    ServoOrder order{build_servo_settings(scene_, world_, slot, device), restarts_,
                     all_stand_still() && readout_.paused, ++orders_[slot]};
    SafetySettings& safety = order.settings.safety;
    safety.starts_engaged = false;
    limit_to(device, safety);
    if (order.settings.guarded) order.settings.guarded->revision = revision_++;
    line_.post(slot, order);
}

void LiveSimulation::post_orders() {
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) post_order(slot);
}

}  // namespace palpa
