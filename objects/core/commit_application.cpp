#include "objects/core/commit_application.hpp"

namespace mural::objects {

StatePointer stateAfter(const CommitMessage& message, const ObjectState* base, uint32_t slotCount,
                        const std::function<std::shared_ptr<BlobEntry>(const BlobRef&)>& entryFor) {
    const uint64_t all = allSlots(slotCount);
    if ((message.slots & ~all) != 0 || (!base && message.slots != all)) return nullptr;
    auto state = std::make_shared<ObjectState>();
    state->version = message.version;
    if (base) state->slots = base->slots;
    state->slots.resize(slotCount);
    size_t next = 0;
    for (uint32_t i = 0; i < slotCount; ++i) {
        if ((message.slots >> i & 1) == 0) continue;
        const SlotValue& value = message.values[next++];
        auto slot = std::make_shared<Slot>();
        slot->bytes.assign(value.bytes.begin(), value.bytes.end());
        for (const BlobRef& ref : value.blobs) slot->blobs.push_back(entryFor(ref));
        state->slots[i] = std::move(slot);
    }
    return state;
}

} // namespace mural::objects
