// Input events in the messages of viewers. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "nodes/input/input_event.hpp"

namespace mural::page {

// Checks the member `input` of a message. Returns nullopt for a member that is missing, unknown, or out of range.
[[nodiscard]] std::optional<input::InputEvent> inputEventOf(const nlohmann::json& input);

} // namespace mural::page
