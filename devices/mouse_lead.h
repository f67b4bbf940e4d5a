// Leads the hand of an emulated device by mouse or keys: ways on the screen become targets of the
// handle. Used by the window, and by an emulated person who works a mouse.
#pragma once
#include "haptics/hand.h"
#include "math/vec.h"

namespace palpa {

class MouseLead {
public:
    MouseLead() = default;
    // `reach_m`: largest distance of the target from the handle, as far as the hand pulls.
    explicit MouseLead(double reach_m) noexcept : reach_m_(reach_m) {}

    // The handle and A_d at this moment.
    void see(const Vec3& handle_m, double displacement_gain) noexcept;

    // Moves the target so that the molecule would go this way (Å) if nothing held it. The target
    // stays within reach, so that coming back is felt at once.
    void pull(const Vec3& way_angstrom) noexcept;
    // Puts the target where the handle is: the hand pulls at nothing.
    void rest() noexcept { target_m_ = handle_m_; }
    // Takes hold of the molecule where the handle is; nothing if the hand holds it.
    void engage() noexcept;
    // Leaves the molecule where it is; the handle goes back to its middle.
    void clutch() noexcept;

    bool is_clutched() const noexcept { return is_clutched_; }
    const Vec3& target_m() const noexcept { return target_m_; }
    // How far the target is ahead of the handle, m; 0 under the clutch.
    Vec3 ahead_m() const noexcept;
    double displacement_gain() const noexcept { return displacement_gain_; }

private:
    double reach_m_ = 0;
    Vec3 target_m_ = Vec3::Zero(), handle_m_ = Vec3::Zero();
    double displacement_gain_ = 0;
    bool is_clutched_ = false;
};

}  // namespace palpa
