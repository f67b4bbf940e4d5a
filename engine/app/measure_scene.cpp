#include "app/measure_scene.h"

#include "app/notices.h"
#include "app/saving.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "experiments/tune_scene.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

constexpr std::size_t enough_steps = 200, enough_forces = 600;
constexpr double least_force_pN = 5;

double find_quantile(std::vector<double> values, double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

// A person who made no change has none to save.
void change_measured(World& app, const LiveSettings& settings) {
    const bool was_saved = is_saved(app);
    change_settings(app, settings);
    if (was_saved) note_saved(app);
}

void set_period(World& app) {
    SceneMeasure& measure = app.write<SceneMeasure>();
    measure.measures_period = false;
    if (app.resource<SettingsState>().now.period_ms != scene_of(app).period_ms)
        return;  // the person has chosen another
    const double p99_ms =
        ordinary_p99(find_quantile(measure.step_ms, 0.5), find_quantile(measure.step_ms, 0.99));
    LiveSettings settings = app.resource<SettingsState>().now;
    settings.period_ms = choose_period_ms(p99_ms);
    if (settings.period_ms == app.resource<SettingsState>().now.period_ms) return;
    change_measured(app, settings);
    tell(app,
         format_translated("steps take {:.1f} ms here, so the period is {:.0f} ms now", p99_ms,
                           settings.period_ms),
         long_notice_s);
}

void set_gains(World& app) {
    SceneMeasure& measure = app.write<SceneMeasure>();
    measure.measures_gains = false;
    const auto& now = app.resource<SettingsState>().now.coupling;
    if (now.mode != CouplingMode::Guarded || now.feel_pN != scene_of(app).coupling.feel_pN)
        return;  // the person has chosen others
    const double strong_pN = find_quantile(measure.force_pN, 0.95);
    LiveSettings settings = app.resource<SettingsState>().now;
    const std::optional<std::array<double, 2>> before = settings.coupling.feel_pN;
    settings.coupling.feel_pN = choose_range(strong_pN);
    if (settings.coupling.feel_pN == before) return;
    change_measured(app, settings);
    tell(app,
         format_translated("forces here reach {:.0f} pN: a tenth of that is felt as 0.3 N now; "
                           "change it with \"strength\" (panel Hand)",
                           strong_pN),
         long_notice_s);
}

}  // namespace

SceneMeasure begin_measure(const std::string& measured_on, const std::string& machine) {
    SceneMeasure measure;
    measure.measures_period = !measured_on.empty() && measured_on != machine;
    measure.measures_gains = measured_on == unmeasured;
    return measure;
}

void measure_scene(World& app) {
    const SceneMeasure& begun = app.resource<SceneMeasure>();
    if (!begun.measures_period && !begun.measures_gains) return;
    const Readout& readout = frame_of(app).readout;
    if (!has_frame(app) || is_replay(app) || is_study(app) || app.resource<Dialogs>().question ||
        !readout.holds_something || readout.paused || readout.steps == begun.steps)
        return;
    SceneMeasure& measure = app.write<SceneMeasure>();
    measure.steps = readout.steps;
    if (measure.measures_period) measure.step_ms.push_back(readout.step_ms);
    const double force_pN = 1e12 * led_hand(app).contact.force_newton.norm();
    if (force_pN > least_force_pN) measure.force_pN.push_back(force_pN);
    if (measure.measures_period && measure.step_ms.size() >= enough_steps) set_period(app);
    if (measure.measures_gains && measure.force_pN.size() >= enough_forces) set_gains(app);
}

}  // namespace palpa
