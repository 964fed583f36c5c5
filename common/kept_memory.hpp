// Memory that is given back stays with the process, for those that hold uploads and pictures for a frame or a scene.
#pragma once

#include <malloc.h>

namespace mural {

constexpr int kKeptBytes = 64 << 20;
constexpr int kLargestKeptBlockBytes = 32 << 20; // the most that glibc takes

// Otherwise each block from 128 KiB on is new memory: to get its pages, one fault for each, takes as long as to compress what is
// then written there. Before there are other threads. At most kKeptBytes stay in each of malloc's arenas.
inline void keepFreedMemory() {
    mallopt(M_MMAP_THRESHOLD, kLargestKeptBlockBytes);
    mallopt(M_TRIM_THRESHOLD, kKeptBytes);
}

} // namespace mural
