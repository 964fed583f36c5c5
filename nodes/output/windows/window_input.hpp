// Events of a wall window for the program whose picture it shows. Used by the windows' thread.
#pragma once

#include <functional>

#include "nodes/input/input_event.hpp"
#include "nodes/overlay/overlay.hpp"

struct GLFWwindow;

namespace mural {

class WindowInput {
public:
    using OnInput = std::function<void(const input::InputEvent& event)>;
    // onWall: the window's part of the wall, and the wall's size.
    WindowInput(OnInput onInput, const OverlayPlace& onWall) : onInput_(std::move(onInput)) { place(onWall); }

    void place(const OverlayPlace& onWall);
    // The window gets this size on request of Mural, not of the user.
    void expectSize(int width, int height) { expectedWidth_ = width, expectedHeight_ = height; }

    // x, y: pixels of the window from its upper left corner.
    void moved(double x, double y);
    void pressed(int number, bool isDown); // of GLFW's buttons
    void turned(double x, double y);       // steps of the wheel; positive: right, up
    void key(int keycode, uint32_t keysym, bool isDown);
    void resized(int width, int height);
    void lostFocus();

private:
    void setPlace(double x, double y);
    void send(input::InputEvent event) const { onInput_(event); }

    const OnInput onInput_;
    double left_ = 0, top_ = 0, width_ = 1, height_ = 1; // of the window and the wall, in pixels
    double x_ = 0, y_ = 0;                               // place of the pointer on the wall, as fractions
    int expectedWidth_ = 0, expectedHeight_ = 0;
};

// Sets the callbacks of a window whose user pointer is a WallWindow with input(). isResizable: by the user.
void attachInput(GLFWwindow* window, bool isResizable);

} // namespace mural
