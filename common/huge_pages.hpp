// Pages of 2 MiB for memory of megabytes: touching it by pages of 4 KiB costs a fault for each, and more of the processor's address cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <sys/mman.h>

namespace mural {

constexpr size_t kHugePageBytes = size_t{2} << 20;

// The whole ones that lie within, for which the system is asked; empty where there are none. That it has no huge pages does not matter.
inline std::span<std::byte> askForHugePages(std::span<std::byte> memory) {
    const size_t before = (kHugePageBytes - reinterpret_cast<uintptr_t>(memory.data()) % kHugePageBytes) % kHugePageBytes;
    if (memory.size() < before + kHugePageBytes) return {};
    const auto whole = memory.subspan(before, (memory.size() - before) / kHugePageBytes * kHugePageBytes);
    madvise(whole.data(), whole.size(), MADV_HUGEPAGE);
    return whole;
}

} // namespace mural
