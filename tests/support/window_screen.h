// A window's world on a screen that is not there: a mouse that is only numbers works its panels.
#pragma once
#include "app/frame.h"
#include "app/panels.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "tests/support/water_scene.h"
#include "ui/backend.h"
#include "ui/question.h"

#include <imgui.h>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpa::test {

// A session that only notes what it is sent.
class NotingSession final : public WindowSession {
public:
    void send(const Command& command) override { commands.push_back(command); }
    bool read_frame(LiveFrame&) override { return false; }
    World copy_world() override { return world; }
    bool pop_ticks(std::span<ServoTick>) noexcept override { return false; }
    void change_device(Device&, HandOrders*, std::size_t) override {}
    void begin_recording(const std::filesystem::path&, bool,
                         const std::optional<TrajectorySettings>&) override {
        recorded.emplace();
    }
    void end_recording() override { recorded.reset(); }
    std::optional<RecordingState> recording() override { return recorded; }

    std::optional<double> packed_share() override { return packed; }
    std::vector<EndedRecording> take_ended() override { return std::exchange(ended, {}); }

    std::vector<Command> commands;
    std::optional<RecordingState> recorded;
    std::optional<double> packed;
    std::vector<EndedRecording> ended;
    World world;
};

struct WindowScreen {
    explicit WindowScreen(const SceneDescription& shown = water_scene(), float text_scale = 1)
        : scene(shown) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 800};
        io.DeltaTime = 1 / 60.0F;
        set_ui_style(text_scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        session.world = load_world(scene);
        app = build_window_world({nullptr, &session, &options, &scene}, {{&omni, nullptr, 0.1}});
        NewestFrame& moment = app.write<NewestFrame>();
        moment.is_there = true;
        moment.frame.atoms = list_atoms(session.world);
        moment.frame.objects = list_objects(session.world);
        moment.frame.places.resize(moment.frame.atoms->names.size());
        moment.frame.readout.contact = contact_at(session.world, 0).model;
        moment.frame.hands.front().contact = moment.frame.readout.contact;
        moment.frame.hands.front().held = held_range(session.world, hand_at(session.world, 0));
        tick.contact = moment.frame.readout.contact;
        for (int i = 0; i < 100; ++i) add_tick(app, tick);
    }
    WindowScreen(const WindowScreen&) = delete;
    WindowScreen& operator=(const WindowScreen&) = delete;
    ~WindowScreen() { ImGui::DestroyContext(); }

    Readout& readout() { return app.write<NewestFrame>().frame.readout; }

    // Draws a frame, and does what its panels ask for.
    void frame() {
        follow_settings(app);
        ImGui::NewFrame();
        const std::vector<PanelRequest> requests = draw_panels(app);
        const std::optional<Question>& question = app.resource<Dialogs>().question;
        if (question)
            if (const Answer* const answer = draw_question(*question)) given = answer->key;
        ImGui::Render();
        for (const PanelRequest& request : requests) request(app);
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) frame();
    }
    void drag(ImVec2 from, ImVec2 to) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = from;
        frame();
        io.MouseDown[0] = true;
        frame();
        io.MousePos = to;
        frame();
        io.MouseDown[0] = false;
        frames(2);
    }
    void click(ImVec2 place) { drag(place, place); }
    // Everything that is written on the screen has been laid out: vertices say so.
    int vertices() const { return ImGui::GetDrawData()->TotalVtxCount; }
    ScreenArea picture() const {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        return app.resource<Docks>().picture_area(size.x, size.y);
    }

    SceneDescription scene;
    WindowOptions options;
    NotingSession session;
    EmulatedOmni omni{EmulatedOmniSettings()};
    World app;
    ServoTick tick;
    std::optional<Key> given;
};

}  // namespace palpa::test
