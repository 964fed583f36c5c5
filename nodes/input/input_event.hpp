// An input event for the program: of a viewer of the page, or of a window of a remote wall. Pure.
#pragma once

#include <cstdint>
#include <string>

namespace mural::input {

// Size and Close come from windows of remote walls only.
enum class InputKind : uint8_t { Move, Down, Up, Wheel, Key, Text, Touch, Blur, Size, Close };

struct InputEvent {
    uint32_t number = 0; // of the viewer, increasing
    InputKind kind = InputKind::Move;
    double x = 0, y = 0;           // place in the program's window, 0 to 1, from the upper left corner
    bool hasPlace = false;         // x and y are set
    bool isOfDisplay = false;      // x and y are fractions of the whole display; only from the page
    int button = 1;                // 1: left, 2: middle, 3: right; up to 9
    double wheelX = 0, wheelY = 0; // in 1/120 of a step; positive: right, down
    std::string key;               // KeyboardEvent.key
    std::string code;              // KeyboardEvent.code
    uint32_t keysym = 0;           // of X; 0: `key` and `code` determine it
    bool isDown = false;           // of keys and touches
    std::string text;              // to be typed
    int width = 0, height = 0;     // Size: pixels of the viewer's window
};

} // namespace mural::input
