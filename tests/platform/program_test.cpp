#include "platform/program.h"

#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace palpa;

namespace {

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("this program knows its file", "[platform][program]") {
    CHECK(find_program_file().stem() == "platform_tests");
    CHECK(std::filesystem::is_regular_file(find_program_file()));
}

// This program again, whose XML begins with the name that it was given.
TEST_CASE("another program gets its words as they are, and what it writes comes back",
          "[platform][program]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "out", errors = folder.path() / "errors";
    const auto [word, as_xml] = GENERATE(table<std::string, std::string>({
        {"two words", "two words"},
        {R"(a "quoted" word)", "a &quot;quoted&quot; word"},
        {R"(\back\\slash\)", R"(\back\\slash\)"},
        {R"(both\"\\")", R"(both\&quot;\\&quot;)"},
        {"%PATH% $HOME *", "%PATH% $HOME *"},
    }));

    const ProgramEnd end = run_program(
        {find_program_file().string(), "-r", "xml", "--name", word, "no such test"}, out, errors);

    CHECK(end.problem == 0);
    CHECK_THAT(content_of(out), Catch::Contains("<Catch name=\"" + as_xml + "\""));
}

TEST_CASE("how another program ends is known", "[platform][program]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "out", errors = folder.path() / "errors";
    const std::string self = find_program_file().string();

    const ProgramEnd good = run_program({self, "--list-reporters"}, out, errors);
    CHECK(good.problem == 0);
    CHECK(content_of(out).find("junit") != std::string::npos);
    const ProgramEnd bad = run_program({self, "--no-such-option"}, out, errors);
    CHECK(bad.problem == 0);
    CHECK(bad.status != 0);
    CHECK_FALSE(content_of(errors).empty());
    CHECK(run_program({"no-such-program-anywhere"}, out, errors).problem == ENOENT);
}
