// The distributed objects, queues and barriers of one application, on a render node.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "objects/ends/barrier_ends.hpp"
#include "objects/ends/queue_ends.hpp"
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
    // `mapsBlobs`: the program is a process of this machine.
    ClientObjects(Send send, const Await& await, bool mapsBlobs = false);

    // Takes the arguments of a kOpObject record. `receivers`: the thread of the program's stream (object_records.hpp).
    // Errors: a damaged message.
    Result<void> input(uint16_t receivers, std::span<const std::byte> arguments);
    // The frame begins: all of its versions have arrived, except those on demand.
    void frame(uint64_t number) { end_.frame(number); }
    // The tasks of a frame begin; rounds of barriers belong to it.
    void beginDrawing(uint64_t number) { drawn_ = number; }
    // The frame is drawn, and so are all earlier ones.
    void frameDone(uint64_t number) { end_.frameDone(number); }
    [[nodiscard]] ObjectReader& reader() { return end_.reader(); }
    std::shared_ptr<AnyQueueReader> queue(std::string_view name) { return queues_.openAny(name); }
    Barrier barrier(std::string_view name) { return barriers_.open(name); }

private:
    void toAll(std::span<const std::byte>) override {} // readers send to the writer only
    void toOne(objects::PeerId, std::span<const std::byte> message) override { send_(message); }

    const Send send_;
    wire::ObjectRecordJoiner toAll_, toThisNode_;
    objects::ReaderEnd end_; // uses this sink, as the following
    objects::QueueLine queues_;
    objects::BarrierLine barriers_;
    uint64_t drawn_ = 0; // frame in progress
};

} // namespace mural::native
