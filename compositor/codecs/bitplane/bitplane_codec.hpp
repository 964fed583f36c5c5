// The bit-plane codec: a table of tile sizes, then the tiles, row by row from the lowest.
#pragma once

#include <functional>
#include <vector>

#include "common/pixel_viewport.hpp"
#include "compositor/codecs/bitplane/tile_decoder.hpp"
#include "compositor/codecs/bitplane/tile_encoder.hpp"
#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class BitplaneCodec : public Codec {
public:
    // Slope is for planes of depth, and for what is as smooth.
    explicit BitplaneCodec(bitplane::Predictor predictor) : predictor_(predictor) {}

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

    // The same tile by tile: each is decoded into memory that stays in the caches, and handed over with its place in the plane.
    // So a kernel takes it from there, and the plane is never written. After an error, some tiles were handed over.
    using EachTile = std::function<void(const PixelViewport& area, const PlaneView& tile)>;
    [[nodiscard]] Result<void> decodeTiles(std::span<const std::byte> bytes, const PlaneShape& shape, const EachTile& each);

private:
    [[nodiscard]] const char* name() const { return predictor_ == bitplane::Predictor::Slope ? "slope" : "bitplane"; }
    bitplane::Predictor predictor_;
    std::vector<bitplane::TileEncoder> encoders_; // of the tiles that stand side by side
    std::vector<bitplane::TileDecoder> decoders_;
    std::vector<std::byte> tile_; // of decodeTiles
};

} // namespace mural::compositor
