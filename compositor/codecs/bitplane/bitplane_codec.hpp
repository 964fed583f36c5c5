// The bit-plane codec: a table of tile sizes, then the tiles, row by row from the lowest.
#pragma once

#include <memory>

#include "compositor/codecs/bitplane/tile_code.hpp"
#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class BitplaneCodec : public Codec {
public:
    // Slope is for planes of depth, and for what is as smooth.
    explicit BitplaneCodec(bitplane::Predictor predictor) : predictor_(predictor) {}

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

private:
    [[nodiscard]] const char* name() const { return predictor_ == bitplane::Predictor::Slope ? "slope" : "bitplane"; }
    bitplane::Predictor predictor_;
    bitplane::TileCoder coder_;
};

} // namespace mural::compositor
