// A window with keyboard and mouse input and a surface to draw on.
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

// Thrown if there is no display or it cannot show a window; a sentence for the user.
class PlatformError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class MouseButton { Left, Right, Middle };

// The keys that are used, with all letters in their order; others are ignored.
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
    B,
    C,
    D,
    E,
    F,
    G,
    H,
    I,
    J,
    K,
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

// State of the first game pad with known buttons. Sticks from -1 to 1, y down.
struct PadState {
    double left_x = 0, left_y = 0, right_x = 0, right_y = 0;
    bool right_shoulder = false;
};

// A pressed key with its modifiers.
struct KeyPress {
    Key key;
    bool control = false, shift = false;
};

// A button press, position in pixels of the picture.
struct MousePress {
    MouseButton button;
    double x = 0, y = 0;
    bool control = false, shift = false;
};

// A click: the left or right button went down and up while the mouse did not move.
struct MouseClick {
    double x = 0, y = 0;
    bool control = false, shift = false, alt = false;  // modifiers at the press
    bool is_second = false;                            // the second of a double click
    bool is_right = false;                             // the right button
};

// Input since the last poll. Mouse positions in pixels of the picture from the upper left corner.
struct Input {
    double mouse_x = 0, mouse_y = 0;
    double mouse_dx = 0, mouse_dy = 0;
    double wheel = 0;             // notches, positive away from the user
    std::array<bool, 3> down{};   // state by MouseButton now
    bool double_clicked = false;  // left button, twice at one point
    std::array<bool, static_cast<std::size_t>(Key::Count)> held{};
    std::vector<KeyPress> pressed;               // in order
    std::vector<MousePress> clicked;             // the same
    std::vector<MouseClick> clicks;              // completed clicks
    std::vector<std::filesystem::path> dropped;  // files dropped on the window
    bool shift = false;                          // at this moment
    bool resized = false;                        // the size of the picture has changed
    bool rescaled =
        false;            // the text scale has changed because the window moved to another display
    bool focused = true;  // the window has the keyboard
    std::optional<PadState> pad;

    bool is_held(Key key) const { return held[static_cast<std::size_t>(key)]; }
    bool is_down(MouseButton button) const { return down[static_cast<std::size_t>(button)]; }
};

// Longest time between the two clicks of a double click.
inline constexpr double double_click_s = 0.35;

// At most one at a time, on the main thread.
class Window {
public:
    // Throws PlatformError if there is no display.
    Window(const std::string& title, std::uint32_t width, std::uint32_t height);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    // The Vulkan extensions that the surface needs, and the surface, which the caller owns.
    std::vector<const char*> vulkan_extensions() const;
    VkSurfaceKHR create_surface(VkInstance instance) const;

    // Makes the window as large as the display has room.
    void fill_screen();
    // Width and height in the display's own units, to be set again.
    std::array<int, 2> own_size() const;
    void set_own_size(const std::array<int, 2>& size);

    // Size of the picture in pixels; 0x0 while the window is minimised.
    VkExtent2D size() const;

    // Processes events.
    const Input& poll();

    void set_title(const std::string& title);

    bool should_close() const;
    void close();  // as if the person did
    // Cancels a request to close the window.
    void keep_open();

    // Scale of text and controls on this display relative to normal.
    float content_scale() const;

    // A captured cursor is hidden and has no limits; on release it returns to its old position.
    void capture_cursor(bool is_captured);

    // For the overlay library's event handling.
    GLFWwindow* handle() const noexcept { return window_; }

private:
    static void listen(GLFWwindow* window);
    static void press(Window& window, int button, int mods);
    static void release(Window& window, int button);
    void scale_to_pixels(double& x, double& y) const;

    GLFWwindow* window_ = nullptr;
    Input input_;
    bool has_mouse_ = false, is_captured_ = false;
    double cursor_x_ = 0, cursor_y_ = 0;  // at the last event, in the window's own units
    double last_click_s_ = -1, last_click_x_ = 0, last_click_y_ = 0;
    MouseClick click_;          // the click in progress
    bool is_clicking_ = false;  // the press may become a click: the mouse has not moved
};

}  // namespace palpa
