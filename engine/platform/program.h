// The running program, and other programs.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

// Path of the running program; empty if the system does not provide it.
std::filesystem::path find_program_file();

// The system's number of the running program, and whether one of that number runs.
std::uint64_t own_process_number() noexcept;
bool is_process_running(std::uint64_t number) noexcept;

// The result of another program.
struct ProgramEnd {
    int problem = 0;  // errno if it could not be started, else 0
    int status = 0;   // 0: it ended with exit code 0
};

// Runs a program and waits for its end. The first word is its file, or a name that is searched as
// in a shell. Its input is empty; its output goes to two new files.
ProgramEnd run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                       const std::filesystem::path& errors);

}  // namespace palpa
