// Malloc settings that keep freed memory in the process. For processes that hold uploads and pictures for a frame or a
// scene.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <malloc.h>

#include "common/memory/huge_pages.hpp"

namespace mural {

constexpr int kTopPadBytes = 64 << 20;
constexpr int kMaxHeapBlockBytes = 32 << 20; // largest value that glibc accepts

// Keeps freed blocks in the heap. By default every block from 128 KiB on is newly mapped, and its page faults take as
// long as compressing its contents. At most kTopPadBytes stay in each malloc arena. Call before other threads start.
inline void keepFreedMemory() {
    mallopt(M_MMAP_THRESHOLD, kMaxHeapBlockBytes);
    mallopt(M_TRIM_THRESHOLD, kTopPadBytes);
}

// Touches memory in advance, in the calling thread's arena, so that the first user has no page faults. The memory then
// counts as freed. Uses huge pages where available. Requires keepFreedMemory() and a size below kMaxHeapBlockBytes;
// otherwise it has no effect.
inline void reserveMallocMemory(size_t sizeBytes) {
    constexpr size_t kPageBytes = 4096;
    void* const block = std::malloc(sizeBytes);
    if (!block) return;
    requestHugePages({static_cast<std::byte*>(block), sizeBytes});
    for (size_t at = 0; at < sizeBytes; at += kPageBytes) static_cast<volatile std::byte*>(block)[at] = std::byte{0};
    std::free(block);
}

} // namespace mural
