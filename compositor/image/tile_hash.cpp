#include "compositor/image/tile_hash.hpp"

#define XXH_STATIC_LINKING_ONLY // for a state on the stack
#include <xxhash.h>

namespace mural::compositor {

TileHash hashOf(const PlaneView& tile) {
    const size_t rowBytes = tile.rowBytes();
    XXH128_hash_t hash;
    if (static_cast<size_t>(tile.strideBytes) == rowBytes || tile.height == 1) {
        hash = XXH3_128bits(tile.pixels, rowBytes * static_cast<size_t>(tile.height));
    } else {
        XXH3_state_t state; // on the stack: no allocation per tile
        XXH3_128bits_reset(&state);
        for (int32_t y = 0; y < tile.height; ++y) XXH3_128bits_update(&state, tile.row(y), rowBytes);
        hash = XXH3_128bits_digest(&state);
    }
    return {hash.low64, hash.high64};
}

} // namespace mural::compositor
