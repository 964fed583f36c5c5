// Which pages of a piece of memory were written, seen without the writer doing anything: the kernel
// unlocks a page at its first write (userfaultfd's asynchronous write protection, Linux 6.7) and lists
// unlocked pages when asked (PAGEMAP_SCAN). Writes of any thread and of system calls count; no signal.
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

    // Watches the memory, all pages locked. False where the kernel or the kind of memory can't: device
    // memory, an old kernel, a sandbox.
    bool begin(void* memory, size_t sizeBytes);
    void end();
    [[nodiscard]] bool active() const { return sizeBytes_ > 0; }

    // Calls visit(self, fromByte, endByte), in ascending order, for ranges of unlocked pages, cut to the
    // memory that is watched. False: the watch is lost, anything may have been written.
    using Visit = void (*)(void* self, size_t fromByte, size_t endByte);
    bool unlocked(Visit visit, void* self) const { return scan(0, sizeBytes_, 0, visit, self); }
    // Locks the pages of a range again, and visits those that were not: what is written into them from
    // then on unlocks them.
    bool lock(size_t fromByte, size_t endByte, Visit visit, void* self) const;

    static constexpr size_t kPageBytes = 4096;

private:
    bool scan(size_t fromByte, size_t endByte, uint64_t flags, Visit visit, void* self) const;

    uint64_t memory_ = 0;
    size_t sizeBytes_ = 0;
};

} // namespace mural
