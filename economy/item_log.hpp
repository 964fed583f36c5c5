// The last items of one stream, in order, and the cursor: the item that should come next, as it came after the last one
// before.
#pragma once

#include <cstdint>
#include <memory>

#include "economy/item.hpp"

namespace mural::economy {

class ItemLog {
public:
    explicit ItemLog(uint32_t capacity) : mask_(capacity - 1), items_(std::make_unique_for_overwrite<Item[]>(capacity)) {}

    void append(Item item) { items_[end_++ & mask_] = item; }
    // An item that was sent takes the place of the expected one, if it has its size: then that does not come any more.
    void replaces(Item item) {
        if (holds(cursor) && at(cursor).like(item)) ++cursor;
    }
    [[nodiscard]] bool holds(uint64_t position) const { return position < end_ && end_ - position <= uint64_t{mask_} + 1; }
    [[nodiscard]] Item at(uint64_t position) const { return items_[position & mask_]; }
    [[nodiscard]] uint64_t end() const { return end_; }

    uint64_t cursor = 0;

private:
    const uint32_t mask_;
    std::unique_ptr<Item[]> items_;
    uint64_t end_ = 0;
};

} // namespace mural::economy
