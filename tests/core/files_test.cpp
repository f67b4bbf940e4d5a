#include "core/files.h"

#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace palpa;
using Catch::StartsWith;
using test::load_error_of;

namespace fs = std::filesystem;

namespace {

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a file is read byte for byte", "[core][files]") {
    const test::TemporaryFolder folder;
    const std::string text("a\r\nb\0c\xff\n\n", 9);

    CHECK(read_text_file(folder.add_file("bytes", text)) == text);
    CHECK(read_text_file(folder.add_file("empty", "")).empty());
}

TEST_CASE("a file that cannot be read is named with the reason", "[core][files]") {
    const test::TemporaryFolder folder;
    const std::string missing = (folder.path() / "missing.toml").string();

    CHECK(load_error_of([&] { read_text_file(missing); }) == missing + ": no such file");
    CHECK_THAT(load_error_of([&] { read_text_file(folder.path()); }),
               StartsWith(folder.path().string() + ": is a folder"));
}

TEST_CASE("a file that is too large is refused at once", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path sparse = folder.add_file("sparse", "");
    fs::resize_file(sparse, std::uintmax_t{40} << 30);
    CHECK(load_error_of([&] { read_text_file(sparse); }) ==
          sparse.string() + ": is 40.0 GiB large; expected at most 1.0 GiB");
}

TEST_CASE("what is there is replaced only where that is said", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path path = folder.add_file("a", "old");

    CHECK(load_error_of([&] { write_text_file(path, "new"); }) ==
          path.string() + ": already exists; expected another name, or --overwrite");
    CHECK(load_error_of([&] {
              write_text_files(std::vector<TextFile>{{folder.path() / "b", "1"}, {path, "2"}});
          }) == path.string() + ": already exists; expected another name, or --overwrite");
    CHECK(read_text_file(path) == "old");
    CHECK(files_in(folder.path()) == 1);

    write_text_file(path, "new", Existing::Replace);
    CHECK(read_text_file(path) == "new");
}

TEST_CASE("before long work it is known whether its output can be written", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path ours = folder.add_file("ours", "# mark\n"),
                   other = folder.add_file("other", "mine"), fresh = folder.path() / "fresh";

    CHECK(check_output(fresh, "# mark", false) == Existing::Refuse);
    CHECK(check_output(fresh, "# mark", true) == Existing::Refuse);
    CHECK(check_output(ours, "# mark", true) == Existing::Replace);
    CHECK_THROWS_AS(check_output(ours, "# mark", false), LoadError);
    CHECK_THROWS_AS(check_output(other, "# mark", true), LoadError);
    CHECK_THROWS_AS(check_output(folder.path(), "# mark", true), LoadError);
    CHECK_THROWS_AS(check_output(folder.path() / "no" / "x", "# mark", true), LoadError);
    CHECK(files_in(folder.path()) == 2);
}

TEST_CASE("a folder is listed in the order of names", "[core][files]") {
    const test::TemporaryFolder folder;
    for (const char* const name : {"b", "c", "a"}) folder.add_file(name, "");
    const fs::path inner = folder.path() / "aa";
    fs::create_directory(inner);

    CHECK(list_folder(folder.path()) ==
          std::vector{folder.path() / "a", inner, folder.path() / "b", folder.path() / "c"});
    CHECK(list_folder(folder.path(), 2).size() == 2);
    CHECK(list_folder(inner).empty());
    CHECK(list_folder(folder.path() / "absent").empty());
    CHECK(list_folder(folder.path() / "a").empty());
}

TEST_CASE("a folder is locked for one at a time", "[core][files]") {
    const test::TemporaryFolder folder;
    {
        const FolderLock first(folder.path());
        CHECK_THAT(load_error_of([&] { const FolderLock second(folder.path()); }),
                   Catch::Contains("another run is writing"));
    }
    CHECK_NOTHROW(FolderLock(folder.path()));
}

TEST_CASE("writing makes a file, then replaces it, and leaves nothing else", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path path = folder.path() / "out.csv";
    const std::string longer(100'000, 'x');
    const std::string shorter("b\r\n\0", 4);

    for (const std::string& text : {longer, shorter}) {
        write_text_file(path, text, Existing::Replace);
        std::ifstream file(path, std::ios::binary);
        CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == text);
    }

    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a failed write says why, harms nothing and leaves nothing behind", "[core][files]") {
    const test::TemporaryFolder folder;

    SECTION("into a folder that is not there") {
        const std::string path = (folder.path() / "missing" / "out.csv").string();
        CHECK_THAT(load_error_of([&] { write_text_file(path, "text"); }),
                   StartsWith(path + ": cannot be written: "));
        CHECK(files_in(folder.path()) == 0);
    }
    SECTION("onto a folder") {
        const fs::path path = folder.path() / "taken";
        fs::create_directory(path);
        folder.add_file("taken/inside", "kept");
        CHECK_THAT(load_error_of([&] { write_text_file(path, "text", Existing::Replace); }),
                   StartsWith(path.string() + ": cannot be written: "));
        CHECK(read_text_file(path / "inside") == "kept");
        CHECK(files_in(folder.path()) == 1);
    }
}

TEST_CASE("several files are all written, or none of them", "[core][files]") {
    const test::TemporaryFolder folder;
    const fs::path first = folder.add_file("first", "old"), second = folder.path() / "second";
    const TextFile one{first, "1", Existing::Replace};

    SECTION("all") {
        write_text_files(std::vector<TextFile>{one, {second, "2"}});
        CHECK(read_text_file(first) == "1");
        CHECK(read_text_file(second) == "2");
        CHECK(files_in(folder.path()) == 2);
    }
    SECTION("none, as the last one's folder is not there") {
        const fs::path missing = folder.path() / "missing" / "third";
        CHECK_THAT(load_error_of([&] {
                       write_text_files(std::vector<TextFile>{one, {second, "2"}, {missing, "3"}});
                   }),
                   StartsWith(missing.string() + ": cannot be written: "));
        CHECK(read_text_file(first) == "old");
        CHECK(files_in(folder.path()) == 1);
    }
    SECTION("none, as the last one is a folder") {
        fs::create_directory(second);
        CHECK_THAT(
            load_error_of([&] { write_text_files(std::vector<TextFile>{one, {second, "2"}}); }),
            StartsWith(second.string() + ": is a folder"));
        CHECK(read_text_file(first) == "old");
        CHECK(files_in(folder.path()) == 2);
    }
}
