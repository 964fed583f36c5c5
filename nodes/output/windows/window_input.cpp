#include "nodes/output/windows/window_input.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "nodes/output/windows/wall_screen.hpp"

#include "nodes/output/windows/glfw_x11.hpp" // last: Xlib's macros

#include <X11/XKBlib.h>

namespace mural {

namespace {

using input::InputEvent;
using input::InputKind;

constexpr double kWheelStep = 120;
constexpr int kLastButton = 9;

WindowInput& inputOf(GLFWwindow* window) {
    return *static_cast<WallWindow*>(glfwGetWindowUserPointer(window))->input();
}

// Returns the keysym of a keycode. Shift is that of the event; the layout and further levels are those of now, because
// GLFW does not report them.
uint32_t keysymOfKeycode(int keycode, bool hasShift) {
    Display* display = glfwGetX11Display();
    XkbStateRec state{};
    if (XkbGetState(display, XkbUseCoreKbd, &state) != Success) return 0;
    const unsigned int modifiers = (state.mods & ~unsigned{ShiftMask}) | (hasShift ? ShiftMask : 0);
    unsigned int used = 0;
    KeySym keysym = NoSymbol;
    const bool isFound = XkbLookupKeySym(display, static_cast<KeyCode>(keycode),
                                         XkbBuildCoreState(modifiers, state.group), &used, &keysym) == True;
    return isFound ? static_cast<uint32_t>(keysym) : 0;
}

} // namespace

void WindowInput::place(const OverlayPlace& onWall) {
    width_ = std::max(onWall.wallWidth, 1);
    height_ = std::max(onWall.wallHeight, 1);
    left_ = onWall.part.x;
    top_ = height_ - onWall.part.top();
    setPlace(0, 0); // GLFW reports no move to that pixel before one to another pixel
}

// Takes the centre of the pixel: its border could become the neighbour by rounding.
void WindowInput::setPlace(double x, double y) {
    x_ = std::clamp((left_ + x + 0.5) / width_, 0.0, 1.0);
    y_ = std::clamp((top_ + y + 0.5) / height_, 0.0, 1.0);
}

void WindowInput::moved(double x, double y) {
    setPlace(x, y);
    InputEvent event;
    event.x = x_, event.y = y_;
    event.hasPlace = true;
    send(std::move(event));
}

void WindowInput::pressed(int number, bool isDown) {
    InputEvent event;
    event.kind = isDown ? InputKind::Down : InputKind::Up;
    event.x = x_, event.y = y_;
    event.hasPlace = true;
    event.button = number == GLFW_MOUSE_BUTTON_RIGHT ? 3 : number == GLFW_MOUSE_BUTTON_MIDDLE ? 2 : number + 1;
    if (event.button <= kLastButton) send(std::move(event));
}

void WindowInput::turned(double x, double y) {
    InputEvent event;
    event.kind = InputKind::Wheel;
    event.x = x_, event.y = y_;
    event.hasPlace = true;
    event.wheelX = x * kWheelStep;
    event.wheelY = -y * kWheelStep;
    send(std::move(event));
}

void WindowInput::key(int keycode, uint32_t keysym, bool isDown) {
    InputEvent event;
    event.kind = InputKind::Key;
    event.code = "k" + std::to_string(keycode);
    event.keysym = keysym;
    event.isDown = isDown;
    send(std::move(event));
}

void WindowInput::resized(int width, int height) {
    if (width == expectedWidth_ && height == expectedHeight_) return;
    InputEvent event;
    event.kind = InputKind::Size;
    event.width = width;
    event.height = height;
    send(std::move(event));
}

void WindowInput::lostFocus() {
    InputEvent event;
    event.kind = InputKind::Blur;
    send(std::move(event));
}

void attachInput(GLFWwindow* window, bool isResizable) {
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { inputOf(w).moved(x, y); });
    glfwSetMouseButtonCallback(
        window, [](GLFWwindow* w, int button, int action, int) { inputOf(w).pressed(button, action == GLFW_PRESS); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) { inputOf(w).turned(x, y); });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int, int keycode, int action, int modifiers) {
        if (action == GLFW_REPEAT) return; // the program's X server repeats held keys itself
        const bool hasShift = (modifiers & GLFW_MOD_SHIFT) != 0;
        inputOf(w).key(keycode, keysymOfKeycode(keycode, hasShift), action == GLFW_PRESS);
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int hasFocus) {
        if (hasFocus == GLFW_FALSE) inputOf(w).lostFocus();
    });
    if (!isResizable) return;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    inputOf(window).expectSize(width, height);
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int x, int y) { inputOf(w).resized(x, y); });
}

} // namespace mural
