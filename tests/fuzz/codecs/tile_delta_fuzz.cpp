// Sequences of planes with only their changed tiles. Input: a shape, then pieces, one plane after the other.
#include "compositor/codecs/registry.hpp"
#include "compositor/codecs/tile_delta.hpp"
#include "tests/fuzz/codecs/codec_input.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

using namespace compositor;

uint64_t fuzzOne(std::span<const std::byte> input) {
    static const std::unique_ptr<Codec> codec = std::move(CodecRegistry().make("bitplane").value());
    InputReader in(input);
    const PlaneShape shape = readShape(in);
    Plane plane(shape.format, shape.width, shape.height);
    TileDeltaDecoder decoder;
    uint64_t taken = 0;
    while (!in.empty()) taken += decoder.decode(in.piece(), *codec, plane.view()).ok();
    return taken;
}

} // namespace mural::fuzz
