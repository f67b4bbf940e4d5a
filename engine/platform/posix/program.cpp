#include "platform/program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <system_error>

#ifdef __APPLE__
#include <mach-o/dyld.h>
#include <cstdint>

extern char** environ;  // in none of its headers
#endif

namespace palpa {

std::filesystem::path find_program_file() {
    std::error_code error;
#ifdef __APPLE__
    char file[4096];
    std::uint32_t size = sizeof file;
    if (_NSGetExecutablePath(file, &size) != 0) return {};
    return std::filesystem::canonical(file, error);
#else
    return std::filesystem::read_symlink("/proc/self/exe", error);
#endif
}

std::uint64_t own_process_number() noexcept { return static_cast<std::uint64_t>(getpid()); }

bool is_process_running(std::uint64_t number) noexcept {
    return kill(static_cast<pid_t>(number), 0) == 0 || errno == EPERM;
}

ProgramEnd run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                       const std::filesystem::path& errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int write_new = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), write_new, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), write_new, 0600);
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    ProgramEnd end;
    end.problem = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (end.problem != 0) return end;
    while (waitpid(child, &end.status, 0) < 0 && errno == EINTR) continue;
    return end;
}

}  // namespace palpa
