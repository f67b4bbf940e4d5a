#include "platform/file.h"

#include "tests/support/temporary_folder.h"

#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

using namespace palpa;

namespace fs = std::filesystem;

TEST_CASE("what a file holds is written and read byte for byte", "[platform][file]") {
    const test::TemporaryFolder folder;
    const fs::path path = folder.path() / "bytes";
    const std::string text("a\r\nb\0c\x1a\xff\n\n", 10);
    std::error_code error;
    {
        File file(path, FileUse::Create, error);
        REQUIRE_FALSE(error);
        file.write(text, error);
        CHECK_FALSE(error);
        file.close(error);
        CHECK_FALSE(error);
        CHECK_FALSE(file.is_open());
    }

    const File file(path, FileUse::Read, error);
    REQUIRE(file.is_open());
    CHECK(file.find_size(error) == text.size());
    std::array<char, 64> bytes{};
    const std::size_t got = file.read(bytes, error);
    CHECK(std::string(bytes.data(), got) == text);
    CHECK(file.read(bytes, error) == 0);
    CHECK_FALSE(error);
}

TEST_CASE("a file is made only where none is", "[platform][file]") {
    const test::TemporaryFolder folder;
    const fs::path path = folder.add_file("there", "old");
    std::error_code error;

    const File made(path, FileUse::Create, error);
    CHECK_FALSE(made.is_open());
    CHECK(error == std::errc::file_exists);
    const File missing(folder.path() / "missing", FileUse::Write, error);
    CHECK_FALSE(missing.is_open());
    CHECK(error == std::errc::no_such_file_or_directory);
    CHECK(fs::file_size(path) == 3);
}

TEST_CASE("a link that leads nowhere is there, and is not read", "[platform][file][links]") {
    const test::TemporaryFolder folder;
    const fs::path target = folder.add_file("target", "text"), link = folder.path() / "link",
                   lost = folder.path() / "lost";
    fs::create_symlink(target, link);
    fs::create_symlink(folder.path() / "nowhere", lost);
    std::error_code error;

    CHECK(File(link, FileUse::Read, error).is_open());
    CHECK_FALSE(File(link, FileUse::ReadHere, error).is_open());
    CHECK_FALSE(File(lost, FileUse::Create, error).is_open());
    CHECK(error == std::errc::file_exists);
    CHECK_FALSE(fs::exists(folder.path() / "nowhere"));
}

TEST_CASE("a locked folder is taken until its owner goes, and can be used", "[platform][file]") {
    const test::TemporaryFolder folder;
    {
        const LockedFolder first(folder.path());
        CHECK_FALSE(first.is_taken());
        CHECK(LockedFolder(folder.path()).is_taken());
        CHECK(fs::exists(folder.add_file("inside", "text")));
        CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
        CHECK(fs::remove(folder.path() / "inside"));
    }
    CHECK_FALSE(LockedFolder(folder.path()).is_taken());
}

TEST_CASE("who may write is known before", "[platform][file]") {
    const test::TemporaryFolder folder;
    const fs::path path = folder.add_file("there", "");

    CHECK(may_read_and_write(path));
    CHECK(may_write(folder.path()));
    CHECK_FALSE(may_read_and_write(folder.path() / "missing"));
    CHECK_FALSE(may_write(folder.path() / "missing"));
}

TEST_CASE("each temporary folder is a new one", "[platform][file]") {
    std::error_code error;
    const fs::path a = make_temporary_folder(error), b = make_temporary_folder(error);

    REQUIRE_FALSE(error);
    CHECK(a != b);
    CHECK(fs::is_empty(a));
    CHECK((fs::remove(a) && fs::remove(b)));
}

TEST_CASE("a path may have any letters, and is UTF-8 in a string", "[platform]") {
    const std::string name = "Gr\u00f6\u00dfe \u20ac \u6c34 \U0001f9ec.txt";
    const test::TemporaryFolder folder;
    const fs::path path = folder.path() / name;
    CHECK(path.filename().string() == name);
    CHECK(path.filename() == fs::path(u8"Gr\u00f6\u00dfe \u20ac \u6c34 \U0001f9ec.txt"));
    std::error_code error;
    {
        File file(path, FileUse::Create, error);
        REQUIRE_FALSE(error);
        file.write("text", error);
    }
    const fs::directory_iterator listed(folder.path());
    REQUIRE(listed != fs::directory_iterator());
    CHECK(listed->path() == path);
    CHECK(std::ifstream(path).good());
}
