// Memory between two guard pages, which shows how far GL reads and writes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::sizes {

// Pages with guards before and after. An access to a guard is recorded and then permitted (the guard opens), so GL
// continues and keeps its state; close() restores the guards. One instance at a time, used by one thread; accesses of
// the driver's threads count too.
class GuardedMemory {
public:
    explicit GuardedMemory(size_t size);
    ~GuardedMemory();
    GuardedMemory(const GuardedMemory&) = delete;
    GuardedMemory& operator=(const GuardedMemory&) = delete;

    uint8_t* begin() { return begin_; }
    uint8_t* end() { return begin_ + size_; }
    [[nodiscard]] size_t size() const { return size_; }

    // True if a guard was accessed since the last close().
    [[nodiscard]] bool touched() const;
    void close();

private:
    uint8_t* map_ = nullptr; // guard, memory, guard
    uint8_t* begin_ = nullptr;
    size_t size_ = 0;
};

} // namespace mural::sizes
