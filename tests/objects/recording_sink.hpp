// A sink that keeps its messages.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "objects/core/message_sink.hpp"

namespace mural::objects::test {

class RecordingSink : public MessageSink {
public:
    struct Sent {
        std::optional<PeerId> to; // empty: all
        std::vector<std::byte> bytes;
    };
    void toAll(std::span<const std::byte> message) override { sent.push_back({{}, {message.begin(), message.end()}}); }
    void toOne(PeerId peer, std::span<const std::byte> message) override {
        sent.push_back({peer, {message.begin(), message.end()}});
    }
    std::vector<Sent> take() { return std::exchange(sent, {}); }

    // Returns the kinds of the kept messages.
    [[nodiscard]] std::vector<MessageKind> kinds() const {
        std::vector<MessageKind> kinds;
        for (const Sent& one : sent) kinds.push_back(static_cast<MessageKind>(one.bytes.front()));
        return kinds;
    }

    std::vector<Sent> sent;
};

} // namespace mural::objects::test
