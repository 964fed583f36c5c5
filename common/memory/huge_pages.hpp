// Huge pages of 2 MiB for large memory: pages of 4 KiB cost a fault each and more TLB entries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <sys/mman.h>

namespace mural {

constexpr size_t kHugePageBytes = size_t{2} << 20;

// Requests huge pages for the aligned part of `memory` and returns that part; empty if too small. Systems without huge
// pages ignore the request.
inline std::span<std::byte> requestHugePages(std::span<std::byte> memory) {
    const size_t before =
        (kHugePageBytes - reinterpret_cast<uintptr_t>(memory.data()) % kHugePageBytes) % kHugePageBytes;
    if (memory.size() < before + kHugePageBytes) return {};
    const auto whole = memory.subspan(before, (memory.size() - before) / kHugePageBytes * kHugePageBytes);
    madvise(whole.data(), whole.size(), MADV_HUGEPAGE);
    return whole;
}

} // namespace mural
