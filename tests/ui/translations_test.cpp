// The catalogues of engine/ui/locale, as this build compiled them.
#include "core/translate.h"
#include "tests/support/in_language.h"
#include "tests/support/skip.h"
#include "ui/backend.h"
#include "ui/language_list.h"
#include "ui/layout.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

constexpr const char* no_catalogue = "no German catalogue: msgfmt was missing, or no gettext here";

std::string by_printf(double value) {
    char text[20];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

}  // namespace

TEST_CASE("texts are German once that is chosen, and English again", "[ui][translate]") {
    CHECK(translated("water") == std::string("water"));
    {
        const test::InLanguage german("de");
        if (!german.is_there()) return test::skip(no_catalogue);
        CHECK(language_in_use() == "de");
        CHECK(translated("water") == std::string("Wasser"));
        CHECK(translated("hold Space, move the mouse") ==
              std::string("Leertaste halten, Maus bewegen"));
        CHECK(translated_plural("{} degree of freedom", "{} degrees of freedom", 1) ==
              std::string("{} Freiheitsgrad"));
        CHECK(translated_plural("{} degree of freedom", "{} degrees of freedom", 2) ==
              std::string("{} Freiheitsgrade"));
        // What is in no catalogue stays, and so does nothing at all.
        CHECK(translated("no text of Palpa") == std::string("no text of Palpa"));
        CHECK(translated("") == std::string());
    }
    CHECK(language_in_use() == "en");
    CHECK(translated("water") == std::string("water"));
}

TEST_CASE("a language that is not there leaves the texts English", "[ui][translate]") {
    CHECK(choose_language("en"));
    CHECK_FALSE(choose_language("tlh"));
    CHECK(translated("water") == std::string("water"));
    CHECK(list_languages().front().code == "en");
}

TEST_CASE("in German numbers keep their decimal point", "[ui][translate]") {
    const test::InLanguage german("de");
    if (!german.is_there()) return test::skip(no_catalogue);
    CHECK(format_translated("{:.4g} of {:.4g} N/m", 1.5, 2.25) == "1.5 von 2.25 N/m");
    CHECK(by_printf(1.5) == "1.5");
    CHECK(std::strtod("2.5", nullptr) == 2.5);
    CHECK(std::setlocale(LC_NUMERIC, nullptr) == std::string("C"));
}

TEST_CASE("a label has the same ID in every language", "[ui][translate]") {
    CHECK(labelled("Pause") == "Pause###Pause");
    const test::InLanguage german("de");
    if (!german.is_there()) return test::skip(no_catalogue);
    CHECK(labelled("Lesson") == "Lektion###Lesson");
}

TEST_CASE("who chooses a language from the list has its words at once", "[ui][translate]") {
    const test::InLanguage english("en");
    const std::vector<Language> languages{{"en", "English"}, {"de", "Deutsch"}};
    if (list_languages().size() < 2) return test::skip(no_catalogue);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {640, 480};
    io.DeltaTime = 1 / 60.0F;
    set_ui_style(1);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    std::optional<std::string> chosen;
    const auto frame = [&] {
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({300, 200});
        ImGui::Begin("list");
        if (auto code = draw_language_list(languages)) chosen = std::move(code);
        ImGui::End();
        ImGui::Render();
    };
    const auto click = [&](float y) {
        io.MousePos = {60, y};
        frame();
        io.MouseDown[0] = true;
        frame();
        io.MouseDown[0] = false;
        frame();
        frame();
    };
    const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
    for (float y = 20; y < 100 && open.empty(); y += 6) click(y);
    REQUIRE(open.Size == 1);
    REQUIRE(open.back().Window);
    // German is the last of it.
    click(open.back().Window->Rect().Max.y - ImGui::GetFontSize());
    ImGui::DestroyContext();
    REQUIRE(chosen == "de");
    CHECK(choose_language(*chosen));
    CHECK(translated("Language") == std::string("Sprache"));
}

// Run by language_test.py, which sets the environment: what is chosen first cannot be unchosen.
TEST_CASE("the environment chooses the language", "[.][translate]") {
    CHECK(choose_language(""));
    std::printf("in use: %s, %s\n", language_in_use().c_str(), translated("water"));
}
