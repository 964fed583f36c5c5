// Messages on lanes that limit the size of a message.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "objects/wire/messages.hpp"

namespace mural::objects {

// Passes a message of at most `mostBytes` to emit(), and a larger one as consecutive parts. Requires mostBytes >= 16.
void cutMessage(std::span<const std::byte> message, size_t mostBytes,
                const std::function<void(std::span<const std::byte>)>& emit);

// Restores the messages of one lane. The memory grows with the received bytes only.
class MessageJoiner {
public:
    // Returns the message that is complete with these bytes, valid until the next call; empty: further parts follow.
    // Errors: a damaged part, or a message between parts; the begun message is dropped.
    Result<std::optional<std::span<const std::byte>>> input(std::span<const std::byte> message);

private:
    std::vector<std::byte> joined_;
    bool isOpen_ = false;     // further parts follow
    bool isReturned_ = false; // joined_ was returned
};

} // namespace mural::objects
