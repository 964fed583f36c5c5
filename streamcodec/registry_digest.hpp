// Which command table and opcodes this build has: app, head and nodes must agree.
#pragma once

#include <cstdint>

namespace mural {
uint64_t registryDigest();
} // namespace mural
