// A window on the display: its size, its keys and its mouse, and a surface to draw on.
#pragma once
#include <vulkan/vulkan.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

struct GLFWwindow;

namespace palpa {

// No display, or one that cannot show a window: a sentence for the user.
class PlatformError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class MouseButton { Left, Right, Middle };

// Keys that mean something; all others are passed over.
enum class Key {
    Space,
    Enter,
    Escape,
    Tab,
    Home,
    Insert,
    Delete,
    Left,
    Right,
    Up,
    Down,
    PageUp,
    PageDown,
    F1,
    F5,
    F9,
    F12,
    Period,
    Plus,
    Minus,
    Digit0,
    Digit1,
    Digit2,
    Digit3,
    Digit4,
    Digit5,
    Digit6,
    A,
    C,
    D,
    E,
    F,
    G,
    H,
    L,
    M,
    N,
    O,
    P,
    Q,
    R,
    S,
    T,
    U,
    V,
    W,
    X,
    Y,
    Z,
    Count
};

// The first game pad whose buttons are known. Sticks from -1 to 1, y down.
struct PadState {
    double left_x = 0, left_y = 0, right_x = 0, right_y = 0;
    bool right_shoulder = false;
};

// A key as it was pressed, with the modifiers of that moment.
struct KeyPress {
    Key key;
    bool control = false, shift = false;
};

// Where a button went down, in pixels of the picture.
struct MousePress {
    MouseButton button;
    double x = 0, y = 0;
    bool control = false, shift = false;
};

// The left or the right button went down and up, and the mouse stayed where it was.
struct MouseClick {
    double x = 0, y = 0;
    bool control = false, shift = false, alt = false;  // as it went down
    bool is_second = false;                            // of a double click
    bool is_right = false;                             // the right button
};

// What came in since the last poll. Mouse places in pixels of the picture, from the upper left.
struct Input {
    double mouse_x = 0, mouse_y = 0;
    double mouse_dx = 0, mouse_dy = 0;
    double wheel = 0;             // notches, + away from the user
    std::array<bool, 3> down{};   // by MouseButton, at this moment
    bool double_clicked = false;  // the left one, twice at one place
    std::array<bool, static_cast<std::size_t>(Key::Count)> held{};
    std::vector<KeyPress> pressed;               // since the last poll, in their order
    std::vector<MousePress> clicked;             // the same
    std::vector<MouseClick> clicks;              // that ended
    std::vector<std::filesystem::path> dropped;  // files, on the window
    bool shift = false;                          // at this moment
    bool resized = false;                        // of the picture
    bool rescaled = false;  // of the text, since the window went to another display
    bool focused = true;    // keys are meant for this window
    std::optional<PadState> pad;

    bool is_held(Key key) const { return held[static_cast<std::size_t>(key)]; }
    bool is_down(MouseButton button) const { return down[static_cast<std::size_t>(button)]; }
};

// Two clicks are one double click within this time.
inline constexpr double double_click_s = 0.35;

// One at a time, on the main thread.
class Window {
public:
    // Throws PlatformError where there is no display.
    Window(const std::string& title, std::uint32_t width, std::uint32_t height);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    // What a surface needs of the Vulkan instance, and the surface, which belongs to the caller.
    std::vector<const char*> vulkan_extensions() const;
    VkSurfaceKHR create_surface(VkInstance instance) const;

    // Makes the window larger by the display's scale, as text is, where the display has the room.
    void grow_with_display();

    // Of the picture, in pixels; 0x0 while the window is folded away.
    VkExtent2D size() const;

    // Takes in what happened.
    const Input& poll();

    void set_title(const std::string& title);

    bool should_close() const;
    // The person wants to stay after all.
    void keep_open();

    // How many times larger than usual text and controls are wanted on this display.
    float content_scale() const;

    // While it is captured the cursor is not seen and nothing stops it; it comes back where it was.
    void capture_cursor(bool is_captured);

    // For the overlay library's own listening.
    GLFWwindow* handle() const noexcept { return window_; }

private:
    static void listen(GLFWwindow* window);
    static void press(Window& window, int button, int mods);
    static void release(Window& window, int button);
    void scale_to_pixels(double& x, double& y) const;

    GLFWwindow* window_ = nullptr;
    Input input_;
    bool has_mouse_ = false, is_captured_ = false;
    double cursor_x_ = 0, cursor_y_ = 0;  // of the last event, in the window's own units
    double last_click_s_ = -1, last_click_x_ = 0, last_click_y_ = 0;
    MouseClick click_;          // that is under way
    bool is_clicking_ = false;  // it may become one: the mouse has not moved
};

}  // namespace palpa
