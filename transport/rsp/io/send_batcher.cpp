#include "transport/rsp/io/send_batcher.hpp"

#include <algorithm>

namespace mural::rsp {

void SendBatcher::useKeys(const SessionKeys& keys, MemberId self) {
    sealer_ = std::make_unique<DatagramSealer>(keys, self);
    tagBytes_ = tagBytes(keys.seal);
}

const SocketAddress* SendBatcher::addressOf(MemberId id) const {
    if (id == kEverybody) return &group_;
    const auto found = members_.find(id);
    return found == members_.end() ? nullptr : &found->second;
}

void SendBatcher::seal() {
    if (openBytes_ == 0) return;
    if (sealer_) sealer_->seal(std::span(bytes_).subspan(used_, openBytes_));
    used_ += std::exchange(openBytes_, 0);
    ++count_;
}

std::span<std::byte> SendBatcher::datagram(MemberId to, size_t bytes) {
    seal();
    const size_t whole = bytes + tagBytes_;
    // All datagrams of a batch have one size; the last may be shorter.
    const bool joins = count_ > 0 && to == to_ && whole <= segmentBytes_ && used_ == count_ * segmentBytes_ &&
                       count_ < maxInSend(segmentBytes_);
    if (!joins) {
        flush();
        to_ = to;
        segmentBytes_ = whole;
    }
    openBytes_ = whole;
    const auto room = std::span(bytes_).subspan(used_, bytes);
    std::ranges::fill(room.first(std::min(bytes, kHeaderBytes)), std::byte{0});
    return room;
}

void SendBatcher::flush() {
    seal();
    if (count_ == 0) return;
    const SocketAddress* to = addressOf(to_);
    if (sealer_ && to && to->sizeBytes != 0) {
        if (auto sent = socket_.send(*to, std::span(bytes_).first(used_), segmentBytes_); !sent)
            error_ = sent.error().message;
        datagrams_ += count_;
        ++sendings_;
    }
    used_ = count_ = 0;
}

} // namespace mural::rsp
