// The bit-plane codec: a table of tile sizes, then the tiles in row-major order, lowest row first.
#pragma once

#include <functional>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "compositor/codecs/bitplane/tile_decoder.hpp"
#include "compositor/codecs/bitplane/tile_encoder.hpp"
#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class BitplaneCodec : public Codec {
public:
    // Predictor Slope suits depth planes and equally smooth data.
    explicit BitplaneCodec(bitplane::Predictor predictor) : predictor_(predictor) {}

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

    // Decodes tile by tile into cache-resident memory and passes each tile with its place to the callback, which can
    // composite it directly; the plane is never written. After an error some tiles have been passed.
    using EachTile = std::function<void(const PixelViewport& area, const PlaneView& tile)>;
    [[nodiscard]] Result<void> decodeTiles(std::span<const std::byte> bytes, const PlaneShape& shape,
                                           const EachTile& each);

private:
    [[nodiscard]] const char* name() const { return predictor_ == bitplane::Predictor::Slope ? "slope" : "bitplane"; }
    bitplane::Predictor predictor_;
    std::vector<bitplane::TileEncoder> encoders_; // one per tile of a row
    std::vector<bitplane::TileDecoder> decoders_;
    std::vector<std::byte> tile_; // for decodeTiles
};

} // namespace mural::compositor
