// One version of an object as encoded slots. Versions share the slots that did not change between them.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "objects/wire/messages.hpp"

namespace mural::objects {

// A blob that a slot refers to. `blob` is set once, before the state is given to readers.
struct BlobEntry {
    BlobRef ref;
    Blob blob; // empty until isHere
    bool isHere = false;
};

// Immutable, except for blobs that have not arrived.
struct Slot {
    std::vector<std::byte> bytes;
    std::vector<std::shared_ptr<BlobEntry>> blobs;
};

struct ObjectState {
    Version version = 0;
    std::vector<std::shared_ptr<const Slot>> slots;

    [[nodiscard]] uint64_t sizeBytes() const {
        uint64_t sum = 0;
        for (const auto& slot : slots) sum += slot ? slot->bytes.size() : 0;
        return sum;
    }
    // True if every blob of every slot has arrived.
    [[nodiscard]] bool isComplete() const {
        for (const auto& slot : slots)
            for (const auto& entry : slot->blobs)
                if (!entry->isHere) return false;
        return true;
    }
};
using StatePointer = std::shared_ptr<const ObjectState>;

// Returns the bits of all slots of an object.
[[nodiscard]] constexpr uint64_t allSlots(uint32_t slotCount) {
    return slotCount >= 64 ? UINT64_MAX : (uint64_t{1} << slotCount) - 1;
}

} // namespace mural::objects
