// Pipes, links and devices among files: what Windows has no names in folders for.
#include "core/files.h"

#include "core/load_error.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <string>

using namespace palpa;
using test::load_error_of;

namespace fs = std::filesystem;

TEST_CASE("what is no regular file is refused at once", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const fs::path& path : {pipe, fs::path("/dev/zero")}) {
        CHECK(load_error_of([&] { read_text_file(path); }) ==
              path.string() + ": is not a regular file; expected one");
    }
}

TEST_CASE("a link is replaced and not written through", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path target = folder.add_file("target", "old"), link = folder.path() / "link";
    fs::create_symlink(target, link);

    CHECK_THROWS_AS(write_text_file(link, "new"), LoadError);
    CHECK_THROWS_AS(NewFile(link), LoadError);
    CHECK_THROWS_AS(check_output(link, "old", true), LoadError);
    CHECK_FALSE(has_mark(link, "old"));
    CHECK(fs::is_symlink(link));

    write_text_file(link, "new", Existing::Replace);
    CHECK_FALSE(fs::is_symlink(link));
    CHECK(read_text_file(target) == "old");
}

TEST_CASE("a device is written into, and stays a device", "[core][files]") {
    CHECK(check_output("/dev/null", "# mark", false) == Existing::Replace);
    write_text_file("/dev/null", "text");
    CHECK(fs::is_character_file("/dev/null"));
    CHECK_THROWS_AS(write_text_file("/dev/full", "text"), LoadError);
    CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a pipe is written into, also among several files and piece by piece", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe", file = folder.path() / "file";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const int end = open(pipe.c_str(), O_RDWR | O_NONBLOCK);  // so that nobody waits for the other
    REQUIRE(end >= 0);
    const auto arrived = [&] {
        std::array<char, 100> bytes{};
        const ssize_t count = read(end, bytes.data(), bytes.size());
        return count < 0 ? std::string()
                         : std::string(bytes.data(), static_cast<std::size_t>(count));
    };

    write_text_files(std::array{TextFile{pipe, "first"}, TextFile{file, "second"}});
    CHECK(arrived() == "first");
    CHECK(read_text_file(file) == "second");
    // Where the files are refused nothing goes into the pipe either.
    CHECK_THROWS_AS(write_text_files(std::array{TextFile{pipe, "third"}, TextFile{file, "third"}}),
                    LoadError);
    CHECK(arrived().empty());
    NewFile(pipe).write("fourth");
    CHECK(arrived() == "fourth");
    CHECK(fs::is_fifo(pipe));
    CHECK(close(end) == 0);
}
