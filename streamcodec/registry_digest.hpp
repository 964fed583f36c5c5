// Identifies the command table and opcodes of this build, on which program, head and nodes must agree.
#pragma once

#include <cstdint>

namespace mural {
uint64_t registryDigest();
} // namespace mural
