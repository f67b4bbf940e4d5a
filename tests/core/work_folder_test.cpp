#include "core/work_folder.h"

#include <sys/wait.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpa;

namespace {

// The signal that ends a copy of this program in which `body` runs, 0 if it ends by itself, and
// what it writes.
template <typename Body>
int signal_that_ends(const Body& body, std::string& written) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        (void)std::signal(SIGINT, SIG_DFL);
        body([&](const std::string& text) { return write(ends[1], text.data(), text.size()); });
        _exit(0);
    }
    close(ends[1]);
    char letters[4096];
    for (ssize_t got = 0; (got = read(ends[0], letters, sizeof letters)) > 0;) {
        written.append(letters, static_cast<std::size_t>(got));
    }
    close(ends[0]);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

TEST_CASE("a work folder goes with its owner, and all in it", "[tools][work_folder]") {
    std::filesystem::path path;
    {
        const WorkFolder folder, other;
        path = folder.path();
        CHECK(std::filesystem::is_directory(path));
        CHECK(other.path() != path);
        std::filesystem::create_directory(path / "inner");
        std::ofstream(path / "inner" / "file") << "text";
    }
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("an interrupt ends the program once all work folders are removed",
          "[tools][work_folder]") {
    const bool comes_between = GENERATE(false, true);
    std::string written;
    const int number = signal_that_ends(
        [&](const auto& tell) {
            {
                const WorkFolder outer;
                (void)tell(outer.path().string() + "\n");
                if (comes_between) (void)std::raise(SIGINT);
                const WorkFolder inner;
                (void)tell(inner.path().string() + "\n");
                if (!comes_between) (void)std::raise(SIGINT);
            }
            (void)tell("still there");
        },
        written);

    CHECK(number == SIGINT);
    const std::size_t end = written.find('\n');
    REQUIRE(written.size() > end + 1);
    CHECK(written.back() == '\n');
    CHECK_FALSE(std::filesystem::exists(written.substr(0, end)));
    CHECK_FALSE(std::filesystem::exists(written.substr(end + 1, written.size() - end - 2)));
}
