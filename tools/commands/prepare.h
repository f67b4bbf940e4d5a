// palpa prepare: from a downloaded structure to a system that can be felt.
#pragma once
#include "prepare/settings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct PrepareOptions {
    std::filesystem::path structure;                        // or the code of a PDB entry
    bool again = false;                                     // downloads the entry again
    std::filesystem::path topology;                         // empty: one is built
    std::vector<std::filesystem::path> toppar, parameters;  // beside the built-in force field
    bool only_toppar = false;                               // or in place of it
    std::filesystem::path folder;
    PrepareSettings settings;
    // As written: "CSO=CYS", "A:25=ASPP", "A:53=B", "A=NTER", "A:3-A:40".
    std::vector<std::string> as, protonation, alternates, first, last, disulphides;
    std::vector<std::string> structural_waters, flips;  // "A:301"
    std::string solvent = "auto";                       // or a name of solvent_names
    std::string grab;  // for the hand of scene.toml, see prepare/hand_choice.h
    bool makes_scene = true;
    std::string title;               // what the files say of themselves; a line of our own if empty
    std::string x_along, y_towards;  // "3TL", "A:25-A:50"
    bool overwrites = false;
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int prepare_command(const PrepareOptions& options);

}  // namespace palpa
