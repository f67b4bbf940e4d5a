#include "window/window.h"

#include "platform/system.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace palpa {
namespace {

// GLFW's name of a key, and ours.
struct KeyName {
    int glfw;
    Key key;
};
constexpr std::array key_names = std::to_array<KeyName>({
    {GLFW_KEY_SPACE, Key::Space},
    {GLFW_KEY_ENTER, Key::Enter},
    {GLFW_KEY_ESCAPE, Key::Escape},
    {GLFW_KEY_TAB, Key::Tab},
    {GLFW_KEY_HOME, Key::Home},
    {GLFW_KEY_INSERT, Key::Insert},
    {GLFW_KEY_DELETE, Key::Delete},
    {GLFW_KEY_LEFT, Key::Left},
    {GLFW_KEY_RIGHT, Key::Right},
    {GLFW_KEY_UP, Key::Up},
    {GLFW_KEY_DOWN, Key::Down},
    {GLFW_KEY_PAGE_UP, Key::PageUp},
    {GLFW_KEY_PAGE_DOWN, Key::PageDown},
    {GLFW_KEY_F1, Key::F1},
    {GLFW_KEY_F5, Key::F5},
    {GLFW_KEY_F9, Key::F9},
    {GLFW_KEY_F12, Key::F12},
    {GLFW_KEY_PERIOD, Key::Period},
    {GLFW_KEY_EQUAL, Key::Plus},
    {GLFW_KEY_MINUS, Key::Minus},
    {GLFW_KEY_0, Key::Digit0},
    {GLFW_KEY_1, Key::Digit1},
    {GLFW_KEY_2, Key::Digit2},
    {GLFW_KEY_3, Key::Digit3},
    {GLFW_KEY_4, Key::Digit4},
    {GLFW_KEY_5, Key::Digit5},
    {GLFW_KEY_6, Key::Digit6},
    {GLFW_KEY_A, Key::A},
    {GLFW_KEY_B, Key::B},
    {GLFW_KEY_C, Key::C},
    {GLFW_KEY_D, Key::D},
    {GLFW_KEY_E, Key::E},
    {GLFW_KEY_F, Key::F},
    {GLFW_KEY_G, Key::G},
    {GLFW_KEY_H, Key::H},
    {GLFW_KEY_I, Key::I},
    {GLFW_KEY_J, Key::J},
    {GLFW_KEY_K, Key::K},
    {GLFW_KEY_L, Key::L},
    {GLFW_KEY_M, Key::M},
    {GLFW_KEY_N, Key::N},
    {GLFW_KEY_O, Key::O},
    {GLFW_KEY_P, Key::P},
    {GLFW_KEY_Q, Key::Q},
    {GLFW_KEY_R, Key::R},
    {GLFW_KEY_S, Key::S},
    {GLFW_KEY_T, Key::T},
    {GLFW_KEY_U, Key::U},
    {GLFW_KEY_V, Key::V},
    {GLFW_KEY_W, Key::W},
    {GLFW_KEY_X, Key::X},
    {GLFW_KEY_Y, Key::Y},
    {GLFW_KEY_Z, Key::Z},
});
static_assert(key_names.size() == static_cast<std::size_t>(Key::Count));

std::optional<Key> find_key(int glfw, const char* printed) {
    // Letters count by what is printed on them, whatever the keyboard's layout.
    if (printed && printed[0] >= 'a' && printed[0] <= 'z' && printed[1] == 0) {
        glfw = GLFW_KEY_A + (printed[0] - 'a');
    }
    if ((printed && printed[0] == '+' && printed[1] == 0) || glfw == GLFW_KEY_KP_ADD) {
        glfw = GLFW_KEY_EQUAL;
    }
    if ((printed && printed[0] == '-' && printed[1] == 0) || glfw == GLFW_KEY_KP_SUBTRACT) {
        glfw = GLFW_KEY_MINUS;
    }
    if (glfw == GLFW_KEY_KP_ENTER) glfw = GLFW_KEY_ENTER;
    for (const KeyName& name : key_names) {
        if (name.glfw == glfw) return name.key;
    }
    return std::nullopt;
}

std::string last_glfw_error() {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return reason ? reason : "no reason given";
}

Window& window_of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

std::optional<PadState> find_pad() {
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        GLFWgamepadstate state;
        if (glfwGetGamepadState(joystick, &state) != GLFW_TRUE) continue;
        const float* const axes = state.axes;
        return PadState{axes[GLFW_GAMEPAD_AXIS_LEFT_X], axes[GLFW_GAMEPAD_AXIS_LEFT_Y],
                        axes[GLFW_GAMEPAD_AXIS_RIGHT_X], axes[GLFW_GAMEPAD_AXIS_RIGHT_Y],
                        state.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS};
    }
    return std::nullopt;
}

