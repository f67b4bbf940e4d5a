// Makes a scene from a structure file in the window: prepares it, asks if something is missing, and
// shows the report.
#pragma once
#include "app/window_shell.h"

#include <filesystem>
#include <optional>
#include <span>

namespace palpa {

// `files`: a structure, and optionally parameters of its ligands (.str, .rtf, .prm) or their bonds
// (.sdf, .mol, .mol2). Writes the results to a new folder in `folder`, named after the structure.
// Returns the scene's file; empty if the person cancelled, or no scene can be made, which the
// report states. Throws LoadError for errors in files.
std::optional<std::filesystem::path> open_structure(WindowShell& shell,
                                                    std::span<const std::filesystem::path> files,
                                                    const std::filesystem::path& folder);

}  // namespace palpa
