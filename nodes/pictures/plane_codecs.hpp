// Planes of pixels packed for one link, and unpacked: by the codec that gets them across soonest, of those that lose nothing, or as the user wants it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "compositor/codecs/codec.hpp"
#include "compositor/selector/codec_selector.hpp"

namespace mural {

// What the user may want instead of the name of a codec (compositor::CodecRegistry): the quickest, of those that lose nothing or of all.
inline constexpr const char* kQuickestCodec = "auto";
inline constexpr const char* kLossyCodec = "lossy";
inline constexpr const char* kRawCodec = "raw"; // of pictures: they are not packed at all

// Errors: there is no such codec.
struct WantedCodec {
    bool chosen = false;   // by what is quickest
    bool lossless = true;
};
Result<WantedCodec> wantedCodec(const std::string& name);
[[nodiscard]] bool mayLose(const std::string& codec); // there is one of this name

// What codecs are called on the way; both ends are of one build, and know what the user wants.
using CodecNumber = uint8_t;

// Planes are RGBA8, D24S8 or D32F. Used by one thread.
class PlaneEncoder {
public:
    // What a codec does not take (depth, by lossy ones) goes by the quickest. Of a name that there is not: all.
    explicit PlaneEncoder(const std::string& codec = kQuickestCodec);
    ~PlaneEncoder();

    // Puts the plane's bytes behind what is there; never more than those of its pixels.
    CodecNumber encode(const compositor::PlaneView& plane, std::vector<std::byte>& into);
    // The link carried so much in a time in which it was never idle.
    void transferred(uint64_t bytes, int64_t ns);

private:
    CodecNumber encodeBy(CodecNumber codec, const compositor::PlaneView& plane, std::vector<std::byte>& into);
    size_t tryCodec(CodecNumber codec, const compositor::PlaneView& plane, int64_t& tookNs);
    void measure(compositor::CodecSelector& selector, size_t index, const compositor::TileClass& tile, const compositor::PlaneView& plane);

    std::vector<std::unique_ptr<compositor::Codec>> codecs_; // by number
    std::optional<CodecNumber> named_; // for all planes of these formats
    uint32_t namedFormats_ = 0;
    compositor::CodecSelector colour_, depth_;
    std::vector<std::byte> scratch_;
    compositor::Plane decoded_; // of a codec that is measured
};

class PlaneDecoder {
public:
    explicit PlaneDecoder(const std::string& codec = kQuickestCodec);
    ~PlaneDecoder();

    // Any bytes may come in; what is no plane of this shape is an error.
    Result<void> decode(CodecNumber codec, std::span<const std::byte> bytes, const compositor::MutablePlaneView& into);

    // For what is unpacked: kept from piece to piece, since memory that comes anew takes longer than unpacking does.
    std::vector<uint32_t>& colour() { return colour_; }
    std::vector<uint32_t>& depth() { return depth_; }

private:
    std::vector<std::unique_ptr<compositor::Codec>> codecs_;
    std::vector<uint32_t> colour_, depth_;
};

} // namespace mural
