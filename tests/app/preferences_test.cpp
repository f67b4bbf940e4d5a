#include "app/preferences.h"

#include "core/files.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;

TEST_CASE("preferences read as they were written", "[tools][preferences]") {
    const Preferences odd{.device = "a \"b\"\n",
                          .sound = GENERATE(true, false),
                          .recent = {"/a 'b'", "c"},
                          .folder = "/home/me",
                          .lessons_done = {"water", "/home/me/lesson.toml"},
                          .hand_explained = true,
                          .window_size = std::array{1280, 800},
                          .dark_theme = true,
                          .panels = {"left 240", "plots open"},
                          .language = "de",
                          .download_from = "https://example.org/",
                          .download_stall_seconds = 2.5};

    CHECK(parse_preferences("device = \"omni\"", "p.toml") == Preferences{.device = "omni"});
    CHECK(parse_preferences("sound = true", "p.toml") == Preferences{.sound = true});
    CHECK(parse_preferences(format_preferences(odd), "p.toml") == odd);
    CHECK(parse_preferences(format_preferences({}), "p.toml") == Preferences{});
    // A version before had one scene.
    CHECK(parse_preferences("scene = \"/a/b.toml\"", "p.toml").recent ==
          std::vector<std::string>{"/a/b.toml"});
}

TEST_CASE("preferences that are wrong say where", "[tools][preferences]") {
    const auto told = [](const char* text) {
        return test::load_error_of([&] { (void)parse_preferences(text, "p.toml"); });
    };
    CHECK_THAT(told("device = omni"), Contains("p.toml:1:10"));
    CHECK_THAT(told("\ndevice = 3"), Contains("p.toml:2:10: device is not text"));
    CHECK_THAT(told("sound = 1"), Contains("p.toml:1:9: sound is not true or false"));
    CHECK_THAT(told("scene = true"), Contains("p.toml:1:9: scene is not text"));
    CHECK_THAT(told("text_scale = \"2\""), Contains("text_scale is not a number from 0.5 to 4"));
    CHECK_THAT(told("text_scale = 4.1"), Contains("p.toml:1:14: text_scale is not a number"));
    CHECK_THAT(told("text_scale = 0.4"), Contains("text_scale is not a number from 0.5 to 4"));
    CHECK_THAT(told("language = 1"), Contains("p.toml:1:12: language is not text"));
    CHECK_THAT(told("window_size = [1280]"), Contains("window_size is not two whole numbers"));
    CHECK_THAT(told("window_size = [100, 800]"), Contains("p.toml:1:15: window_size is not"));
    CHECK_THAT(told("panels = [1]"), Contains("panels is not a list of texts"));
    CHECK_THAT(told("lessons_done = true"), Contains("lessons_done is not a list of texts"));
    CHECK_THAT(told("download_from = 1"), Contains("p.toml:1:17: download_from is not text"));
    CHECK_THAT(told("download_stall_seconds = 0"), Contains("is not a number from 1 to 3600"));
    CHECK_THAT(told("dark_theme = 1"), Contains("dark_theme is not true or false"));
    CHECK_THAT(told("devise = \"omni\""),
               Contains("p.toml:1:10: unknown key 'devise'") &&
                   Contains("device, sound, scene, recent, hand_explained, text_scale, language, "
                            "window_size, dark_theme, folder, lessons_done, panels, download_from, "
                            "download_stall_seconds") &&
                   Contains("did you mean 'device'"));
}

TEST_CASE("a scene that is opened again stands first and once, and only eight are kept",
          "[tools][preferences]") {
    CHECK(add_recent({"a", "b"}, "b") == std::vector<std::string>{"b", "a"});
    std::vector<std::string> recent;
    for (const char name : std::string("abcdefghij")) recent = add_recent(recent, {name});
    REQUIRE(recent.size() == most_recent);
    CHECK(recent.front() == "j");
    CHECK(recent.back() == "c");
}

TEST_CASE("a choice is kept, in a folder that was not there", "[tools][preferences]") {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "a" / "b.toml";
    PreferencesFile preferences(file);
    CHECK(preferences.problem().empty());

    preferences.keep({.device = "mouse"});

    CHECK(PreferencesFile(file).now() == Preferences{.device = "mouse"});
    CHECK(parse_preferences(read_text_file(file), "p.toml").device == "mouse");
}

TEST_CASE("a file that cannot be read is not written over", "[tools][preferences]") {
    const test::TemporaryFolder folder;
    const auto file = folder.add_file("p.toml", "device = \"omni\"\ncolour = 3\n");
    PreferencesFile preferences(file);

    CHECK_THAT(preferences.problem(), Contains("p.toml:2:10: unknown key 'colour'"));
    CHECK(preferences.now() == Preferences{});
    CHECK_THAT(test::load_error_of([&] { preferences.keep({.device = "mouse"}); }),
               Contains("preferences cannot be saved: ") && Contains("unknown key"));
    CHECK(read_text_file(file) == "device = \"omni\"\ncolour = 3\n");
}

TEST_CASE("the file is where the system keeps settings", "[tools][preferences]") {
    setenv("XDG_CONFIG_HOME", "/some/where", 1);
    CHECK(find_preferences_file() == "/some/where/palpa/preferences.toml");
    setenv("XDG_CONFIG_HOME", "relative", 1);
    unsetenv("APPDATA");
    setenv("HOME", "/home/somebody", 1);
    CHECK(find_preferences_file() == "/home/somebody/.config/palpa/preferences.toml");
    setenv("XDG_CACHE_HOME", "/some/cache", 1);
    CHECK(find_cache_folder("structures") == "/some/cache/palpa/structures");
    unsetenv("XDG_CACHE_HOME");
    unsetenv("LOCALAPPDATA");
    CHECK(find_cache_folder("structures") == "/home/somebody/.cache/palpa/structures");
    unsetenv("XDG_CONFIG_HOME");
    unsetenv("HOME");
    CHECK_FALSE(find_preferences_file());
    CHECK_FALSE(find_cache_folder("structures"));
}
