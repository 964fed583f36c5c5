// The distributed objects of one application, on a render node.
#pragma once

#include <functional>
#include <span>

#include "common/base/result.hpp"
#include "objects/ends/reader_core.hpp"
#include "streamcodec/wire/object_records.hpp"

namespace mural::native {

class ClientObjects final : private objects::MessageSink {
public:
    // Sends a message to the application. Any thread.
    using Send = std::function<void(std::span<const std::byte> message)>;
    // Receives messages until the deadline, while the player's thread waits for an object. Returns false if none will
    // come.
    using Await = std::function<bool(Deadline)>;
    ClientObjects(uint32_t node, Send send, Await await);

    // Takes the arguments of a kOpObject record. Errors: a damaged message.
    Result<void> input(std::span<const std::byte> arguments);
    // The frame begins: all of its versions have arrived, except those on demand.
    void frame(uint64_t number) { end_.frame(number); }
    // The frame is drawn, and so are all earlier ones.
    void frameDone(uint64_t number) { end_.frameDone(number); }
    [[nodiscard]] ObjectReader& reader() { return end_.reader(); }

private:
    void toAll(std::span<const std::byte>) override {} // readers send to the writer only
    void toOne(objects::PeerId, std::span<const std::byte> message) override { send_(message); }

    const uint32_t node_;
    const Send send_;
    wire::ObjectRecordJoiner joiner_;
    objects::ReaderEnd end_; // uses this sink
};

} // namespace mural::native
