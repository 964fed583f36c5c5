// A dictionary entry: a short record, or a page of a long one.
#pragma once

#include <cstdint>

namespace mural::delta {

struct DictionaryEntry {
    static constexpr uint32_t kMaxModels = 1u << 18;

    uint32_t where = 0; // short record: offset in the ring; page: slot in the store
    uint32_t sizeBytes : 13 = 0;
    uint32_t page : 1 = 0;
    uint32_t model : 18 = 0; // predictor state of its words (streamcodec/delta/entropy/predictor_state.hpp); 0: none
    [[nodiscard]] bool like(DictionaryEntry other) const { return page == other.page && sizeBytes == other.sizeBytes; }
};
static_assert(sizeof(DictionaryEntry) == 8);

} // namespace mural::delta
