// The encoding of input events in messages: of nodes to the head, and of remote walls to a session. Pure.
// Layout: docs/reference/remote-walls.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/input/input_event.hpp"
#include "objects/wire/message_bytes.hpp"

namespace mural::input {

inline constexpr size_t kMaxEventBytes = 8192;

// Texts above the limits are cut.
void putEvent(objects::MessageWriter& out, const InputEvent& event);
// Accepts arbitrary bytes. An invalid event fails the reader.
InputEvent readEvent(objects::MessageReader& in);

// The same for a message that has nothing else.
[[nodiscard]] std::vector<std::byte> bytesOfEvent(const InputEvent& event);
[[nodiscard]] Result<InputEvent> eventOfBytes(std::span<const std::byte> bytes);

} // namespace mural::input
