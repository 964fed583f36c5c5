// Runs of short records that went plain, as they were last: many programs say as many bytes in each frame, in the same order, and change a
// few words of them. Both sides have the same; which run is where says the packer.
// (KnownRuns are the packer's own, of records that are looked at.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::economy {

class KeptRuns {
public:
    static constexpr uint32_t kSlots = 32;
    static constexpr size_t kLeastBytes = 1024, kMostBytes = 65536; // of a run, whole words

    void keep(uint32_t slot, std::span<const std::byte> run) { slots_[slot].assign(run.begin(), run.end()); }
    // Empty where nothing was kept.
    [[nodiscard]] std::span<std::byte> at(uint32_t slot) { return slots_[slot]; }

private:
    std::array<std::vector<std::byte>, kSlots> slots_;
};

} // namespace mural::economy
