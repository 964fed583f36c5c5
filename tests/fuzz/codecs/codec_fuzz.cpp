// Feeds arbitrary bytes to a picture decoder (MURAL_FUZZ_CODEC). A lossless codec must encode and restore each plane
// that it accepted.
#include <algorithm>
#include <cstdlib>

#include "compositor/codecs/registry.hpp"
#include "tests/fuzz/codecs/codec_input.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

using namespace compositor;

uint64_t fuzzOne(std::span<const std::byte> input) {
    static CodecRegistry registry;
    static const bool lossless = registry.find(MURAL_FUZZ_CODEC).value().lossless;
    // keeps its scratch memory, as in the product
    static const std::unique_ptr<Codec> codec = std::move(registry.make(MURAL_FUZZ_CODEC).value());
    InputReader in(input);
    const PlaneShape shape = readShape(in);
    if (input.size() < kInputHeadBytes) return 0;
    const std::vector<std::byte> bytes(input.begin() + kInputHeadBytes, input.end()); // a copy of exactly this size
    Plane plane(shape.format, shape.width, shape.height);
    const auto decoded = codec->decode(bytes, plane.view());
    if (!decoded) {
        must(!decoded.error().message.empty() && decoded.error().message.find('\n') == std::string::npos,
             "an error is one line");
        return 0;
    }
    if (!registry.find(MURAL_FUZZ_CODEC).value().takes(shape.format)) {
        must(false, "a format that the codec does not take is refused");
    }
    std::vector<std::byte> again(codec->boundBytes(shape));
    const auto size = codec->encode(plane.view(), again);
    must(size.ok() && size.value() <= again.size(), "what was decoded can be encoded");
    again.resize(size.value());
    Plane copy(shape.format, shape.width, shape.height);
    must(codec->decode(again, copy.view()).ok(), "what was encoded can be decoded");
    must(!lossless || copy == plane, "a lossless codec gives back every bit");
    return 1;
}

} // namespace mural::fuzz
