#include "streamcodec/delta/dictionary/page_store.hpp"

#include <cstring>

namespace mural::delta {

namespace {
constexpr size_t kReadyBytes = size_t{8} << 20; // most programs load no more before their first frame
}

PageStore::PageStore(uint64_t sizeBytes)
    : capacity_(static_cast<uint32_t>(sizeBytes / kPageBytes)),
      bytes_(LargeArray<std::byte>::tryMake(size_t{capacity_} * kPageBytes, kReadyBytes)) {}

uint32_t PageStore::take() {
    if (slots_.size() < capacity_) {
        slots_.emplace_back();
        return static_cast<uint32_t>(slots_.size() - 1);
    }
    const auto next = [this](uint32_t slot) { return slot + 1 == capacity_ ? 0 : slot + 1; };
    for (; slots_[hand_].used; hand_ = next(hand_)) slots_[hand_].used = false;
    const uint32_t slot = hand_;
    hand_ = next(hand_);
    begin(slot);
    return slot;
}

uint32_t PageStore::changed(uint32_t slot) {
    if (changesInPlace(slot)) {
        slots_[slot].used = true;
        return slot;
    }
    slots_[slot].left = true;
    const uint8_t changes = slots_[slot].changes;
    const uint32_t fresh = take();
    slots_[fresh].changes = static_cast<uint8_t>(changes + 1);
    return fresh;
}

void PageStore::fill(uint32_t slot, std::span<const std::byte> page) {
    std::memmove(bytes_.data() + size_t{slot} * kPageBytes, page.data(), page.size());
    slots_[slot].sizeBytes = static_cast<uint16_t>(page.size());
}

} // namespace mural::delta
