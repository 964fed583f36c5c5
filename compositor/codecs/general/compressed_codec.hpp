// Compresses a plane's rows as bytes, or the output of another codec, preceded by its size (4 bytes).
#pragma once

#include <memory>
#include <vector>

#include "compositor/codecs/codec.hpp"
#include "compositor/codecs/general/byte_compressor.hpp"

namespace mural::compositor {

class CompressedCodec : public Codec {
public:
    // inner: null for plain rows.
    CompressedCodec(std::string name, std::unique_ptr<Codec> inner, std::unique_ptr<ByteCompressor> compressor)
        : name_(std::move(name)), inner_(std::move(inner)), compressor_(std::move(compressor)) {}

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override;
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override;
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override;

private:
    std::string name_;
    std::unique_ptr<Codec> inner_;
    std::unique_ptr<ByteCompressor> compressor_;
    std::vector<std::byte> scratch_;
};

} // namespace mural::compositor
