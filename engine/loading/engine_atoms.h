// Reads the atoms of a scene that a remote engine moves ([engine]), and finds which of the engine's
// atoms they are.
#pragma once
#include "molecule/atoms.h"
#include "scene/description.h"
#include "simulation/components.h"
#include "simulation/remote_engine.h"

namespace palpa {

// Adds the atoms of a molecule of the scene with names, masses, charges and bonds, without
// parameters. Without a topology, masses are those of the elements and bonds follow from distances.
// If the structure is a PSF file, all atoms are at the origin. Throws LoadError as the readers do.
AtomRange add_engine_atoms(const Source& source, AtomTable& table);

// The mapping according to `engine.atoms`. Throws LoadError for atoms of the scene that are
// missing, occur twice or have another mass, and for an index file that names other atoms than the
// scene has.
EngineAtoms find_engine_atoms(const SceneDescription& scene, const AtomTable& table);

// True if the positions come from the engine alone, because a molecule's structure is a PSF file;
// until the first frame they are at the origin.
bool lacks_coordinates(const SceneDescription& scene);

}  // namespace palpa
