#include "devices/force_joystick.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace palpa {
namespace {

constexpr HidUsage x_axis = 0x010030, y_axis = 0x010031, first_button = 0x090001;

// Page 0x0F. Reports and other groups of fields:
constexpr HidUsage set_effect = 0x0f0021, axes_enable = 0x0f0055, direction = 0x0f0057;
constexpr HidUsage set_constant_force = 0x0f0073, effect_operation = 0x0f0077;
constexpr HidUsage device_gain_report = 0x0f007d, block_load = 0x0f0089, create_effect = 0x0f00ab;
// Fields:
constexpr HidUsage block_index = 0x0f0022, duration = 0x0f0050, gain = 0x0f0052;
constexpr HidUsage trigger_button = 0x0f0053, direction_enable = 0x0f0056, magnitude = 0x0f0070;
constexpr HidUsage loop_count = 0x0f007c, device_gain = 0x0f007e, first_ordinal = 0x0a0001;
// Values:
constexpr HidUsage constant_force = 0x0f0026, op_start = 0x0f0079, op_stop = 0x0f007b;
constexpr HidUsage load_success = 0x0f008c, load_full = 0x0f008d;
constexpr HidUsage enable_actuators = 0x0f0097, disable_actuators = 0x0f0098;
constexpr HidUsage stop_all_effects = 0x0f0099, device_reset = 0x0f009a;

// What a constant force takes, and how a person finds it in the specification.
struct Needed {
    HidReportKind kind;
    HidUsage usage, inside;
    std::string_view name;
};
constexpr std::array needed{
    Needed{HidReportKind::Input, x_axis, 0, "X axis"},
    Needed{HidReportKind::Output, block_index, set_effect, "Set Effect report"},
    Needed{HidReportKind::Output, constant_force, set_effect, "constant force in Set Effect"},
    Needed{HidReportKind::Output, block_index, set_constant_force, "Set Constant Force report"},
    Needed{HidReportKind::Output, magnitude, set_constant_force, "magnitude"},
    Needed{HidReportKind::Output, op_start, effect_operation, "Effect Operation report"},
    Needed{HidReportKind::Output, op_stop, effect_operation, "stop in Effect Operation"},
    Needed{HidReportKind::Output, enable_actuators, 0, "Device Control report"},
    Needed{HidReportKind::Feature, constant_force, create_effect, "Create New Effect report"},
    Needed{HidReportKind::Feature, block_index, block_load, "Block Load report"},
    Needed{HidReportKind::Feature, load_success, block_load, "status in Block Load"},
};

bool is_stick(const HidPlace& place) noexcept {
    return place.usage_page == hid_usage::generic_desktop_page &&
           (place.usage == hid_usage::joystick || place.usage == hid_usage::game_pad);
}

// A report that is filled in field by field: the one with a field of that usage `inside`.
class Draft {
public:
    Draft(const HidDescriptor& descriptor, HidReportKind kind, HidUsage usage, HidUsage inside)
        : descriptor_(descriptor), inside_(inside) {
        const HidField* const field = find_field(descriptor, kind, usage, inside);
        if (!field) return;
        report_ = *find_report(descriptor, kind, field->report);
        bytes_.resize(report_.bytes());
        bytes_[0] = report_.number;
    }

    // What it does not have is left out.
    Draft& put(HidUsage usage, std::int64_t value) { return put(find(usage), value); }
    Draft& choose(HidUsage usage) {
        const HidField* const field = find(usage);
        return field ? put(field, number_of(descriptor_, *field, usage)) : *this;
    }
    Draft& put_most(HidUsage usage) {
        const HidField* const field = find(usage);
        return field ? put(field, field->logical_max) : *this;
    }
    Draft& put(const HidField* field, std::int64_t value) {
        if (field) write_field(bytes_, *field, value);
        return *this;
    }

    const HidField* find(HidUsage usage) const noexcept {
        return find_field(descriptor_, report_.kind, usage, inside_);
    }
    const std::vector<std::uint8_t>& bytes() const noexcept { return bytes_; }
    bool send(HidLine& line) const {
        if (bytes_.empty()) return true;
        return report_.kind == HidReportKind::Feature ? line.write_feature(bytes_)
                                                      : line.write(bytes_);
    }

private:
    const HidDescriptor& descriptor_;
    HidUsage inside_;
    HidReport report_;
    std::vector<std::uint8_t> bytes_;
};

// All bits: beyond the range of most devices, which is how PID 1.0 says "null", and the longest
// time on the others.
constexpr std::int64_t for_ever = -1;

// A number that is no button's.
std::int64_t no_button(const HidField& field) noexcept { return field.logical_min > 0 ? 0 : -1; }

// A full turn is the whole range.
std::int64_t angle_of(const HidField& field, double deg) noexcept {
    return std::llround(static_cast<double>(field.logical_min) +
                        deg / 360 * static_cast<double>(field.logical_max - field.logical_min));
}

// Of -1 to 1: whole steps, and never more than what was asked for.
std::int64_t steps_of(double share, const HidField& field) noexcept {
    constexpr double rounding = 1e-9;
    const std::int64_t most = std::min(field.logical_max, -field.logical_min);
    return static_cast<std::int64_t>(share * static_cast<double>(most) +
                                     std::copysign(rounding, share));
}

// -1 to 1 over the range of the axis.
double deflection_of(const HidField& field, std::int64_t value) noexcept {
    const auto from = static_cast<double>(field.logical_min);
    const auto to = static_cast<double>(field.logical_max);
    return to > from
               ? std::clamp(2 * (static_cast<double>(value) - from) / (to - from) - 1, -1., 1.)
               : 0;
}

}  // namespace

