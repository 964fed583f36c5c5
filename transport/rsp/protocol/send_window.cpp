#include "transport/rsp/protocol/send_window.hpp"

#include <algorithm>
#include <cstring>

namespace mural::rsp {

SendWindow::SendWindow(const StreamShape& shape, Sequence first)
    : payloadBytes_(shape.payloadBytes),
      mask_(shape.windowDatagrams - 1),
      payloads_(std::make_unique_for_overwrite<std::byte[]>(shape.payloadBytes * shape.windowDatagrams)),
      lengths_(shape.windowDatagrams),
      groupBases_(shape.windowDatagrams),
      groupSizes_(shape.windowDatagrams),
      base_(first),
      filled_(first),
      groupBase_(first) {}

size_t SendWindow::roomBytes() const {
    const auto used = static_cast<size_t>(filled_ - base_);
    return (mask_ + 1 - used) * payloadBytes_ - openBytes_;
}

size_t SendWindow::write(std::span<const std::byte> bytes) {
    size_t written = 0;
    while (written < bytes.size() && filled_ - base_ <= mask_) {
        const size_t count = std::min(bytes.size() - written, payloadBytes_ - openBytes_);
        std::memcpy(payloads_.get() + slot(filled_) * payloadBytes_ + openBytes_, bytes.data() + written, count);
        openBytes_ += count;
        written += count;
        if (openBytes_ == payloadBytes_) closeDatagram();
    }
    return written;
}

void SendWindow::closeDatagram() {
    if (groupBase_ == filled_) groupSizes_[slot(filled_)] = 0;
    lengths_[slot(filled_)] = static_cast<uint16_t>(openBytes_);
    groupBases_[slot(filled_)] = groupBase_;
    openBytes_ = 0;
    ++filled_;
    if (filled_ - groupBase_ == kMaxInGroup) closeGroup();
}

void SendWindow::closeGroup() {
    if (groupBase_ == filled_) return;
    groupSizes_[slot(groupBase_)] = static_cast<uint8_t>(filled_ - groupBase_);
    groupBase_ = filled_;
}

void SendWindow::flush() {
    if (openBytes_ != 0) closeDatagram();
    closeGroup();
}

std::span<const std::byte> SendWindow::payload(Sequence s) const {
    return {payloads_.get() + slot(s) * payloadBytes_, lengths_[slot(s)]};
}

SendWindow::Group SendWindow::groupOf(Sequence s) const {
    const Sequence base = groupBases_[slot(s)];
    const uint8_t size = groupSizes_[slot(base)];
    return {base, size, size != 0 ? size : static_cast<uint8_t>(filled_ - base)};
}

SendWindow::Group SendWindow::newestGroup() const {
    if (base_ == filled_) return {filled_, 0, 0};
    return groupOf(filled_ - 1);
}

void SendWindow::release(Sequence until) {
    const Sequence whole = until < filled_ ? groupBases_[slot(until)] : groupBase_;
    base_ = later(base_, whole);
}

} // namespace mural::rsp
