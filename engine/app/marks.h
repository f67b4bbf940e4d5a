// Marks of the picture that a person turns on: measures by clicks, contacts, forces of residues,
// the start, the path, shadows.
#pragma once
#include "ecs/world.h"

#include <cstdint>
#include <vector>

namespace palpa {

// Atoms that are clicked on for a measure: two for a distance, a third for an angle, a fourth for a
// dihedral.
struct Measuring {
    bool is_on = false;
    std::vector<std::uint32_t> atoms{};
};

// Begins a measure, or ends it; what was measured stays in the picture.
void measure_or_end(World& app);
bool measures(const World& app);
// Takes a clicked atom for the measure that is under way.
void measure_atom(World& app, std::uint32_t atom);
// Removes all measures of the picture.
void remove_measures(World& app);
bool has_measures(const World& app);

// Switches of the picture.
void toggle_contacts(World& app);
void toggle_forces_by_residue(World& app);
void toggle_ghost(World& app);
void toggle_trail(World& app);
void toggle_shadows(World& app);
bool shows_contacts(const World& app);
bool shows_forces_by_residue(const World& app);
bool shows_ghost(const World& app);
bool shows_trail(const World& app);
bool shows_shadows(const World& app);

}  // namespace palpa
