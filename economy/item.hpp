// What packets are made of here: a short record, or a page of a long one.
#pragma once

#include <cstdint>

namespace mural::economy {

struct Item {
    uint32_t where; // a text: its offset in the ring; a page: its slot in the store
    uint32_t sizeBytes : 31;
    uint32_t page : 1;
    [[nodiscard]] bool like(Item other) const { return page == other.page && sizeBytes == other.sizeBytes; }
};
static_assert(sizeof(Item) == 8);

} // namespace mural::economy
