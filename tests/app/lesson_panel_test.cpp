// The lesson beside the picture: answers by letters and clicks, and what each step names is seen.
#include "app/actions.h"
#include "app/camera.h"
#include "app/lesson_course.h"
#include "app/scene_cards.h"
#include "molecule/select.h"
#include "render/renderer.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "simulation/select_in_world.h"
#include "tests/support/window_screen.h"
#include "view/build_frame.h"

#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using test::WindowScreen;

namespace {

Lesson& lesson_of(WindowScreen& screen) { return screen.app.write<LessonState>().lesson; }

void go_to_question(WindowScreen& screen) {
    Lesson& lesson = lesson_of(screen);
    while (!lesson.steps()[lesson.current()].question) lesson.skip();
    screen.frames(3);
}

// Gives the step its goal for so long that it is done, and has its longest text.
void reach_goal(Lesson& lesson) {
    const LessonStepDescription& step = lesson.steps()[lesson.current()];
    const double least = step.at_least.value_or(step.at_most.value_or(0));
    const double most = step.at_most.value_or(least), value = (least + most) / 2;
    Reading reading;
    reading.distance_angstrom = reading.molecular_nN = reading.hand_N = value;
    const std::vector<double> measured(lesson.steps().size(), value);
    const auto mode = step.quantity == LessonQuantity::Mode
                          ? static_cast<CouplingMode>(static_cast<int>(value) - 1)
                          : CouplingMode::Guarded;
    for (int i = 0; i < 2100; ++i) lesson.update(reading, mode, measured);
}

// Keeps each mark of the lesson in `noted`, which outlives the screen's last frame.
void note_done_marks(WindowScreen& screen, std::vector<bool>& noted) {
    screen.options.lesson.remember_done = [&](bool is_done) { noted.push_back(is_done); };
    screen.frames(3);
}

// How far a part of the panel can be scrolled, pixels.
float scroll_of(const std::string& part) {
    float most = 0;
    for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows) {
        const std::string name = window->Name;
        if (window->WasActive && name.find('/' + part + '_') != std::string::npos)
            most = std::max(most, window->ScrollMax.y);
    }
    return most;
}

// Presses a key as the window does: panels first, then actions.
void press(WindowScreen& screen, Key key) {
    const KeyPress press{key};
    if (press_in_panels(screen.app, press)) return;
    if (const Action* const action = find_action(press)) perform(screen.app, *action);
}

// Atoms that a step speaks of: of its quantity, or else what is in hand.
std::vector<std::uint32_t> find_named(const WindowScreen& screen,
                                      const LessonStepDescription& step) {
    std::vector<std::uint32_t> atoms;
    for (const std::string& text : step.of) {
        const std::vector<bool> chosen =
            select_in_world(screen.session.world, parse_selection(text, "of"));
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (chosen[i]) atoms.push_back(static_cast<std::uint32_t>(i));
    }
    if (!atoms.empty()) return atoms;
    const AtomRange held = led_hand(screen.app).held;
    for (std::uint32_t i = 0; i < held.count; ++i) atoms.push_back(held.first + i);
    return atoms;
}

std::vector<SceneEntry> list_lessons() {
    std::vector<SceneEntry> lessons;
    std::ranges::copy_if(list_scenes(test::in_project("scenes")), std::back_inserter(lessons),
                         &SceneEntry::has_lesson);
    return lessons;
}

}  // namespace

TEST_CASE("answers take their letters, and nothing else does", "[app][lesson]") {
    WindowScreen screen;
    screen.frames(3);
    press(screen, Key::C);  // no question yet: the next colours
    CHECK(screen.app.resource<PictureState>().view.colouring != screen.options.view.colouring);
    go_to_question(screen);
    Lesson& lesson = lesson_of(screen);
    const Colouring colours = screen.app.resource<PictureState>().view.colouring;
    press(screen, Key::C);
    CHECK(lesson.chosen() == 2);
    CHECK_FALSE(lesson.is_step_done());
    press(screen, Key::A);
    CHECK(lesson.chosen() == 0);
    press(screen, Key::B);  // the right one
    CHECK(lesson.is_step_done());
    press(screen, Key::C);
    CHECK(lesson.chosen() == 1);
    CHECK(screen.app.resource<PictureState>().view.colouring == colours);
    press(screen, Key::V);  // no answer has it
    CHECK(screen.app.resource<PictureState>().view.representation !=
          screen.options.view.representation);
}

TEST_CASE("a step that is done can be passed over, and the lesson counts as done",
          "[app][lesson]") {
    WindowScreen screen;
    std::vector<bool> noted;
    note_done_marks(screen, noted);
    Lesson& lesson = lesson_of(screen);
    for (; !lesson.is_done(); perform(screen.app, "skip-step")) {
        if (const auto& question = lesson.steps()[lesson.current()].question)
            lesson.answer(static_cast<std::size_t>(question->right) - 1);
        else
            reach_goal(lesson);
        REQUIRE(lesson.is_step_done());
    }
    follow_lesson(screen.app);
    CHECK(noted == std::vector<bool>{true});
}

TEST_CASE("a step that is passed over before it is done leaves the lesson without its mark",
          "[app][lesson]") {
    WindowScreen screen;
    std::vector<bool> noted;
    note_done_marks(screen, noted);
    while (!lesson_of(screen).is_done()) perform(screen.app, "skip-step");
    follow_lesson(screen.app);
    CHECK(noted.empty());
}

