// Whatever a person presses, the device is never given more than its clamp, and nothing crashes.
#include "app/actions.h"
#include "app/frame.h"
#include "app/live_session.h"
#include "app/panels.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "tests/support/water_scene.h"
#include "ui/backend.h"

#include <imgui.h>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;

namespace {

// Remembers the largest force that it was given.
class ClampedOmni final : public Device {
public:
    explicit ClampedOmni(const EmulatedOmniSettings& settings) : omni_(settings) {}

    const DeviceSpec& spec() const noexcept override { return omni_.spec(); }
    DeviceReading read() noexcept override { return omni_.read(); }
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override {
        omni_.show(contact, waiting_m);
    }
    void write(const Vec3& force_newton) noexcept override {
        const double force = force_newton.norm();
        if (!std::isfinite(force)) is_finite_ = false;
        if (force > largest_) largest_ = force;
        omni_.write(force_newton);
    }

    double largest() const noexcept { return largest_; }
    bool is_finite() const noexcept { return is_finite_; }

private:
    EmulatedOmni omni_;
    std::atomic<double> largest_{0};
    std::atomic<bool> is_finite_{true};
};

class RandomPerson {
public:
    explicit RandomPerson(unsigned seed) : draw_(seed) {}

    // One event: the mouse, a key of the list, a handle pulled somewhere, or an edit.
    void act(World& app, LiveSession& session) {
        ImGuiIO& io = ImGui::GetIO();
        switch (below(6)) {
            case 0:
                io.MousePos = {static_cast<float>(below(1280)), static_cast<float>(below(800))};
                io.MouseDown[0] = below(2) == 0;
                break;
            case 1:
                io.MouseDown[0] = below(2) == 0;
                io.MouseWheel = static_cast<float>(below(3)) - 1;
                break;
            case 2: {
                const std::span<const Action> all = list_actions();
                const Action& action = all[below(all.size())];
                if (needs_no_window(action)) perform(app, action);
                break;
            }
            case 4:
                session.send(ViewAdditions{{}, {"resid " + std::to_string(below(3))}, {}});
                break;
            case 3:
                session.move_hand({0.2 * (unit() - 0.5), 0.2 * (unit() - 0.5), 0});
                break;
            default:
                session.send(edit_now(choose_edit()));
        }
    }

private:
    // Tests have no window whose graphics could be restarted, write no files and make no sound.
    static bool needs_no_window(const Action& action) {
        return action.menu != Menu::File && !action.over_dialogs && action.id != "dark-theme" &&
               action.id != "sound";
    }

    EditAction choose_edit() {
        const std::string name = below(2) == 0 ? "fixed" : "moved";
        switch (below(7)) {
            case 0:
                return GrabEdit{name};
            case 1:
                return GrabEdit{name + ":1 OH2"};
            case 2:
                return ReleaseEdit{};
            case 3:
                return RemoveEdit{name};
            case 4:
                return UndoEdit{};
            case 5:
                return RedoEdit{};
            default: {
                AddEdit add;
                add.residue = below(4) == 0 ? "NONE" : "TIP3";
                add.name = "w" + std::to_string(below(3));
                add.at_angstrom = {10 * unit() - 5, 10 * unit() - 5, 10 * unit() - 5};
                return add;
            }
        }
    }

    std::size_t below(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(draw_);
    }
    double unit() { return std::uniform_real_distribution<double>(0, 1)(draw_); }

    std::mt19937 draw_;
};

}  // namespace

TEST_CASE("a thousand random events of a person give the device no more than its clamp",
          "[app][random]") {
    const unsigned seed = GENERATE(1U, 2U);
    INFO("seed " << seed);
    constexpr int events = 500;  // of each seed
    HandOrders orders;
    EmulatedOmniSettings settings;
    settings.hand = hand_model(HandGrip::Medium);
    settings.orders = &orders;
    settings.driver = HandDriver::Mouse;
    settings.half_workspace_m = Vec3::Constant(0.5);
    ClampedOmni device(settings);
    const SceneDescription scene = test::water_scene();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {1280, 800};
    ImGui::GetIO().DeltaTime = 1 / 60.0F;
    set_ui_style(1);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    {
        LiveSession session(scene, {}, device, &orders);
        const WindowOptions options;
        World app =
            build_window_world({nullptr, &session, &options, &scene}, {{&device, &orders, 0.1}});
        RandomPerson person(seed);
        NewestFrame& moment = app.write<NewestFrame>();
        std::uint64_t frames = 0;
        for (int i = 0; i < events; ++i) {
            person.act(app, session);
            take_ticks(app);
            frames += session.read_frame(moment.frame) ? 1 : 0;
            moment.is_there = frames > 0;
            ImGui::NewFrame();
            std::vector<PanelRequest> requests;
            if (frames > 0) requests = draw_panels(app);
            ImGui::Render();
            for (const PanelRequest& request : requests) request(app);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        CHECK(frames > 0);
    }
    ImGui::DestroyContext();
    CHECK(device.is_finite());
    CHECK(device.largest() > 0);
    CHECK(device.largest() <= scene.coupling.clamp_N + 1e-9);
}
