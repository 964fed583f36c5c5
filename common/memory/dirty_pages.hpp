// Detects changes in memory that a program writes at any time, such as a persistent mapping. Small memory, and memory
// that the kernel cannot watch, is compared with a copy. In other memory only recently written pages are compared. A
// page without changes for some time is locked (WriteWatch); its next write costs a fault, as much as about 20
// comparisons (docs/decisions/0005).
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/memory/write_watch.hpp"

namespace mural {

class DirtyPages {
public:
    ~DirtyPages() { end(); }
    // Starts change detection. Returns false if there is no memory for the copy. mayWatch: the memory has no other
    // mapping with write access.
    bool begin(void* memory, size_t sizeBytes, bool mayWatch = true);
    void end();
    [[nodiscard]] bool active() const { return memory_ != nullptr; }
    [[nodiscard]] bool watched() const { return watch_.active(); }

    // Calls changed(self, fromByte, bytes, sizeBytes) for differences since the last call. `bytes` stays stable while
    // the program writes. `exact` excludes unchanged words of 4 bytes, because other writers (the nodes) may change
    // them.
    using Changed = void (*)(void* self, size_t fromByte, const std::byte* bytes, size_t sizeBytes);
    void collect(bool exact, Changed changed, void* self);
    // Stores bytes that another writer has put into the memory. Calls `changed` for words of `bytes` that differ from
    // the copy. They do not count as changes afterwards.
    void accept(size_t fromByte, const std::byte* bytes, size_t sizeBytes, Changed changed, void* self);

private:
    struct Pass;
    void comparePages(Pass& pass, size_t fromByte, size_t endByte);
    bool compare(const Pass& pass, const std::byte* with, size_t fromByte, size_t endByte);
    void lockQuiet(Pass& pass);

    std::byte* memory_ = nullptr;
    std::byte* known_ = nullptr; // the copy
    uint8_t* quiet_ = nullptr;   // per page: number of calls without a change
    size_t sizeBytes_ = 0, reservedBytes_ = 0;
    WriteWatch watch_;
};

} // namespace mural