bool ForceJoystickProtocol::is_ours(const HidPlace& place) const noexcept {
    return is_stick(place) &&
           ForceJoystickProtocol().use(read_report_descriptor(place.path)).empty();
}

std::string ForceJoystickProtocol::why_not(const HidPlace& place) const {
    if (!is_stick(place)) return "";
    const std::string lacking = ForceJoystickProtocol().use(read_report_descriptor(place.path));
    return lacking.empty() ? "" : fmt::format("a joystick without a usable force: {}", lacking);
}

void ForceJoystickProtocol::describe(DeviceSpec& spec) const noexcept {
    spec.peak_force_newton = peak_newton;
    spec.half_workspace_m.setConstant(half_travel_m);
}

std::string ForceJoystickProtocol::use(HidBytes descriptor) {
    axes_.clear();
    descriptor_ = build_hid_descriptor(descriptor);
    if (descriptor.empty()) return "its report descriptor cannot be read (that takes Linux)";
    if (!descriptor_.wrong.empty()) {
        return fmt::format("its report descriptor is wrong: {}", descriptor_.wrong);
    }
    for (const Needed& one : needed) {
        const HidField* const field = find_field(descriptor_, one.kind, one.usage, one.inside);
        if (!field) return fmt::format("its report descriptor has no {}", one.name);
        if (field->report == 0) return "its reports have no numbers";
    }
    magnitude_ = *find_field(descriptor_, HidReportKind::Output, magnitude, set_constant_force);
    if (magnitude_.logical_min >= 0 || magnitude_.logical_max <= 0) {
        return "its force magnitude has no sign";
    }
    const HidField* const button = find_field(descriptor_, HidReportKind::Input, first_button);
    button_ = button ? std::optional(*button) : std::nullopt;
    find_axes();
    return "";
}

// Y has a motor where Set Effect can switch it on; that of a wheel is a pedal.
void ForceJoystickProtocol::find_axes() {
    axes_.push_back({*find_field(descriptor_, HidReportKind::Input, x_axis), 90, 0, 1});
    const HidField* const y = find_field(descriptor_, HidReportKind::Input, y_axis);
    const bool has_motor = find_field(descriptor_, HidReportKind::Output, y_axis, axes_enable);
    if (y && has_motor) axes_.push_back({*y, 0, 1, -1});
}

bool ForceJoystickProtocol::control(HidLine& line, HidUsage command) const {
    return Draft(descriptor_, HidReportKind::Output, command, 0).choose(command).send(line);
}

bool ForceJoystickProtocol::operate(HidLine& line, const Axis& axis, HidUsage operation) const {
    return Draft(descriptor_, HidReportKind::Output, block_index, effect_operation)
        .put(block_index, axis.block)
        .choose(operation)
        .put_most(loop_count)
        .send(line);
}

ForceJoystickProtocol::Loaded ForceJoystickProtocol::create(HidLine& line, Axis& axis) const {
    const bool is_sent = Draft(descriptor_, HidReportKind::Feature, constant_force, create_effect)
                             .choose(constant_force)
                             .send(line);
    return is_sent ? load(line, axis.block) : Loaded::No;
}

// A device that is not done yet says nothing of the three, and is asked again.
ForceJoystickProtocol::Loaded ForceJoystickProtocol::load(HidLine& line,
                                                          std::int64_t& block) const {
    constexpr int attempts = 60;
    constexpr auto kind = HidReportKind::Feature;
    const HidField& index = *find_field(descriptor_, kind, block_index, block_load);
    const HidField& status = *find_field(descriptor_, kind, load_success, block_load);
    std::vector<std::uint8_t> report(find_report(descriptor_, kind, index.report)->bytes());
    for (int i = 0; i < attempts; ++i) {
        const int size = line.read_feature(index.report, report);
        if (size < 0) return Loaded::No;
        const HidBytes answer =
            HidBytes(report).first(std::min(report.size(), static_cast<std::size_t>(size)));
        const std::optional<std::int64_t> said = read_field(answer, status);
        if (said == number_of(descriptor_, status, load_full)) return Loaded::Full;
        if (said != number_of(descriptor_, status, load_success)) continue;
        block = read_field(answer, index).value_or(0);
        return block > 0 ? Loaded::Yes : Loaded::No;
    }
    return Loaded::No;
}

