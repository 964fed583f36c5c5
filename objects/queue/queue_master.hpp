// The writer's side of a queue: gives each item to one reader. A state machine without sockets, clocks and threads.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "common/base/result.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// Readers request items ahead of their use. An item is forgotten after its reader has finished it. Items of a lost
// reader go to others, in their original order.
//
// Thread safety: none.
class ObjectQueueMaster {
public:
    ObjectQueueMaster(MessageSink& sink, uint32_t queue) : sender_(sink), queue_(queue) {}

    // Appends an item. `frame`: the frame that it belongs to, 0 for none. Error: the queue is closed.
    Result<void> push(std::span<const std::byte> item, uint64_t frame = 0);
    // Drops the items that no reader has received.
    void clear();
    // Drops items of frames before `frame` that no reader has received.
    void dropBefore(uint64_t frame);
    // Ends the queue: after its last item is finished, all readers receive Closed.
    void close();

    Result<void> input(PeerId reader, const AskMessage& message);
    Result<void> input(PeerId reader, const DoneMessage& message);
    // The reader is lost or leaves. Its messages must not be passed on afterwards.
    void leave(PeerId reader);

    // Returns the number of items that no reader has received.
    [[nodiscard]] size_t size() const { return waiting_.size(); }
    [[nodiscard]] size_t unfinished() const { return given_.size(); }
    // Whether the queue is closed and all items are finished.
    [[nodiscard]] bool hasEnded() const { return isClosed_ && waiting_.empty() && given_.empty(); }

private:
    struct Item {
        uint64_t frame = 0;
        std::vector<std::byte> bytes;
    };
    struct Given {
        PeerId reader = 0;
        Item item;
    };
    void serve();

    static constexpr uint32_t kMaxAsked = 1024; // per reader

    MessageSender sender_;
    const uint32_t queue_;
    std::map<uint64_t, Item> waiting_; // by number
    std::map<uint64_t, Given> given_;
    std::map<PeerId, uint32_t> asked_; // items that readers still expect
    std::deque<PeerId> turns_;         // readers in the order of their requests
    std::set<PeerId> informed_;        // readers that know the end
    uint64_t next_ = 1;
    bool isClosed_ = false;
};

} // namespace mural::objects
