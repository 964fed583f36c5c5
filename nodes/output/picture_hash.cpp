#include "nodes/output/picture_hash.hpp"

#include <array>

#define XXH_STATIC_LINKING_ONLY // for a state on the stack
#include <xxhash.h>

namespace mural {

namespace {

// The sizes belong to the contents: the same bytes in other rows are another picture.
void beginPicture(XXH3_state_t& state, int width, int height, PictureFormat format) {
    const std::array<int32_t, 3> shape{width, height, static_cast<int32_t>(format)};
    XXH3_64bits_update(&state, shape.data(), sizeof shape);
}

uint64_t hashIn(const XXH3_state_t& state) {
    const uint64_t hash = XXH3_64bits_digest(&state);
    return hash == 0 ? 1 : hash;
}

} // namespace

uint64_t hashOfPictures(std::span<const Picture> pictures) {
    XXH3_state_t state;
    XXH3_64bits_reset(&state);
    for (const Picture& picture : pictures) {
        beginPicture(state, picture.width, picture.height, picture.format);
        if (!picture.empty()) XXH3_64bits_update(&state, picture.bgra, picture.sizeBytes());
    }
    return hashIn(state);
}

uint64_t hashOfPart(const Picture& picture, const PixelViewport& part) {
    const PixelViewport inside = intersect(part, {0, 0, picture.width, picture.height});
    XXH3_state_t state;
    XXH3_64bits_reset(&state);
    beginPicture(state, inside.w, inside.h, picture.format);
    if (!picture.empty() && !inside.empty()) {
        const auto left = static_cast<size_t>(inside.x) * kPictureBytesPerPixel;
        const auto bytes = static_cast<size_t>(inside.w) * kPictureBytesPerPixel;
        for (int y = inside.y; y < inside.y + inside.h; ++y) XXH3_64bits_update(&state, picture.row(y) + left, bytes);
    }
    return hashIn(state);
}

} // namespace mural
