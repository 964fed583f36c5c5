// Finds pages of the store by hash. Encoder only.
#pragma once

#include <cstdint>
#include <vector>

namespace mural::delta {

class PageIndex {
public:
    PageIndex() : heads_(kFirstHeads, kNone) {}

    // Calls `is(slot)` for each page with this hash until it returns true. Returns kNone if none does.
    template <class Is> [[nodiscard]] uint32_t find(uint64_t hash, Is&& is) const {
        for (uint32_t slot = heads_[hash & (heads_.size() - 1)]; slot != kNone; slot = pages_[slot].next)
            if (pages_[slot].hash == hash && is(slot)) return slot;
        return kNone;
    }
    // Removes the slot: its page is not found by hash.
    void forget(uint32_t slot) {
        if (slot < pages_.size()) remove(slot);
    }
    // Sets the hash of the slot's new page.
    void set(uint32_t slot, uint64_t hash) {
        if (slot < pages_.size())
            remove(slot);
        else {
            pages_.resize(slot + 1);
            if (pages_.size() > heads_.size()) grow();
        }
        pages_[slot].hash = hash;
        insert(slot);
    }

    static constexpr uint32_t kNone = UINT32_MAX;

private:
    static constexpr size_t kFirstHeads = 1024;
    struct Page {
        uint64_t hash = 0;
        uint32_t next = kNone;
        bool known = false;
    };

    void insert(uint32_t slot) {
        uint32_t& head = heads_[pages_[slot].hash & (heads_.size() - 1)];
        pages_[slot].next = head;
        pages_[slot].known = true;
        head = slot;
    }
    void remove(uint32_t slot) {
        if (!pages_[slot].known) return;
        uint32_t* link = &heads_[pages_[slot].hash & (heads_.size() - 1)];
        while (*link != slot) link = &pages_[*link].next;
        *link = pages_[slot].next;
        pages_[slot].known = false;
    }
    void grow() {
        heads_.assign(heads_.size() * 4, kNone);
        for (uint32_t slot = 0; slot < pages_.size(); ++slot)
            if (pages_[slot].known) insert(slot);
    }

    std::vector<uint32_t> heads_; // size is a power of two
    std::vector<Page> pages_;     // by slot
};

} // namespace mural::delta
