#include "economy/page_store.hpp"

#include <cstring>

namespace mural::economy {

PageStore::PageStore(uint64_t sizeBytes) : capacity_(static_cast<uint32_t>(sizeBytes / kPageBytes)), bytes_(LargeArray<std::byte>::tryMake(size_t{capacity_} * kPageBytes)) {}

uint32_t PageStore::take() {
    if (sizes_.size() < capacity_) {
        sizes_.push_back(0);
        used_.push_back(0);
        changes_.push_back(0);
        return static_cast<uint32_t>(sizes_.size() - 1);
    }
    const auto next = [this](uint32_t slot) { return slot + 1 == capacity_ ? 0 : slot + 1; };
    for (; used_[hand_]; hand_ = next(hand_)) used_[hand_] = 0;
    const uint32_t slot = hand_;
    hand_ = next(hand_);
    changes_[slot] = 0;
    return slot;
}

uint32_t PageStore::changed(uint32_t slot) {
    if (changesInPlace(slot)) {
        used_[slot] = 1;
        return slot;
    }
    const uint8_t changes = changes_[slot];
    const uint32_t fresh = take();
    changes_[fresh] = static_cast<uint8_t>(changes + 1);
    return fresh;
}

void PageStore::fill(uint32_t slot, std::span<const std::byte> page) {
    std::memmove(bytes_.data() + size_t{slot} * kPageBytes, page.data(), page.size());
    sizes_[slot] = static_cast<uint16_t>(page.size());
}

} // namespace mural::economy
