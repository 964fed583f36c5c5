// Asks the kernel whether memory of the program is readable, without signal handlers.
#pragma once

#include <cstdint>

namespace mural {

// Returns the number of readable bytes from the first on. Returns sizeBytes if the kernel does not answer.
uint64_t readableBytes(const void* memory, uint64_t sizeBytes);

} // namespace mural
