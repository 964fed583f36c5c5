// Sends input to an X display with XTEST. Blocks while the X server does not answer, so it has a thread of its own
// (program_input.hpp). Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <xcb/xcb.h>

#include "common/base/result.hpp"
#include "nodes/input/keyboard_map.hpp"
#include "nodes/input/program_display.hpp"
#include "nodes/input/x_display.hpp"
#include "nodes/input/input_event.hpp"

namespace mural::input {

class DisplayInput {
public:
    // Errors: the display cannot be opened, or has no XTEST.
    static Result<std::unique_ptr<DisplayInput>> open(const ProgramDisplay& display);
    DisplayInput(const DisplayInput&) = delete;
    DisplayInput& operator=(const DisplayInput&) = delete;
    ~DisplayInput();

    // On a display of the user, presses and keys for other programs are dropped.
    void send(const InputEvent& event);
    // Returns why the latest press or key was dropped; empty: it was not.
    [[nodiscard]] const std::string& refusal() const { return refusal_; }
    // Releases all held keys and buttons.
    void releaseAll();
    [[nodiscard]] bool holdsButtons() const { return !buttons_.empty(); }
    [[nodiscard]] bool isLost() const;
    // Descriptor of the connection, whose shutdown ends a blocked call.
    [[nodiscard]] int fd() const;

private:
    DisplayInput(XConnection connection, const ProgramDisplay& display);
    bool readKeyboard();
    [[nodiscard]] bool reachesProgram(const InputEvent& event);
    [[nodiscard]] bool isOfProgram(xcb_window_t window) const;
    [[nodiscard]] bool isBelowPointer();
    [[nodiscard]] bool hasFocus();
    void fake(uint8_t type, uint8_t detail, int x = 0, int y = 0);
    void moveTo(const InputEvent& event);
    bool placeWindow();
    void button(uint8_t number, bool isDown);
    void wheel(double& sum, double add, uint8_t less, uint8_t more);
    void key(const InputEvent& event);
    void resize(int width, int height);
    void close();
    xcb_atom_t atomOf(std::string_view name);
    void type(const std::string& text);
    KeyPlace placeOf(Keysym keysym);
    void tap(Keysym keysym);
    // Sets Shift and the third level for the next key. Returns the keys to restore, in order: keycode, and whether it
    // was down.
    std::vector<std::pair<uint8_t, bool>> setLevel(KeyLevel level);
    void restore(const std::vector<std::pair<uint8_t, bool>>& keys);
    [[nodiscard]] bool isHeld(Keysym keysym) const;

    XConnection connection_;
    const xcb_window_t root_;
    xcb_window_t window_; // of the program; 0: the largest one
    const bool isGiven_, isPrivate_;
    std::string refusal_;
    int left_ = 0, top_ = 0, width_ = 0, height_ = 0; // of the window, on the root
    int64_t placedNs_ = 0;
    KeyboardMap map_;
    std::vector<uint8_t> free_; // keycodes for characters that the layout lacks, least recently used first
    std::map<std::string, std::pair<uint8_t, Keysym>> held_; // by KeyboardEvent.code
    std::set<uint8_t> buttons_;
    double wheelX_ = 0, wheelY_ = 0; // in 1/120 of a step
};

} // namespace mural::input
