// Makes a scene from a structure file in the window: prepares it, asks if something is missing, and
// shows the report.
#pragma once
#include "app/window_shell.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Groups the files of one scene each: structures apart, a topology with the structure of its name,
// parameters with every structure, any other file alone. One group of all where there is one
// structure at most.
std::vector<std::vector<std::filesystem::path>> split_structures(
    std::span<const std::filesystem::path> files);

// `files`: a structure, and parameters of its ligands (.str, .rtf, .prm) or their bonds (.sdf,
// .mol, .mol2), or its topology (.psf), which is then taken as it is; of a topology alone the
// coordinates are the file beside it. The results go to a new folder below `folder`, named after
// the structure. Returns the scene's file; nothing where the person cancelled, or no scene can be
// made of it, which they have read; `said` stands above the report. Throws LoadError with what is
// wrong with a file.
std::optional<std::filesystem::path> open_structure(WindowShell& shell,
                                                    std::span<const std::filesystem::path> files,
                                                    const std::filesystem::path& folder,
                                                    const std::string& said = {});

struct PreparedEach {
    std::string said;     // names what was made; empty: nothing was
    std::string problem;  // of the first structure that was not prepared
};

// Makes a scene of each group, one after the other, and takes into the hand what Palpa chooses.
PreparedEach prepare_each(WindowShell& shell,
                          std::span<const std::vector<std::filesystem::path>> groups,
                          const std::filesystem::path& folder);

}  // namespace palpa
