// The most recent entries of one stream, in order, and the cursor: the entry expected next, because it followed the
// last one before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "streamcodec/delta/dictionary/dictionary_entry.hpp"
#include "streamcodec/delta/dictionary/large_array.hpp"

namespace mural::delta {

class EntryLog {
public:
    explicit EntryLog(uint32_t capacity) : mask_(capacity - 1), items_(LargeArray<DictionaryEntry>::make(capacity)) {}

    void append(DictionaryEntry item) { items_[end_++ & mask_] = item; }
    // Appends copies of entries from `from` on. Requires that the log holds all of them.
    void appendCopies(uint64_t from, size_t count) {
        while (count > 0) {
            const size_t source = from & mask_, target = end_ & mask_,
                         part = std::min({count, size_t{mask_} + 1 - source, size_t{mask_} + 1 - target});
            std::memmove(static_cast<void*>(items_.data() + target), items_.data() + source,
                         part * sizeof(DictionaryEntry));
            from += part, end_ += part, count -= part;
        }
    }
    // A sent entry replaces the expected one if their sizes are equal; the expected one is then no longer expected.
    void replaces(DictionaryEntry item) {
        if (contains(cursor) && at(cursor).like(item)) ++cursor;
    }
    [[nodiscard]] bool contains(uint64_t position) const {
        return position < end_ && end_ - position <= uint64_t{mask_} + 1;
    }
    [[nodiscard]] DictionaryEntry at(uint64_t position) const { return items_[position & mask_]; }
    [[nodiscard]] uint64_t end() const { return end_; }

    uint64_t cursor = 0;

private:
    const uint32_t mask_;
    LargeArray<DictionaryEntry> items_;
    uint64_t end_ = 0;
};

} // namespace mural::delta
