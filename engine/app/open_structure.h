// A structure file becomes a scene, in the window: prepared beside it, with questions where
// something is missing, and the report of what was decided.
#pragma once
#include "app/window_shell.h"

#include <filesystem>
#include <optional>
#include <span>

namespace palpa {

// `files`: a structure, and parameters of its ligands (.str, .rtf, .prm) or their bonds (.sdf,
// .mol, .mol2), or its topology (.psf), which is then taken as it is; of a topology alone the
// coordinates are the file beside it. The results go to a new folder below `folder`, named after
// the structure. Returns the scene's file; nothing where the person cancelled, or no scene can be
// made of it, which they have read. Throws LoadError with what is wrong with a file.
std::optional<std::filesystem::path> open_structure(WindowShell& shell,
                                                    std::span<const std::filesystem::path> files,
                                                    const std::filesystem::path& folder);

}  // namespace palpa
