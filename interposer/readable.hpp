// Whether memory of the program may be read, asked from the kernel: no signal handler is touched.
#pragma once

#include <cstdint>

namespace mural {

// How many of the bytes, from the first on, may be read. All, where the kernel refuses the question.
uint64_t readableBytes(const void* memory, uint64_t sizeBytes);

} // namespace mural
