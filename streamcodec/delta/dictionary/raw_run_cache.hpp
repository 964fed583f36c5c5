// Caches recent runs of plain short records. Many programs send runs of equal size in each frame, in the same order,
// with few changed words. Both sides hold the same runs; the encoder chooses the slots. (RunCache is for delta-coded
// records, and exists in the encoder only.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::delta {

class RawRunCache {
public:
    static constexpr uint32_t kSlots = 32;
    static constexpr size_t kMinBytes = 1024, kMaxBytes = 65536; // size of a run in bytes, a multiple of 4

    void keep(uint32_t slot, std::span<const std::byte> run) { slots_[slot].assign(run.begin(), run.end()); }
    // Returns an empty span for an unused slot.
    [[nodiscard]] std::span<std::byte> at(uint32_t slot) { return slots_[slot]; }

private:
    std::array<std::vector<std::byte>, kSlots> slots_;
};

} // namespace mural::delta
