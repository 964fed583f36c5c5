// Identifies the stream's grammar and command table. Both ends of a link must have the same value.
#pragma once

#include <cinttypes>
#include <cstdio>
#include <string>

#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

inline std::string streamBuild() {
    char text[48];
    std::snprintf(text, sizeof text, "%u.%u.%016" PRIx64, wire::kVersion, wire::kBatchVersion, registryDigest());
    return text;
}

} // namespace mural
