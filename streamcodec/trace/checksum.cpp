#include "streamcodec/trace/checksum.hpp"

#include <memory>
#include <xxhash.h>

namespace mural::trace {

uint64_t checksumOf(std::initializer_list<std::span<const std::byte>> pieces) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    if (!state) return 0;
    XXH3_64bits_reset(state.get());
    for (const auto& piece : pieces) XXH3_64bits_update(state.get(), piece.data(), piece.size());
    return XXH3_64bits_digest(state.get());
}

} // namespace mural::trace