bool ForceJoystickProtocol::start(HidLine& line, Axis& axis) const {
    Draft effect(descriptor_, HidReportKind::Output, block_index, set_effect);
    effect.put(block_index, axis.block).choose(constant_force).put(duration, for_ever);
    effect.put_most(gain);
    if (const HidField* const trigger = effect.find(trigger_button)) {
        effect.put(trigger, no_button(*trigger));
    }
    // A direction stands for all axes; without one, the axis stands for it.
    const HidField* const angle =
        find_field(descriptor_, HidReportKind::Output, first_ordinal, direction);
    if (angle && effect.find(direction_enable)) {
        effect.put(direction_enable, 1).put(angle, angle_of(*angle, axis.direction_deg));
    } else {
        effect.put(axis.index == 0 ? x_axis : y_axis, 1);
    }
    axis.magnitude = 0;
    axis.report = Draft(descriptor_, HidReportKind::Output, block_index, set_constant_force)
                      .put(block_index, axis.block)
                      .bytes();
    return effect.send(line) && line.write(axis.report) && operate(line, axis, op_start);
}

DeviceCheck ForceJoystickProtocol::start_all(HidLine& line) {
    constexpr std::string_view remedy =
        "close other programs that use its forces; unplug it and plug it in again";
    const bool is_on = control(line, device_reset) && control(line, stop_all_effects) &&
                       control(line, enable_actuators) &&
                       Draft(descriptor_, HidReportKind::Output, device_gain, device_gain_report)
                           .put_most(device_gain)
                           .send(line);
    const std::size_t wanted = axes_.size();
    Loaded loaded = is_on ? Loaded::Yes : Loaded::No;
    std::size_t playing = 0;
    while (loaded == Loaded::Yes && playing < wanted) {
        loaded = create(line, axes_[playing]);
        if (loaded == Loaded::Yes && !start(line, axes_[playing])) loaded = Loaded::No;
        if (loaded == Loaded::Yes) ++playing;
    }
    axes_.erase(axes_.begin() + static_cast<std::ptrdiff_t>(playing), axes_.end());
    if (loaded == Loaded::No) {
        return {"effects", CheckOutcome::Failed, "it does not accept a constant force",
                std::string(remedy)};
    }
    if (axes_.empty()) {
        return {"effects", CheckOutcome::Failed, "it has no memory for a constant force effect",
                std::string(remedy)};
    }
    return {"effects", CheckOutcome::Ok,
            fmt::format("{} of {} axes render a force; full scale {} is assumed to be {} N",
                        axes_.size(), wanted, magnitude_.logical_max, peak_newton),
            ""};
}

DeviceCheck ForceJoystickProtocol::begin(HidLine& line, const HidPlace& place) noexcept {
    wanted_newton_.setZero();
    const std::string lacking = use(read_report_descriptor(place.path));
    if (!lacking.empty()) {
        return {"descriptor", CheckOutcome::Failed, lacking, "plug it in again"};
    }
    DeviceCheck check = start_all(line);
    if (check.outcome == CheckOutcome::Failed) end(line);
    return check;
}

void ForceJoystickProtocol::end(HidLine& line) noexcept {
    for (const Axis& axis : axes_) {
        if (axis.block > 0) (void)operate(line, axis, op_stop);
    }
    (void)control(line, stop_all_effects);
    (void)control(line, disable_actuators);
}

bool ForceJoystickProtocol::decode(HidBytes report, HidInput& input) noexcept {
    if (report.empty()) return false;
    bool is_known = false;
    Vec3 place_m = input.place_m.value_or(Vec3::Zero());
    for (const Axis& axis : axes_) {
        const bool is_there = axis.place.report == report[0];
        const auto value = is_there ? read_field(report, axis.place) : std::nullopt;
        if (!value) continue;
        place_m(axis.index) = axis.sign * half_travel_m * deflection_of(axis.place, *value);
        is_known = true;
    }
    if (is_known) input.place_m = place_m;
    if (!button_ || button_->report != report[0]) return is_known;
    const auto pressed = read_field(report, *button_);
    if (pressed) input.buttons = *pressed != 0 ? 1 : 0;
    return is_known || pressed;
}

HidBytes ForceJoystickProtocol::encode(const HidOutput& output) noexcept {
    wanted_newton_ = output.is_lit ? output.newton : Vec3(Vec3::Zero());
    return encode_next();
}

HidBytes ForceJoystickProtocol::encode_next() noexcept {
    for (Axis& axis : axes_) {
        // What comes from the right pushes left, and what comes from ahead pushes back.
        const double share = std::clamp(-wanted_newton_(axis.index) / peak_newton, -1.0, 1.0);
        const std::int64_t wanted = steps_of(share, magnitude_);
        if (wanted == axis.magnitude) continue;
        axis.magnitude = wanted;
        write_field(axis.report, magnitude_, wanted);
        return axis.report;
    }
    return {};
}

void ForceJoystickProtocol::forget() noexcept {
    for (Axis& axis : axes_) axis.magnitude.reset();
}

OpenedDevice open_force_joystick(const DeviceRequest& /*request*/) {
    return open_hid(std::make_unique<ForceJoystickProtocol>());
}

}  // namespace palpa
