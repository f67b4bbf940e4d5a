// Origins of the atoms of a molecule: files, a residue of the force field, another molecule.
#pragma once
#include "charmm/force_field.h"
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "simulation/components.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace palpa {

// Files by path; several molecules may share one.
struct SourceFiles {
    std::map<std::filesystem::path, std::shared_ptr<const Structure>> structures;
    std::map<std::filesystem::path, std::shared_ptr<const Connectivity>> connectivities;
};

// The source of a molecule of a scene. An empty path: no topology. Throws LoadError as the readers
// do, and for alternate locations.
Source find_source(const std::filesystem::path& structure, const std::filesystem::path& topology,
                   const std::string& segment, SourceFiles& files);

// The same for a molecule of a remote engine, whose structure may be a PSF file: all atoms are at
// the origin then.
Source find_engine_source(const std::filesystem::path& structure,
                          const std::filesystem::path& topology, const std::string& segment,
                          SourceFiles& files);

// The following functions make a segment `name` that contains this molecule alone.

// One segment of the files; an empty name: the only one. Throws LoadError as find_source does, and,
// listing the segments of the file, if it has no such segment.
Source read_segment(const std::filesystem::path& structure, const std::filesystem::path& topology,
                    const std::string& segment, const std::string& name);

// Builds a residue from bond lengths, angles and the residue's internal coordinates, with the first
// atom at the origin. Throws LoadError that names what the force field lacks.
Source build_residue(const ForceField& force_field, const std::string& residue,
                     const std::string& name);

// A copy of a molecule at its present position.
Source copy_source(const World& world, Entity molecule, const std::string& name);

}  // namespace palpa
