// The inside of run_window: the window's thread, what it knows and what it does. A file of
// sandbox_* has what it does of one kind.
#pragma once
#include "app/film_recorder.h"
#include "app/render_scale.h"
#include "app/run_window.h"
#include "app/window_session.h"
#include "app/window_shell.h"
#include "devices/mouse_lead.h"
#include "sound/speaker.h"
#include "ui/add_panel.h"
#include "ui/question.h"
#include "ui/selection_panel.h"
#include "view/orbit_camera.h"
#include "view/selected_atoms.h"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

using SteadyClock = std::chrono::steady_clock;

inline constexpr double notice_s = 4, first_notice_s = 15;

inline double ms_since(SteadyClock::time_point begin) {
    return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
}

// A hand of the scene with its device.
struct WindowHand {
    Device* device;
    HandOrders* orders;
    double mouse_reach_m;
    MouseLead lead{mouse_reach_m};  // by mouse or keys
    bool is_leading = false;        // a person does so now
    double felt_newton = 0;         // sent to the device at this moment
    Vec3 waiting_m = Vec3::Zero();  // handle travel that the molecule has yet to follow
    bool is_at_wall = false;        // the contact force has stopped the molecule
    bool is_at_stop = false;        // the handle is at an end of its workspace
    Statistics statistics{servo_tick_s};

    bool is_led() const { return orders && mouse_reach_m > 0; }
};

class Sandbox {
public:
    Sandbox(WindowShell& shell, std::unique_ptr<WindowSession> session,
            const SceneDescription& scene, Device& device, const WindowOptions& options);

    WindowReport run();

private:
    void frame();
    void show_first_view();
    void look_at_all();
    void look_at_grabbed();
    ScreenArea free_area() const;
    glm::vec2 free_centre() const;
    Room free_room() const;
    glm::vec2 target_pixel() const;
    void compose_picture();
    void look_at_grabbed_or_all();
    void show_as(const ViewSettings& view);
    void send_view();
    // sandbox_selection.cpp
    void open_selection();
    void select(const std::string& expression);
    void select_anew();
    bool end_selection();
    void draw_selection();
    bool draw_box(const Input& input);
    void pin(std::uint32_t atom);
    void look_at_selected_or_ligand();
    // sandbox_saved_views.cpp
    void go_to(std::size_t number);
    void go_to_next_view();
    void add_view();
    void begin_or_end_tour();
    bool end_tour();
    void follow_tour();
    void follow_lesson();
    const std::vector<bool>& find_framed(const std::string& selection);
    void take_camera();
    void fly_to(const OrbitCamera& camera);
    void fly();
    bool is_saved() const;
    std::vector<EditAction> list_lasting_edits() const;
    void save_for_crash();
    void note_saved();
    template <typename Value>
    void choose_next(Value ViewSettings::* choice, std::size_t count, const char* said);
    // That of the mouse and of clicks, and that of the arrow keys: the same where there is one.
    WindowHand& hand() { return hands_[led_]; }
    const WindowHand& hand() const { return hands_[led_]; }
    std::size_t by_keys() const { return (led_ + 1) % hands_.size(); }
    const LiveHand& in_hand() const { return frame_.hands[led_]; }
    void exchange_hands();
    void follow_lead(std::size_t slot);
    void rest(std::size_t slot);
    void rest_all();
    void engage(std::size_t slot);
    void clutch(std::size_t slot);
    void lead(std::size_t slot, bool leads);
    void keep_in_sight(double seconds);
    bool can_choose_device() const { return devices_.open && !options_.study; }
    void look_for_devices();
    bool change_device(const std::string& name);
    bool choose_device(const std::string& name);
    void choose_next_device();
    bool switch_sound(bool is_on);
    void choose_sound();
    void play_force();
    void take_ticks();
    void take_input();
    void move_camera(const Input& input);
    void read_device_view(const Input& input);
    void post_pad(const Input& input);
    void move_hand(const Input& input);
    void move_hand_by_keys(const Input& input, double seconds);
    void pull(std::size_t slot, const glm::vec3& way);
    Vec3 find_wish(std::size_t slot) const;
    void show_wish();
    void draw_hand();
    void explain_hand(double most_newton);
    void perform(Action action);
    void record_or_end();
    void tell_recording_notes();
    void ask_for_export();
    void export_readings();
    void ask_what_to_export(const std::string& ending);
    void export_coordinates(const std::string& ending, const std::vector<std::string>& molecules);
    void film_or_end();
    void tell_of_film();
    void press_study_key();
    void press_key(const KeyPress& press);
    void press_in_dialog(const KeyPress& press);
    void give(const Answer& answer);
    // Something over the picture must be answered or closed first.
    bool is_asked() const { return question_ || add_panel_.is_open(); }
    bool save_scene();
    ViewDescription describe_view() const;
    void ask_to_quit();
    void ask_to_leave(const std::string& how, std::optional<NextScreen> next);
    void ask_about_dropped(const std::vector<std::filesystem::path>& files);
    void ask_for_stand_in();
    bool is_stand_in(const std::string& name) const;
    std::optional<std::uint32_t> find_atom(double x, double y);
    void look_at_pixel(double x, double y);
    void click(const MouseClick& click);
    void take_clicked();
    void take(const std::string& address);
    void release();
    void put_back();
    bool refuse_in_replay();
    void edit(EditAction action);
    void open_add_panel();
    void take_dropped(const Input& input);
    void add(AddEdit wanted);
    void remove_held();
    void tell_what_was_edited();
    std::string molecule_in_hand() const;
    void watch_hover(const Input& input, bool is_free);
    std::string describe_atom(std::uint32_t atom) const;
    void tell_what_is_held();
    void undo_or_redo(bool undoes);
    void tell_what_is_forgotten();
    void add_to_picture(ViewAdditions additions);
    void draw();
    void save(const WindowShot& shot);
    void notice(std::string text, double seconds = notice_s);
    VkExtent2D picture_size() const;

