// The dialog that looks for a file, without a window.
#include "ui/file_browser.h"

#include "tests/support/temporary_folder.h"

#include <imgui.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpa;

namespace {

struct Screen {
    Screen() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 800};
        io.DeltaTime = 1 / 60.0F;
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    ~Screen() { ImGui::DestroyContext(); }

    std::optional<std::filesystem::path> draw(FileBrowser& browser) {
        ImGui::NewFrame();
        auto file = browser.draw();
        ImGui::Render();
        return file;
    }
    void type(FileBrowser& browser, const char* letters) {
        ImGui::GetIO().AddInputCharactersUTF8(letters);
        (void)draw(browser);
    }
};

}  // namespace

TEST_CASE("letters go to the first name that begins with them, and Enter opens it", "[ui]") {
    const test::TemporaryFolder folder;
    for (const char* const name : {"1abc.pdb", "4hhb.cif", "4hvp.pdb", "notes.txt"})
        std::ofstream(folder.path() / name) << "x";
    std::filesystem::create_directory(folder.path() / "4folder");
    Screen screen;
    FileBrowser browser;
    browser.open("Open", {".pdb", ".cif"}, folder.path());
    (void)screen.draw(browser);
    CHECK(browser.chosen() == "4folder");

    screen.type(browser, "4H");
    CHECK(browser.chosen() == "4hhb.cif");
    screen.type(browser, "v");
    CHECK(browser.chosen() == "4hvp.pdb");
    screen.type(browser, "x");  // nothing begins so
    CHECK(browser.chosen() == "4hvp.pdb");
    for (int i = 0; i < 70; ++i) (void)screen.draw(browser);  // more than a second
    screen.type(browser, "1");
    CHECK(browser.chosen() == "1abc.pdb");
    screen.type(browser, "n");  // no file of the kind that is looked for
    CHECK(browser.chosen() == "1abc.pdb");

    browser.press(Key::Enter);
    const auto file = screen.draw(browser);
    REQUIRE(file);
    CHECK(file->filename() == "1abc.pdb");
    CHECK_FALSE(browser.is_open());
    CHECK(std::filesystem::equivalent(browser.folder(), folder.path()));
}

TEST_CASE("the letter that opened the dialog is not looked for", "[ui]") {
    const test::TemporaryFolder folder;
    for (const char* const name : {"1abc.pdb", "other.pdb"})
        std::ofstream(folder.path() / name) << "x";
    Screen screen;
    FileBrowser browser;
    ImGui::GetIO().AddInputCharactersUTF8("o");  // the key O, which also writes
    browser.open("Open", {".pdb"}, folder.path());
    (void)screen.draw(browser);
    CHECK(browser.chosen() == "1abc.pdb");
    screen.type(browser, "o");
    CHECK(browser.chosen() == "other.pdb");
}

TEST_CASE("instead of a folder that is gone the dialog shows one that is there", "[ui]") {
    const test::TemporaryFolder folder;
    Screen screen;
    FileBrowser browser;
    browser.open("Open", {".pdb"}, folder.path() / "gone");
    (void)screen.draw(browser);
    CHECK(std::filesystem::is_directory(browser.folder()));
}
