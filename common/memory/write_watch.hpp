// Tracks written pages without cooperation of the writer. The kernel unlocks a page at its first write (userfaultfd's
// asynchronous write protection, Linux 6.7) and lists unlocked pages on request (PAGEMAP_SCAN). Writes of any thread
// and of system calls count. No signals are involved.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural {

class WriteWatch {
public:
    WriteWatch() = default;
    ~WriteWatch() { end(); }
    WriteWatch(const WriteWatch&) = delete;
    WriteWatch& operator=(const WriteWatch&) = delete;

    // Watches the memory with all pages locked. Returns false where the kernel, a sandbox or the kind of memory (device
    // memory) prevents it.
    bool begin(void* memory, size_t sizeBytes);
    void end();
    [[nodiscard]] bool active() const { return sizeBytes_ > 0; }

    // Calls visit(self, fromByte, endByte), in ascending order, for ranges of unlocked pages, clipped to the watched
    // memory. Returns false if the watch is lost; then anything may have been written.
    using Visit = void (*)(void* self, size_t fromByte, size_t endByte);
    bool unlocked(Visit visit, void* self) const { return scan(0, sizeBytes_, 0, visit, self); }
    // Locks the pages of a range again and visits the unlocked ones. Later writes unlock their pages.
    bool lock(size_t fromByte, size_t endByte, Visit visit, void* self) const;

    static constexpr size_t kPageBytes = 4096;

private:
    bool scan(size_t fromByte, size_t endByte, uint64_t flags, Visit visit, void* self) const;

    uint64_t memory_ = 0;
    size_t sizeBytes_ = 0;
};

} // namespace mural
