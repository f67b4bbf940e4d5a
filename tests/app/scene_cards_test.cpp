// The cards of the start screen.
#include "app/scene_cards.h"

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("cards are in groups, and TL-3 is among the first three", "[app][start]") {
    CardSource source{.scenes = list_scenes(test::in_project("scenes"))};
    source.lessons_done = {"water", "/home/me/mine.toml"};
    source.yours = {{"/home/me/mine.toml", "/home/me/mine.toml", "Mine"}};
    source.yours.back().has_lesson = true;
    const SceneCards found = list_cards(source);
    const std::vector<SceneCard>& cards = found.cards;

    CHECK(std::ranges::is_sorted(cards, {}, &SceneCard::group));
    for (const CardGroup group :
         {CardGroup::Lessons, CardGroup::Explore, CardGroup::Research, CardGroup::Yours})
        CHECK(std::ranges::count(cards, group, &SceneCard::group) > 0);
    REQUIRE(cards.size() > 3);
    CHECK(std::any_of(cards.begin(), cards.begin() + 3, [](const SceneCard& card) {
        return card.scene.about.find("TL-3") != std::string::npos;
    }));
    for (const SceneCard& card : cards) {
        INFO(card.scene.name);
        CHECK(card.is_done == (card.scene.name == "water" || card.scene.title == "Mine"));
        CHECK(card.scene.has_lesson == (card.group == CardGroup::Lessons || card.is_done));
        if (card.group != CardGroup::Yours) {
            CHECK(card.picture);
        }
    }
    CHECK(cards.back().scene.title == "Mine");
}

TEST_CASE("a search finds words of title, text and name", "[app][start]") {
    const SceneEntry entry{"hiv/lesson", "lesson.toml", "A drug leaves its pocket",
                           "The inhibitor TL-3."};
    CHECK(has_words(entry, ""));
    CHECK(has_words(entry, "hiv"));
    CHECK(has_words(entry, "tl-3 DRUG"));
    CHECK_FALSE(has_words(entry, "drug water"));
}

TEST_CASE("a scene without a title is called as its folder and file", "[app][start]") {
    const test::TemporaryFolder folder;
    CHECK(describe_file(folder.path() / "4hvp.pdb").title ==
          (folder.path().filename() / "4hvp.pdb").generic_string());
    const SceneEntry water = describe_file(test::in_project("scenes/water/scene.toml"));
    CHECK(water.title == "Two waters");
    CHECK(water.has_lesson);
}