    const WindowOptions options_;
    DeviceMenu devices_;
    std::unique_ptr<Device> chosen_;  // in the place of the first that the window began with
    std::vector<WindowHand> hands_;
    std::size_t led_ = 0;  // by the mouse
    SteadyClock::time_point next_look_ = SteadyClock::now();
    SteadyClock::time_point next_crash_save_ = SteadyClock::now() + std::chrono::seconds(20);
    WindowShell& shell_;
    Window& window_;  // the shell's
    const std::unique_ptr<WindowSession> owned_session_;
    WindowSession& session_;
    Overlay overlay_;
    const std::string title_;  // of the scene
    LiveSettings saved_;       // as the scene's file has them, or the file saved last
    std::optional<Question> question_;
    std::optional<Speaker> speaker_;  // while sound is on

    LiveFrame frame_;
    bool has_frame_ = false;
    const ViewDescription first_;
    FrameScene first_picture_;
    bool has_first_picture_ = false;
    OrbitCamera camera_;
    ViewSettings view_;  // but for layers, names and what is hidden: those are the overlay's
    ViewSettings sent_;  // to the session, with these
    bool clips_;         // what hides the molecule in hand is left out
    bool looks_at_grabbed_ = false;
    FrameScene shown_;  // the frame's picture, and what the window puts in it
    SteadyClock::time_point last_input_ = SteadyClock::now();
    VkExtent2D drawn_size_{};  // of the last picture
    bool holding_ = false;
    bool is_hand_explained_ = options_.is_hand_explained;  // ring, thread and bar
    SelectionPanel selection_panel_;
    SelectionStatus selection_;
    std::vector<bool> selected_;  // atoms; none: nothing is selected
    struct Box {
        PictureBox corners;
        bool adds = false;  // to what is selected
    };
    std::optional<Box> box_;                            // that is drawn with the mouse
    std::shared_ptr<const AtomDirectory> known_atoms_;  // as looked at last
    std::vector<SavedView> saved_views_;
    std::vector<SavedView> written_views_;             // as the scene's file has them
    std::size_t forgotten_ = 0;                        // changes that undo had no room for, as told
    ViewAdditions written_additions_;                  // the same
    std::vector<EditAction> written_edits_;            // the same, but for the scene's own
    std::optional<std::size_t> at_view_;               // of the saved ones, that was gone to last
    std::map<std::string, std::vector<bool>> framed_;  // atoms, by selections
    std::string framed_problem_;                       // of the last one
    std::vector<bool> framed_now_;                     // by one that depends on the moment
    std::optional<std::size_t> lesson_step_;           // that was shown last
    struct Flight {
        OrbitCamera from, to;
        SteadyClock::time_point begin;
    };
    std::optional<Flight> flight_;                 // of the camera
    std::optional<SteadyClock::time_point> tour_;  // goes on then
    // What a click would take, once it is known to be no double click.
    struct Wanted {
        std::string address;
        SteadyClock::time_point when;
    };
    std::optional<Wanted> wanted_;
    std::string held_address_;  // as shown last
    AddPanel add_panel_;
    // Of an edit that is on its way, to be said once the molecule is there, or gone.
    struct Announced {
        std::string molecule;
        bool is_there = true;
        std::uint64_t refused_edits = 0;  // before it
        std::string text{};
        bool takes = false;  // it goes into the hand
    };
    std::optional<Announced> announced_;
    std::filesystem::path recorded_in_, filmed_in_;
    std::unique_ptr<FilmRecorder> film_;
    std::string hover_;
    SteadyClock::time_point rests_since_ = SteadyClock::now();  // the mouse; or looked at anew
    bool drags_panel_ = false;  // the drag that is under way, or was the last one
    SteadyClock::time_point device_polled_ = SteadyClock::now();  // the device, for the last time
    RenderScale scale_;
    const SteadyClock::time_point start_ = SteadyClock::now();
    bool is_over_ = false;            // the last screenshot is due
    std::optional<NextScreen> next_;  // after quitting
    bool quitting_ = false, wants_shot_ = false, must_rebuild_ = false;
    std::string notice_;
    std::string refusal_;      // of the device that was tried last
    bool has_looked_ = false;  // for the device that is wanted
    SteadyClock::time_point notice_until_{};
    std::vector<double> frame_ms_;
    double last_frame_ms_ = 0;
};

}  // namespace palpa
