#include "nodes/exchange/plane_codecs.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "common/clock.hpp"
#include "compositor/codecs/registry.hpp"

namespace mural {

namespace {

using compositor::Codec;
using compositor::MutablePlaneView;
using compositor::PlaneView;

// Numbers are places in this list. Run lengths are there to be measured against, and not in it.
constexpr const char* kCodecs[] = {"raw", "bitplane", "slope", "bitplane-zstd", "slope-zstd", "lz4", "zstd"};
constexpr CodecNumber kRaw = 0;

CodecNumber numberOf(const std::string& name) {
    return static_cast<CodecNumber>(std::ranges::find(kCodecs, name) - std::begin(kCodecs));
}

std::vector<std::unique_ptr<Codec>> makeCodecs() {
    compositor::CodecRegistry registry;
    std::vector<std::unique_ptr<Codec>> codecs;
    for (const char* name : kCodecs) {
        auto codec = registry.make(name);
        codecs.push_back(codec ? std::move(*codec) : nullptr);
    }
    return codecs;
}

compositor::SelectorOptions latencyCounts() {
    compositor::SelectorOptions options;
    options.overlap = compositor::Overlap::Serial; // the receiver waits for the piece, and then unpacks it
    return options;
}

} // namespace

PlaneEncoder::PlaneEncoder()
    : codecs_(makeCodecs()), colour_({"raw", "bitplane", "bitplane-zstd", "lz4", "zstd"}, latencyCounts()), depth_({"raw", "slope", "slope-zstd", "lz4", "zstd"}, latencyCounts()) {}
PlaneEncoder::~PlaneEncoder() = default;

// Into scratch_; how many bytes. As many as raw ones: it is of no use here.
size_t PlaneEncoder::tryCodec(CodecNumber codec, const PlaneView& plane, int64_t& tookNs) {
    scratch_.resize(std::max(scratch_.size(), codecs_[codec]->boundBytes(shapeOf(plane))));
    const int64_t beganNs = threadCpuNowNs();
    auto size = codecs_[codec]->encode(plane, scratch_);
    tookNs = threadCpuNowNs() - beganNs;
    return size ? std::min(*size, plane.sizeBytes()) : plane.sizeBytes();
}

CodecNumber PlaneEncoder::encode(const PlaneView& plane, std::vector<std::byte>& into) {
    compositor::CodecSelector& selector = isDepth(plane.format) ? depth_ : colour_;
    const compositor::TileClass tile = compositor::classify(plane);
    const auto choice = selector.choose(tile, plane.sizeBytes());
    CodecNumber codec = numberOf(selector.name(choice.codec));
    int64_t tookNs = 0;
    size_t size = tryCodec(codec, plane, tookNs);
    selector.encoded(tile, choice.codec, plane.sizeBytes(), size, tookNs);
    if (size == plane.sizeBytes() && codec != kRaw) {
        codec = kRaw;
        size = tryCodec(codec, plane, tookNs);
    }
    into.insert(into.end(), scratch_.begin(), scratch_.begin() + static_cast<ptrdiff_t>(size));
    if (choice.measure) measure(selector, *choice.measure, tile, plane);
    return codec;
}

void PlaneEncoder::measure(compositor::CodecSelector& selector, size_t index, const compositor::TileClass& tile, const PlaneView& plane) {
    const CodecNumber codec = numberOf(selector.name(index));
    int64_t encodeNs = 0;
    const size_t size = tryCodec(codec, plane, encodeNs);
    if (decoded_.format() != plane.format || decoded_.width() != plane.width || decoded_.height() != plane.height) decoded_ = {plane.format, plane.width, plane.height};
    const int64_t beganNs = threadCpuNowNs();
    (void)codecs_[codec]->decode({scratch_.data(), size}, decoded_.view());
    selector.measured(tile, index, plane.sizeBytes(), size, encodeNs, threadCpuNowNs() - beganNs);
}

void PlaneEncoder::transferred(uint64_t bytes, int64_t ns) {
    colour_.transferred(bytes, ns);
    depth_.transferred(bytes, ns);
}

PlaneDecoder::PlaneDecoder() : codecs_(makeCodecs()) {}
PlaneDecoder::~PlaneDecoder() = default;

Result<void> PlaneDecoder::decode(CodecNumber codec, std::span<const std::byte> bytes, const MutablePlaneView& into) {
    if (codec >= codecs_.size() || !codecs_[codec]) return Error{"a plane by codec " + std::to_string(codec) + ", which there is not"};
    return codecs_[codec]->decode(bytes, into);
}

} // namespace mural
