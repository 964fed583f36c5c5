// What changes in a piece of memory that a program writes at any time. Small memory, and memory that
// the kernel can't watch, is compared with a copy as a whole. In other memory only pages that were
// written lately are: a page that stays as it is for a while is locked (WriteWatch), which costs its
// next write a fault, some 20 comparisons' worth. Measured in docs/decisions/0005.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/write_watch.hpp"

namespace mural {

class MapChanges {
public:
    ~MapChanges() { end(); }
    // From now on. False: no memory for the copy. mayWatch: no one else can write the memory by another address.
    bool begin(void* memory, size_t sizeBytes, bool mayWatch = true);
    void end();
    [[nodiscard]] bool active() const { return memory_ != nullptr; }
    [[nodiscard]] bool watched() const { return watch_.active(); }

    // Calls changed(self, fromByte, bytes, sizeBytes) for what differs from the last call. `bytes` stays as
    // it is while the program writes on. exact: words of 4 bytes that did not change are never in it,
    // since others write to them.
    using Changed = void (*)(void* self, size_t fromByte, const std::byte* bytes, size_t sizeBytes);
    void collect(bool exact, Changed changed, void* self);
    // Others have made the memory there hold these bytes: calls changed for words where that is news, of
    // `bytes`. They are no changes then.
    void accept(size_t fromByte, const std::byte* bytes, size_t sizeBytes, Changed changed, void* self);

private:
    struct Pass;
    void comparePages(Pass& pass, size_t fromByte, size_t endByte);
    bool compare(const Pass& pass, const std::byte* with, size_t fromByte, size_t endByte);
    void lockQuiet(Pass& pass);

    std::byte* memory_ = nullptr;
    std::byte* known_ = nullptr; // the copy
    uint8_t* quiet_ = nullptr;   // of each page: for how many calls it has not changed
    size_t sizeBytes_ = 0, reservedBytes_ = 0;
    WriteWatch watch_;
};

} // namespace mural
