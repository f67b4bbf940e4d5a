#include "app/recovery.h"

#include "loading/load.h"
#include "platform/program.h"
#include "scene/read_scene.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

#ifndef _WIN32
TEST_CASE("what was not saved is offered once the program that kept it is gone",
          "[app][recovery]") {
    const test::TemporaryFolder folder;
    const char* const before = std::getenv("XDG_DATA_HOME");
    const std::string kept = before ? before : "";
    setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    const fs::path recovered = folder.path() / "palpa" / "recovered";
    {
        SceneDescription scene = read_scene(test::in_project("scenes/water"));
        scene.title = "changed";
        RecoveryFile file;
        file.save(load_world(scene), scene.view);
        REQUIRE(fs::exists(recovered));
        CHECK(list_recovered().empty());  // this process still runs

        // As if another one had left it: no process has the highest number.
        const fs::path own = recovered / fmt::format("water-{}.toml", own_process_number());
        fs::copy_file(own, recovered / "water-2147483646.toml");
        REQUIRE(list_recovered() == std::vector<fs::path>{recovered / "water-2147483646.toml"});
        CHECK(is_recovered(list_recovered().front()));
        const std::vector<std::string> settings{std::string(allow_outside)};
        const SceneDescription read = read_scene(list_recovered().front(), settings);
        CHECK(read.title == "changed");
        CHECK(read.molecules.size() == scene.molecules.size());
        // Of a running process that wrote nothing for minutes: the number is another one's now.
        fs::remove(recovered / "water-2147483646.toml");
        fs::last_write_time(own, fs::file_time_type::clock::now() - std::chrono::minutes(5));
        CHECK(list_recovered() == std::vector<fs::path>{own});
        file.forget();
    }
    // Of a program that ends as it should nothing stays.
    CHECK(fs::is_empty(recovered));
    before ? setenv("XDG_DATA_HOME", kept.c_str(), 1) : unsetenv("XDG_DATA_HOME");
}
#endif
