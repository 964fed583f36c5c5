// Memory between two pages that notice any access: proves how far GL reads and writes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::sizes {

// Pages of memory with guards before and behind. An access to a guard is noted and then let through
// (the guard opens), so GL goes on and keeps its state; close() puts the guards up again.
// One at a time, used by one thread; accesses from other threads (of the driver) count too.
class GuardedMemory {
public:
    explicit GuardedMemory(size_t size);
    ~GuardedMemory();
    GuardedMemory(const GuardedMemory&) = delete;
    GuardedMemory& operator=(const GuardedMemory&) = delete;

    uint8_t* begin() { return begin_; }
    uint8_t* end() { return begin_ + size_; }
    [[nodiscard]] size_t size() const { return size_; }

    // True when a guard was touched since the last close().
    [[nodiscard]] bool touched() const;
    void close();

private:
    uint8_t* map_ = nullptr; // guard, memory, guard
    uint8_t* begin_ = nullptr;
    size_t size_ = 0;
};

} // namespace mural::sizes
