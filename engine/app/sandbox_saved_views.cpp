// Views that are saved, the way from one to the next, and the tour of them.
#include "app/sandbox.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "molecule/select.h"
#include "view/saved_views.h"

#include <fmt/format.h>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr double flight_s = 0.6;
constexpr std::chrono::seconds tour_stop{5};

}  // namespace

// The atoms that a selection names; none where it is wrong, and `framed_problem_` says why.
const std::vector<bool>& Sandbox::find_framed(const std::string& selection) {
    framed_now_.clear();
    framed_problem_.clear();
    if (selection.empty()) return framed_now_;
    const auto found = framed_.find(selection);
    if (found != framed_.end()) return found->second;
    try {
        const Selection parsed = parse_selection(selection);
        framed_now_ = select_as_seen(session_.copy_world(), selection);
        if (!is_constant(parsed)) return framed_now_;
        return framed_[selection] = framed_now_;
    } catch (const LoadError& error) {
        framed_problem_ = error.what();
        framed_now_.clear();
        return framed_now_;
    }
}

void Sandbox::fly_to(const OrbitCamera& camera) {
    flight_ = Flight{camera_, camera, SteadyClock::now()};
}

void Sandbox::fly() {
    if (!flight_) return;
    const auto share = static_cast<float>(1e-3 * ms_since(flight_->begin) / flight_s);
    camera_ = between(flight_->from, flight_->to, eased(share));
    if (share >= 1) flight_.reset();
}

void Sandbox::go_to(std::size_t number) {
    const SavedView& saved = saved_views_[number];
    at_view_ = number;
    ViewSettings view = view_;
    view.representation = saved.representation.value_or(options_.view.representation);
    show_as(view);
    clips_ = looks_at_grabbed_ = false;
    fly_to(saved_camera(saved, frame_.places, find_framed(saved.look_at), free_room()));
}

void Sandbox::go_to_next_view() {
    if (!has_frame_) return;
    if (saved_views_.empty())
        return notice(translated("no view is saved yet; Shift+W saves this view"));
    go_to(at_view_ ? (*at_view_ + 1) % saved_views_.size() : 0);
    if (!framed_problem_.empty()) return notice(framed_problem_);
    if (!tour_)
        notice(format_translated("{} ({} of {})", saved_views_[*at_view_].name, *at_view_ + 1,
                                 saved_views_.size()));
}

// Around what the view before looked at.
void Sandbox::add_view() {
    if (!has_frame_) return;
    SavedView saved{.name = find_free_view_name(saved_views_)};
    if (at_view_) {
        saved.look_at = saved_views_[*at_view_].look_at;
        saved.layers = saved_views_[*at_view_].layers;
    } else if (!first_.look_at.empty()) {
        saved.look_at = fmt::format("molecule \"{}\"", first_.look_at);
    }
    if (view_.representation != options_.view.representation)
        saved.representation = view_.representation;
    const OrbitCamera& camera = flight_ ? flight_->to : camera_;
    set_camera(saved, camera, frame_.places, find_framed(saved.look_at), free_room());
    if (!framed_problem_.empty()) {
        saved.look_at.clear();
        set_camera(saved, camera, frame_.places, {}, free_room());
    }
    tour_.reset();
    notice(format_translated(
        "view saved as {}; W shows the saved views, Ctrl+S writes them to a scene file",
        saved.name));
    saved_views_.push_back(std::move(saved));
    at_view_ = saved_views_.size() - 1;
}

void Sandbox::begin_or_end_tour() {
    if (end_tour()) return;
    if (saved_views_.empty()) return go_to_next_view();  // which says so
    at_view_.reset();
    tour_ = SteadyClock::now();
}

bool Sandbox::end_tour() { return std::exchange(tour_, std::nullopt).has_value(); }

void Sandbox::follow_tour() {
    if (!tour_ || SteadyClock::now() < *tour_) return;
    go_to_next_view();
    tour_ = SteadyClock::now() + tour_stop;
}

// The view that a step of the lesson names, as it begins.
void Sandbox::follow_lesson() {
    const Lesson& lesson = overlay_.lesson();
    if (!has_first_picture_ || !overlay_.shows_lesson() || options_.study) return;
    if (lesson_step_ == lesson.current() || lesson.is_done()) return;
    lesson_step_ = lesson.current();
    const std::string& name = lesson.steps()[*lesson_step_].view;
    const SavedView* const saved = name.empty() ? nullptr : find_saved_view(saved_views_, name);
    if (saved) go_to(static_cast<std::size_t>(saved - saved_views_.data()));
}

bool Sandbox::is_saved() const {
    return overlay_.settings() == saved_ && overlay_.additions() == written_additions_ &&
           saved_views_ == written_views_ && list_lasting_edits() == written_edits_;
}

// Not what is in hand, nor the coupling, which the settings have.
std::vector<EditAction> Sandbox::list_lasting_edits() const {
    std::vector<EditAction> actions;
    if (!frame_.edits) return actions;
    for (const EditDescription& edit : *frame_.edits) {
        if (kind_of(edit.action).is_of_molecules) actions.push_back(edit.action);
    }
    return actions;
}

// Now and then, so that a crash loses little.
void Sandbox::save_for_crash() {
    constexpr std::chrono::seconds between{20};
    if (!options_.save_for_crash || !has_frame_ || SteadyClock::now() < next_crash_save_) return;
    next_crash_save_ = SteadyClock::now() + between;
    if (!is_saved()) options_.save_for_crash(session_.copy_world(), describe_view());
}

void Sandbox::note_saved() {
    saved_ = overlay_.settings();
    written_additions_ = overlay_.additions();
    written_views_ = saved_views_;
    written_edits_ = list_lasting_edits();
}

}  // namespace palpa
