// Planes of pixels packed for one link, and unpacked: by the codec that gets them across soonest, of those that lose nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/result.hpp"
#include "compositor/codecs/codec.hpp"
#include "compositor/selector/codec_selector.hpp"

namespace mural {

// What codecs are called on the way; both ends are of one build.
using CodecNumber = uint8_t;

// Planes are RGBA8, D24S8 or D32F. Used by one thread.
class PlaneEncoder {
public:
    PlaneEncoder();
    ~PlaneEncoder();

    // Puts the plane's bytes behind what is there; never more than those of its pixels.
    CodecNumber encode(const compositor::PlaneView& plane, std::vector<std::byte>& into);
    // The link carried so much in a time in which it was never idle.
    void transferred(uint64_t bytes, int64_t ns);

private:
    size_t tryCodec(CodecNumber codec, const compositor::PlaneView& plane, int64_t& tookNs);
    void measure(compositor::CodecSelector& selector, size_t index, const compositor::TileClass& tile, const compositor::PlaneView& plane);

    std::vector<std::unique_ptr<compositor::Codec>> codecs_; // by number
    compositor::CodecSelector colour_, depth_;
    std::vector<std::byte> scratch_;
    compositor::Plane decoded_; // of a codec that is measured
};

class PlaneDecoder {
public:
    PlaneDecoder();
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
