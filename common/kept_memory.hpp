// Memory that is given back stays with the process, for those that hold uploads and pictures for a frame or a scene.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <malloc.h>

#include "common/huge_pages.hpp"

namespace mural {

constexpr int kKeptBytes = 64 << 20;
constexpr int kLargestKeptBlockBytes = 32 << 20; // the most that glibc takes

// Otherwise each block from 128 KiB on is new memory: to get its pages, one fault for each, takes as long as to compress what is
// then written there. Before there are other threads. At most kKeptBytes stay in each of malloc's arenas.
inline void keepFreedMemory() {
    mallopt(M_MMAP_THRESHOLD, kLargestKeptBlockBytes);
    mallopt(M_TRIM_THRESHOLD, kKeptBytes);
}

// So much is with the calling thread's malloc from now on, as if it had been used and given back: the first who need it need not wait for
// its pages. In huge ones where the system has them; below kLargestKeptBlockBytes, and behind keepFreedMemory(), else without effect.
inline void haveKeptMemory(size_t sizeBytes) {
    constexpr size_t kPageBytes = 4096;
    void* const block = std::malloc(sizeBytes);
    if (!block) return;
    askForHugePages({static_cast<std::byte*>(block), sizeBytes});
    for (size_t at = 0; at < sizeBytes; at += kPageBytes) static_cast<volatile std::byte*>(block)[at] = std::byte{0};
    std::free(block);
}

} // namespace mural
