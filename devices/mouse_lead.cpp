#include "devices/mouse_lead.h"

#include "core/units.h"

#include <utility>

namespace palpa {

void MouseLead::see(const Vec3& handle_m, double displacement_gain) noexcept {
    handle_m_ = handle_m;
    if (displacement_gain > 0) displacement_gain_ = displacement_gain;
}

void MouseLead::pull(const Vec3& way_angstrom) noexcept {
    target_m_ += units::metre_per_angstrom * displacement_gain_ * way_angstrom;
    target_m_ = handle_m_ + shortened(target_m_ - handle_m_, reach_m_);
}

void MouseLead::engage() noexcept {
    if (std::exchange(is_clutched_, false)) rest();
}

void MouseLead::clutch() noexcept {
    is_clutched_ = true;
    rest();
}

Vec3 MouseLead::ahead_m() const noexcept {
    return is_clutched_ ? Vec3(Vec3::Zero()) : Vec3(target_m_ - handle_m_);
}

}  // namespace palpa
