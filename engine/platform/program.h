// The running program, and others.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

// The file of the running program; empty where the system does not say.
std::filesystem::path find_program_file();

// The system's number of the running program, and whether one of that number runs.
std::uint64_t own_process_number() noexcept;
bool is_process_running(std::uint64_t number) noexcept;

// What became of another program.
struct ProgramEnd {
    int problem = 0;  // errno where it could not be started
    int status = 0;   // 0: it ended with exit code 0
};

// Waits for its end. The first word is its file, or its name as a shell finds it. It reads nothing;
// what it writes comes into two new files.
ProgramEnd run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                       const std::filesystem::path& errors);

}  // namespace palpa
