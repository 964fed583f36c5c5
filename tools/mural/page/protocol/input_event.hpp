// An input event of a viewer for the program. Pure.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace mural::page {

enum class InputKind : uint8_t { Move, Down, Up, Wheel, Key, Text, Touch, Blur };

struct InputEvent {
    uint32_t number = 0; // of the viewer, increasing
    InputKind kind = InputKind::Move;
    double x = 0, y = 0;           // place in the program's window, 0 to 1, from the upper left corner
    bool hasPlace = false;         // x and y are set
    int button = 1;                // 1: left, 2: middle, 3: right; up to 9
    double wheelX = 0, wheelY = 0; // in 1/120 of a step; positive: right, down
    std::string key;               // KeyboardEvent.key
    std::string code;              // KeyboardEvent.code
    bool isDown = false;           // of keys and touches
    std::string text;              // to be typed
};

// Checks the member `input` of a message. Returns nullopt for a member that is missing, unknown, or out of range.
[[nodiscard]] std::optional<InputEvent> inputEventOf(const nlohmann::json& input);

} // namespace mural::page
