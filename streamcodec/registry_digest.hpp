// Fingerprint of the command table: both ends of a capture must be of one build.
#pragma once

#include <cstdint>

namespace mural {

uint64_t registryDigest();

} // namespace mural
