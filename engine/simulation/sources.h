// Where the atoms of a molecule are from: files, a residue of the force field, another molecule.
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

// Files by path: several molecules may be of one.
struct SourceFiles {
    std::map<std::filesystem::path, std::shared_ptr<const Structure>> structures;
    std::map<std::filesystem::path, std::shared_ptr<const Connectivity>> connectivities;
};

// What a molecule of a scene names. No topology: an empty path. Throws LoadError as the readers do,
// and where a structure has alternate locations.
Source find_source(const std::filesystem::path& structure, const std::filesystem::path& topology,
                   const std::string& segment, SourceFiles& files);

// The same of a remote engine's molecule, whose structure may be a PSF file: then all is at the
// origin.
Source find_engine_source(const std::filesystem::path& structure,
                          const std::filesystem::path& topology, const std::string& segment,
                          SourceFiles& files);

// By its name.
bool is_psf(const std::filesystem::path& path);

// The rest make a segment `name` that holds this molecule alone.

// One of the segments that the files have; no segment: the only one. Throws LoadError as
// find_source does, and, with the segments that are there, where it is not one of them.
Source read_segment(const std::filesystem::path& structure, const std::filesystem::path& topology,
                    const std::string& segment, const std::string& name);

// Built from lengths, angles and the residue's table, the first atom at the origin. Throws
// LoadError that names what the force field lacks.
Source build_residue(const ForceField& force_field, const std::string& residue,
                     const std::string& name);

// As the molecule stands now.
Source copy_source(const World& world, Entity molecule, const std::string& name);

}  // namespace palpa