// Two clicks are one double click within this distance; a mouse that goes further than that while
// its button is down drags.
constexpr double double_click_pixels = 6, drag_pixels = 4;

}  // namespace

Window::Window(const std::string& title, std::uint32_t width, std::uint32_t height) {
    if (glfwInit() != GLFW_TRUE) {
        throw PlatformError(fmt::format("no display ({}); palpa run --headless works without one",
                                        last_glfw_error()));
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(),
                               nullptr, nullptr);
    if (!window_) {
        const std::string reason = last_glfw_error();
        glfwTerminate();
        throw PlatformError(fmt::format("a window cannot be opened ({})", reason));
    }
    glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    listen(window_);
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::listen(GLFWwindow* window) {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scancode, int action, int mods) {
        Input& input = window_of(w).input_;
        input.shift = (mods & GLFW_MOD_SHIFT) != 0;
        const std::optional<Key> key = find_key(code, glfwGetKeyName(code, scancode));
        if (!key) return;
        input.held[static_cast<std::size_t>(*key)] = action != GLFW_RELEASE;
        if (action != GLFW_PRESS) return;
        input.pressed.push_back(
            {*key, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
        Input& input = window_of(w).input_;
        input.shift = (mods & GLFW_MOD_SHIFT) != 0;
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        const auto index = static_cast<std::size_t>(button);  // left, right, middle, as ours
        input.down[index] = action == GLFW_PRESS;
        if (action != GLFW_PRESS) {
            release(window_of(w), button);
            return;
        }
        // Where the cursor was then: by now it may be elsewhere.
        double x = window_of(w).cursor_x_, y = window_of(w).cursor_y_;
        window_of(w).scale_to_pixels(x, y);
        input.clicked.push_back({static_cast<MouseButton>(index), x, y,
                                 (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0});
        if (button != GLFW_MOUSE_BUTTON_MIDDLE) press(window_of(w), button, mods);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        Window& window = window_of(w);
        window.cursor_x_ = x;
        window.cursor_y_ = y;
        if (std::hypot(x - window.last_click_x_, y - window.last_click_y_) > drag_pixels)
            window.is_clicking_ = false;
    });
    glfwSetScrollCallback(
        window, [](GLFWwindow* w, double /*x*/, double y) { window_of(w).input_.wheel += y; });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        window_of(w).input_.dropped.insert(window_of(w).input_.dropped.end(), paths, paths + count);
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int /*width*/, int /*height*/) {
        window_of(w).input_.resized = true;
    });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float /*x*/, float /*y*/) {
        window_of(w).input_.rescaled = true;
    });
    // A key that is let go elsewhere is never reported here.
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        if (focused == GLFW_TRUE) return;
        window_of(w).input_.held.fill(false);
        window_of(w).input_.down.fill(false);
        window_of(w).is_clicking_ = false;
    });
}

