#include "objects/queue/queue_master.hpp"

#include <algorithm>

namespace mural::objects {

Result<void> ObjectQueueMaster::push(std::span<const std::byte> item, uint64_t frame) {
    if (isClosed_) return Error{"cannot add to queue " + std::to_string(queue_) + ": it is closed; make a new queue"};
    waiting_.emplace(next_++, Item{frame, {item.begin(), item.end()}});
    serve();
    return {};
}

void ObjectQueueMaster::clear() {
    waiting_.clear();
    serve();
}

void ObjectQueueMaster::dropBefore(uint64_t frame) {
    std::erase_if(waiting_, [&](const auto& entry) { return entry.second.frame != 0 && entry.second.frame < frame; });
    serve();
}

void ObjectQueueMaster::close() {
    isClosed_ = true;
    serve();
}

Result<void> ObjectQueueMaster::input(PeerId reader, const AskMessage& message) {
    uint32_t& asked = asked_[reader];
    if (message.count > kMaxAsked - std::min(asked, kMaxAsked))
        return Error{"reader " + std::to_string(reader) + " requests " + std::to_string(message.count) +
                     " items of queue " + std::to_string(queue_) + "; at most " + std::to_string(kMaxAsked) +
                     " are allowed"};
    asked += message.count;
    if (std::ranges::find(turns_, reader) == turns_.end()) turns_.push_back(reader);
    serve();
    return {};
}

Result<void> ObjectQueueMaster::input(PeerId reader, const DoneMessage& message) {
    const auto found = given_.find(message.item);
    if (found == given_.end() || found->second.reader != reader)
        return Error{"reader " + std::to_string(reader) + " reports item " + std::to_string(message.item) +
                     " of queue " + std::to_string(queue_) + ", which it does not have; the report is ignored"};
    given_.erase(found);
    serve();
    return {};
}

void ObjectQueueMaster::leave(PeerId reader) {
    asked_.erase(reader);
    informed_.erase(reader);
    std::erase(turns_, reader);
    for (auto at = given_.begin(); at != given_.end();) {
        if (at->second.reader != reader) {
            ++at;
            continue;
        }
        waiting_.emplace(at->first, std::move(at->second.item));
        at = given_.erase(at);
    }
    serve();
}

// Gives the oldest items in turns, one item per reader, so a large prefetch of one reader does not starve the others.
void ObjectQueueMaster::serve() {
    while (!waiting_.empty() && !turns_.empty()) {
        const PeerId reader = turns_.front();
        turns_.pop_front();
        uint32_t& asked = asked_[reader];
        if (asked == 0) continue;
        if (--asked > 0) turns_.push_back(reader);
        const auto first = waiting_.begin();
        sender_.toOne(reader, ItemMessage{queue_, first->first, first->second.frame, first->second.bytes});
        given_.emplace(first->first, Given{reader, std::move(first->second)});
        waiting_.erase(first);
    }
    if (!hasEnded()) return;
    for (const auto& [reader, asked] : asked_)
        if (informed_.insert(reader).second) sender_.toOne(reader, ClosedMessage{queue_});
}

} // namespace mural::objects
