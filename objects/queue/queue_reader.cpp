#include "objects/queue/queue_reader.hpp"

#include <algorithm>

namespace mural::objects {

uint32_t ObjectQueueReader::mark() const {
    if (itemNs_ <= 0 || roundTripNs_ <= 0) return 1;
    return static_cast<uint32_t>(std::clamp(roundTripNs_ / itemNs_ + 1, 1., double{kMaxMark}));
}

void ObjectQueueReader::ask(int64_t nowNs) {
    const auto present = static_cast<uint32_t>(items_.size()) + asked_;
    if (present >= mark() || hasEnded_) return;
    const uint32_t count = mark() - present;
    if (asked_ == 0) askedNs_ = nowNs;
    asked_ += count;
    sender_.toOne(kWriter, AskMessage{queue_, count});
}

void ObjectQueueReader::finish(int64_t nowNs) {
    if (current_ == 0) return;
    average(itemNs_, static_cast<double>(std::max<int64_t>(nowNs - currentNs_, 1)));
    sender_.toOne(kWriter, DoneMessage{queue_, current_});
    current_ = 0;
}

std::optional<ObjectQueueReader::Item> ObjectQueueReader::pop(int64_t nowNs) {
    finish(nowNs);
    while (!items_.empty() && items_.front().frame != 0 && items_.front().frame < oldestFrame_) {
        sender_.toOne(kWriter, DoneMessage{queue_, items_.front().number});
        items_.pop_front();
    }
    std::optional<Item> item;
    if (!items_.empty()) {
        item = std::move(items_.front());
        items_.pop_front();
        current_ = item->number;
        currentNs_ = nowNs;
    }
    ask(nowNs);
    return item;
}

void ObjectQueueReader::input(const ItemMessage& message, int64_t nowNs) {
    if (asked_ > 0) --asked_;
    // A reply to a request that found the queue empty waits for the next item, which is no round trip; a long wait is
    // therefore not counted above the mean.
    if (askedNs_ != 0) {
        const auto trip = static_cast<double>(std::max<int64_t>(nowNs - askedNs_, 1));
        average(roundTripNs_, roundTripNs_ == 0 ? trip : std::min(trip, 4 * roundTripNs_));
        askedNs_ = 0;
    }
    items_.push_back({message.item, message.frame, {message.bytes.begin(), message.bytes.end()}});
}

} // namespace mural::objects
