#include "nodes/remote_wall/frame_assembly.hpp"

#include <iterator>
#include <utility>

namespace mural::remote {

Result<FrameAssembly::Frame*> FrameAssembly::frameOf(uint32_t source, uint64_t number, const PictureSize& size) {
    if (source >= ended_.size()) return Error{"it sent tiles as an unknown source"};
    if (number <= ended_[source]) return Error{"it sent a frame out of order"};
    if (number <= dropped_) return static_cast<Frame*>(nullptr);
    const auto [entry, isNew] = frames_.try_emplace(number);
    Frame& frame = entry->second;
    if (isNew) {
        frame.content.number = number;
        frame.content.size = size;
        frame.counts.resize(ended_.size());
        frame.missing = ended_.size();
        if (frames_.size() > kMaxIncomplete) {
            const bool isOldest = frames_.begin()->first == number;
            dropBefore(std::next(frames_.begin())->first);
            if (isOldest) return static_cast<Frame*>(nullptr);
        }
    }
    if (frame.content.size != size) return Error{"its sources sent one frame with different sizes"};
    return &frame;
}

Result<void> FrameAssembly::add(uint32_t source, const Tile& tile) {
    auto found = frameOf(source, tile.frame, tile.size);
    if (!found) return found.error();
    Frame* const frame = *found;
    if (!frame) return {};
    frame->pixels += tile.area.area();
    if (frame->pixels > tile.size.pixels()) return Error{"it sent more tiles than its picture has"};
    ++frame->counts[source];
    frame->content.tiles.push_back({tile.eye, tile.area, tile.codec, {tile.bytes.begin(), tile.bytes.end()}});
    return {};
}

Result<void> FrameAssembly::end(uint32_t source, const FrameEnd& end) {
    auto found = frameOf(source, end.frame, end.size);
    if (!found) return found.error();
    ended_[source] = end.frame;
    Frame* const frame = *found;
    if (!frame) return {};
    if (frame->counts[source] != end.tiles) return Error{"it ended a frame with another number of tiles"};
    frame->isWhole = frame->isWhole && end.isWhole;
    frame->content.wallFrame = end.wallFrame;
    if (--frame->missing > 0) return {};
    // Sources send frames in order, so an earlier frame that is incomplete stays so.
    dropBefore(end.frame);
    if (frame->isWhole) needsWhole_ = hasLoss_ = false;
    if (!needsWhole_) complete_.push_back(std::move(frame->content));
    frames_.erase(end.frame);
    dropped_ = end.frame;
    return {};
}

// Drops the incomplete frames before this one.
void FrameAssembly::dropBefore(uint64_t number) {
    while (!frames_.empty() && frames_.begin()->first < number) {
        dropped_ = frames_.begin()->first;
        hasLoss_ = hasLoss_ || !needsWhole_;
        needsWhole_ = true;
        frames_.erase(frames_.begin());
    }
}

std::vector<CompleteFrame> FrameAssembly::takeComplete() { return std::exchange(complete_, {}); }

bool FrameAssembly::takeLoss() { return std::exchange(hasLoss_, false); }

} // namespace mural::remote