void Window::press(Window& window, int button, int mods) {
    const double x = window.cursor_x_, y = window.cursor_y_;
    const bool is_right = button == GLFW_MOUSE_BUTTON_RIGHT;
    const double now = glfwGetTime();
    const double moved = std::hypot(x - window.last_click_x_, y - window.last_click_y_);
    const bool is_second =
        !is_right && now - window.last_click_s_ < double_click_s && moved < double_click_pixels;
    window.input_.double_clicked = window.input_.double_clicked || is_second;
    window.last_click_s_ = is_right ? -1 : now;
    window.last_click_x_ = x;
    window.last_click_y_ = y;
    window.click_ = {x,
                     y,
                     (mods & GLFW_MOD_CONTROL) != 0,
                     (mods & GLFW_MOD_SHIFT) != 0,
                     (mods & GLFW_MOD_ALT) != 0,
                     is_second,
                     is_right};
    window.is_clicking_ = true;
}

void Window::release(Window& window, int button) {
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) return;
    if (window.click_.is_right != (button == GLFW_MOUSE_BUTTON_RIGHT)) return;
    if (!std::exchange(window.is_clicking_, false)) return;
    MouseClick click = window.click_;
    window.scale_to_pixels(click.x, click.y);
    window.input_.clicks.push_back(click);
}

std::vector<const char*> Window::vulkan_extensions() const {
    std::uint32_t count = 0;
    const char* const* const names = glfwGetRequiredInstanceExtensions(&count);
    if (!names) {
        throw PlatformError(fmt::format("Vulkan cannot draw into a window; {}", vulkan_remedy()));
    }
    return {names, names + count};
}

VkSurfaceKHR Window::create_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) {
        throw PlatformError(
            fmt::format("Vulkan cannot draw into the window ({})", last_glfw_error()));
    }
    return surface;
}

void Window::fill_screen() {
    int left = 0, top = 0, width = 0, height = 0;
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    if (!monitor) return;
    glfwGetMonitorWorkarea(monitor, &left, &top, &width, &height);
    if (width <= 0 || height <= 0) return;
    glfwSetWindowSize(window_, width, height);
    glfwMaximizeWindow(window_);  // does nothing without a window manager
}

std::array<int, 2> Window::own_size() const {
    std::array<int, 2> size{};
    glfwGetWindowSize(window_, &size[0], &size[1]);
    return size;
}

void Window::set_own_size(const std::array<int, 2>& size) {
    glfwSetWindowSize(window_, size[0], size[1]);
}

VkExtent2D Window::size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void Window::scale_to_pixels(double& x, double& y) const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    const VkExtent2D pixels = size();
    if (width > 0) x *= static_cast<double>(pixels.width) / width;
    if (height > 0) y *= static_cast<double>(pixels.height) / height;
}

const Input& Window::poll() {
    input_.pressed.clear();
    input_.clicked.clear();
    input_.clicks.clear();
    input_.dropped.clear();
    input_.double_clicked = false;
    input_.wheel = 0;
    input_.resized = input_.rescaled = false;
    glfwPollEvents();
    input_.pad = find_pad();
    input_.focused = glfwGetWindowAttrib(window_, GLFW_FOCUSED) == GLFW_TRUE;
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    scale_to_pixels(x, y);
    input_.mouse_dx = has_mouse_ ? x - input_.mouse_x : 0;
    input_.mouse_dy = has_mouse_ ? y - input_.mouse_y : 0;
    input_.mouse_x = x;
    input_.mouse_y = y;
    has_mouse_ = true;
    return input_;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

bool Window::should_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::keep_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

float Window::content_scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return y > 0 ? y : 1;
}

void Window::capture_cursor(bool is_captured) {
    if (is_captured == is_captured_) return;
    is_captured_ = is_captured;
    glfwSetInputMode(window_, GLFW_CURSOR, is_captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    has_mouse_ = false;                                 // where it jumps to is no move of the hand
    glfwGetCursorPos(window_, &cursor_x_, &cursor_y_);  // a jump is no event
}

}  // namespace palpa
