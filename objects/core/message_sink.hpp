// Where the state machines of this folder send their messages.
#pragma once

#include <cstdint>
#include <span>

#include "objects/wire/messages.hpp"

namespace mural::objects {

// A process at the other end, by a number that the caller assigns.
using PeerId = uint32_t;

// Receives messages during a call of a state machine. Must not call the state machine back.
class MessageSink {
public:
    virtual ~MessageSink() = default;
    // Sends to all readers, in the same order to each.
    virtual void toAll(std::span<const std::byte> message) = 0;
    // Sends to one peer.
    virtual void toOne(PeerId peer, std::span<const std::byte> message) = 0;
};

// Encodes messages into a buffer that is used again.
class MessageSender {
public:
    explicit MessageSender(MessageSink& sink) : sink_(sink) {}
    void toAll(const Message& message) { sink_.toAll(encoded(message)); }
    void toOne(PeerId peer, const Message& message) { sink_.toOne(peer, encoded(message)); }

private:
    std::span<const std::byte> encoded(const Message& message) {
        buffer_.clear();
        encodeInto(buffer_, message);
        return buffer_.bytes();
    }
    MessageSink& sink_;
    archive::ByteBuffer buffer_;
};

} // namespace mural::objects
