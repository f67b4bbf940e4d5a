#include "simulation/coupling.h"

#include "core/load_error.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/systems/publish_contact.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

ForceLaw guarded_force_law(const CouplingDescription& c,
                           const PrintedForceLaw::Parameters& parameters) {
    if (const auto range = c.feel_pN) {
        const auto [weakest_pN, strongest_pN] = *range;
        return PerceptualForceLaw::for_range(weakest_pN * 1e-12, strongest_pN * 1e-12);
    }
    switch (c.force_law) {
        case ForceLawChoice::Printed:
            break;
        case ForceLawChoice::Calibrated:
            if (const auto law = PrintedForceLaw::find_calibrated(parameters)) return *law;
            break;  // no such law (can_build_laws)
        case ForceLawChoice::Constant:
            return ConstantForceLaw{c.A_f};
        case ForceLawChoice::Perceptual:
            return PerceptualForceLaw({.F_lo = c.F_lo_pN * 1e-12, .F_hi = c.F_hi_nN * 1e-9});
    }
    return PrintedForceLaw(parameters);
}

DisplacementLaw guarded_displacement_law(const CouplingDescription& c,
                                         const PrintedDisplacementLaw::Parameters& parameters) {
    switch (c.displacement_law) {
        case DisplacementLawChoice::Repaired:
            break;
        case DisplacementLawChoice::Printed:
            return PrintedDisplacementLaw(parameters);
        case DisplacementLawChoice::Constant:
            return ConstantDisplacementLaw{c.A_d};
    }
    return RepairedDisplacementLaw({.printed = parameters});
}

PrintedForceLaw::Parameters force_parameters(const CouplingDescription& c) {
    return {.F_h1 = c.F_h1_N,
            .F_h2 = c.F_h2_N,
            .F_0 = c.F_0_nN * 1e-9,
            .A_fmin = c.A_f_min,
            .A_fmax = c.A_f_max};
}

}  // namespace

bool can_build_laws(const CouplingDescription& c) {
    return c.mode != CouplingMode::Guarded || c.feel_pN.has_value() ||
           c.force_law != ForceLawChoice::Calibrated ||
           PrintedForceLaw::find_calibrated(force_parameters(c)).has_value();
}

CouplingLaws build_coupling_laws(const CouplingDescription& c) {
    const PrintedForceLaw printed_force(force_parameters(c));
    const PrintedDisplacementLaw::Parameters displacement{.gamma = c.gamma_per_N,
                                                          .F_off = c.F_off_pN * 1e-12,
                                                          .A_dmin = c.A_d_min,
                                                          .A_dmax = c.A_d_max};
    const PrintedDisplacementLaw printed_displacement(displacement);
    const ConstantForceLaw constant_force{c.A_f};
    const ConstantDisplacementLaw constant_displacement{c.A_d};
    switch (c.mode) {
        case CouplingMode::VariableForceVariableDisplacement:
            return {printed_force, printed_displacement};
        case CouplingMode::VariableForceConstantDisplacement:
            return {printed_force, constant_displacement};
        case CouplingMode::ConstantForceVariableDisplacement:
            return {constant_force, printed_displacement};
        case CouplingMode::ConstantForceConstantDisplacement:
            return {constant_force, constant_displacement};
        case CouplingMode::NoForce:
            break;
        case CouplingMode::Guarded:
            return {guarded_force_law(c, force_parameters(c)),
                    guarded_displacement_law(c, displacement)};
    }
    return {ConstantForceLaw{0}, constant_displacement};
}

Coupling build_coupling(const CouplingDescription& coupling, bool is_own) {
    return {build_coupling_laws(coupling), coupling.mode == CouplingMode::Guarded,
            static_cast<std::size_t>(coupling.pairs_per_tick), coupling, is_own};
}

namespace {

void renew_contacts(World& world) {
    if (const auto within_pN = find_tolerance(world)) set_tolerance(world, *within_pN);
    for (const Entity hand : find_hands(world)) renew_contact(world, hand);
}

}  // namespace

void set_couplings(const SceneDescription& scene, World& world) {
    std::size_t slot = 0;
    for (const Entity hand : find_hands(world)) {
        const bool is_own = scene.hands.at(slot).coupling.has_value();
        world.set(hand, build_coupling(coupling_of(scene, slot++), is_own));
    }
    renew_contacts(world);
}

void change_coupling(const std::vector<std::string>& settings, Entity hand, World& world) {
    const Coupling& before = coupling_of(world, hand);
    const CouplingDescription changed = with_settings(before.description, settings);
    if (!can_build_laws(changed)) throw LoadError({}, why_no_laws);
    const bool is_own = before.is_own;
    for (const Entity other : find_hands(world)) {
        if (other == hand || !(is_own || coupling_of(world, other).is_own))
            world.set(other, build_coupling(changed, is_own));
    }
    renew_contacts(world);
}

void keep_couplings(const World& world, SceneDescription& scene) {
    std::size_t slot = 0;
    for (const Entity hand : find_hands(world)) {
        const Coupling& coupling = coupling_of(world, hand);
        std::optional<CouplingDescription>& own = scene.hands.at(slot++).coupling;
        (coupling.is_own ? own.emplace() : scene.coupling) = coupling.description;
    }
}

std::optional<double> find_tolerance(const World& world) {
    std::optional<double> smallest;
    world.each<Coupling>([&](Entity, const Coupling& coupling) {
        const std::optional<double>& within_pN = coupling.description.feel_within_pN;
        if (within_pN && !(smallest && *smallest <= *within_pN)) smallest = within_pN;
    });
    return smallest;
}

}  // namespace palpa
