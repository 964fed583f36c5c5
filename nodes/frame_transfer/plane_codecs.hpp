// Encoding of pixel planes for one link: with the lossless codec that delivers them soonest, or with the user's codec.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "compositor/codecs/codec.hpp"
#include "compositor/selection/codec_selector.hpp"

namespace mural {

// Selects the fastest codec, lossless or any, instead of a name in compositor::CodecRegistry.
inline constexpr const char* kQuickestCodec = "auto";
inline constexpr const char* kLossyCodec = "lossy";
inline constexpr const char* kRawCodec = "raw"; // pictures are not encoded

// Errors: no such codec.
struct WantedCodec {
    bool chosen = false; // selected by speed
    bool lossless = true;
};
Result<WantedCodec> wantedCodec(const std::string& name);
[[nodiscard]] bool mayLose(const std::string& codec); // requires an existing name

// Codec numbers in messages. Both ends are of one build and know the user's choice.
using CodecNumber = uint8_t;

// For planes in RGBA8, RGBA16F, D24S8 or D32F. Used by one thread.
class PlaneEncoder {
public:
    // Planes that the codec does not support (depth, for lossy ones) use the fastest codec, as do all planes for an
    // unknown name.
    explicit PlaneEncoder(const std::string& codec = kQuickestCodec);
    ~PlaneEncoder();

    // Appends the encoded plane; its size never exceeds the raw size.
    CodecNumber encode(const compositor::PlaneView& plane, std::vector<std::byte>& into);
    // Reports a measurement of the link: bytes sent in a time without idle periods.
    void transferred(uint64_t bytes, int64_t ns);

private:
    CodecNumber encodeBy(CodecNumber codec, const compositor::PlaneView& plane, std::vector<std::byte>& into);
    size_t tryCodec(CodecNumber codec, const compositor::PlaneView& plane, int64_t& tookNs);
    void reportSwitch(const compositor::TileClass& tile, CodecNumber codec, double linkBytesPerSec);
    void measure(compositor::CodecSelector& selector, size_t index, const compositor::TileClass& tile,
                 const compositor::PlaneView& plane);

    std::vector<std::unique_ptr<compositor::Codec>> codecs_; // by number
    std::optional<CodecNumber> named_;                       // for all planes in its formats
    uint32_t namedFormats_ = 0;
    compositor::CodecSelector colour_, depth_;
    std::vector<std::byte> scratch_;
    compositor::Plane decoded_;                             // output of a codec under measurement
    std::map<compositor::TileClass, CodecNumber> reported_; // last codec in the log
};

class PlaneDecoder {
public:
    explicit PlaneDecoder(const std::string& codec = kQuickestCodec);
    ~PlaneDecoder();

    // Accepts arbitrary bytes. Errors: not a plane of this shape.
    Result<void> decode(CodecNumber codec, std::span<const std::byte> bytes, const compositor::MutablePlaneView& into);

    // Buffers for decoded pieces. They are reused, because fresh memory costs more than decoding.
    std::vector<uint32_t>& colour() { return colour_; }
    std::vector<uint32_t>& depth() { return depth_; }

private:
    std::vector<std::unique_ptr<compositor::Codec>> codecs_;
    std::vector<uint32_t> colour_, depth_;
};

} // namespace mural