TEST_CASE("Enter goes on in a lesson only where the lesson is seen", "[app][lesson]") {
    WindowScreen screen;
    screen.frames(3);
    Lesson& lesson = lesson_of(screen);
    for (int i = 0; i < 2; ++i) reach_goal(lesson);  // 4.2 s
    REQUIRE(lesson.can_go_on());
    press(screen, Key::Tab);  // panels away
    screen.frames(3);
    press(screen, Key::Enter);
    CHECK(lesson.current() == 0);
    press(screen, Key::Tab);
    screen.frames(3);
    press(screen, Key::Enter);
    CHECK(lesson.current() == 1);
}

TEST_CASE("what is said of an answer moves no answer under the mouse", "[app][lesson]") {
    WindowScreen screen;
    ImGui::GetIO().DisplaySize = {1280, 800};
    screen.frames(3);
    go_to_question(screen);
    Lesson& lesson = lesson_of(screen);
    const ScreenArea picture = screen.picture();
    // Down the right half of the panel: the places of the answers.
    const float x = picture.left + 0.75F * picture.width();
    const auto answer_at = [&](float y) {
        lesson.restart();
        go_to_question(screen);
        screen.click({x, y});
        return lesson.chosen();
    };
    std::vector<std::optional<std::size_t>> first, after;
    for (float y = picture.bottom + 30; y < 790; y += 12) {
        first.push_back(answer_at(y));
        if (!first.back()) continue;
        lesson.restart();
        go_to_question(screen);
        lesson.answer(0);  // a wrong one, which is explained
        screen.frames(3);
        screen.click({x, y});
        CHECK(lesson.chosen() == first.back());
    }
    for (const std::size_t answer : {0U, 1U, 2U})
        CHECK(std::ranges::count(first, std::optional<std::size_t>(answer)) > 0);
}

TEST_CASE("no step of a lesson has to be scrolled to be read", "[app][lesson]") {
    for (const SceneEntry& entry : list_lessons()) {
        WindowScreen screen(read_scene(entry.file));
        for (const ImVec2 size : {ImVec2(1280, 800), ImVec2(1366, 768)}) {
            ImGui::GetIO().DisplaySize = size;
            Lesson& lesson = lesson_of(screen);
            for (lesson.restart(); !lesson.is_done(); lesson.skip()) {
                const LessonStepDescription& step = lesson.steps()[lesson.current()];
                const std::size_t answers = step.question ? step.question->answers.size() : 0;
                for (std::size_t answer = 0; answer <= answers; ++answer) {
                    INFO(entry.name << ", step " << step.name << ", " << size.x << " x " << size.y
                                    << ", answer " << answer);
                    if (answer > 0) lesson.answer(answer - 1);
                    reach_goal(lesson);
                    screen.frames(3);
                    for (const char* const part : {"text ", "beside "})
                        CHECK(scroll_of(part + std::to_string(lesson.current())) == 0);
                }
            }
        }
    }
}

TEST_CASE("what a step of a lesson names is in the picture, and no panel covers it",
          "[app][lesson]") {
    const std::vector<SceneEntry> lessons = list_lessons();
    REQUIRE(lessons.size() == 8);
    for (const SceneEntry& entry : lessons) {
        WindowScreen screen(read_scene(entry.file));
        for (const ImVec2 size : {ImVec2(1280, 800), ImVec2(1366, 768)}) {
            ImGui::GetIO().DisplaySize = size;
            screen.app.write<SavedViewState>().lesson_step.reset();
            lesson_of(screen).restart();
            screen.frames(3);
            PictureState& picture = screen.app.write<PictureState>();
            NewestFrame& newest = screen.app.write<NewestFrame>();
            newest.frame.picture = build_frame(screen.session.world, screen.options.view);
            for (const Vec3& place : screen.session.world.resource<AtomTable>().positions)
                newest.frame.places.push_back(as_float(place));
            picture.first = newest.frame.picture;
            picture.has_first = true;
            show_first_view(screen.app);
            for (; !lesson_of(screen).is_done(); lesson_of(screen).skip()) {
                const LessonStepDescription& step =
                    lesson_of(screen).steps()[lesson_of(screen).current()];
                INFO(entry.name << ", step " << step.name << ", " << size.x << " x " << size.y);
                follow_lesson(screen.app);
                screen.frames(2);
                CameraState& state = screen.app.write<CameraState>();
                if (state.flight) state.now = state.flight->to;
                state.flight.reset();
                FrameCamera camera = frame_camera(state.now, newest.frame.picture);
                camera.centre = free_centre(screen.app);
                const ScreenArea area = screen.picture();
                std::size_t seen = 0;
                const std::vector<std::uint32_t> atoms = find_named(screen, step);
                for (const std::uint32_t atom : atoms) {
                    const glm::vec3 at = project(camera, newest.frame.places[atom],
                                                 static_cast<std::uint32_t>(size.x),
                                                 static_cast<std::uint32_t>(size.y));
                    seen += at.z > camera.near && at.x > area.left && at.x < area.right &&
                            at.y > area.top && at.y < area.bottom;
                }
                CHECK(seen == atoms.size());
            }
        }
    }
}
