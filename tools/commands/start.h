// palpa without a command: the window's start screen, or a list of the scenes; and palpa FILE.
#pragma once
#include <string>
#include <vector>

namespace palpa {

// Without a display it prints the scenes that come with Palpa and how to open one. Returns the exit
// code.
int start_command();

// Whether this argument in a command's place names a file that could be opened, by its ending, or a
// PDB entry by its code or a link.
bool is_file_to_open(const std::string& argument);

// A scene, or a structure and parameters of its ligands, in a window. Returns the exit code. Throws
// LoadError where there is no display, or a file cannot be read.
int open_command(const std::vector<std::string>& files);

}  // namespace palpa
