#include "nodes/frame_transfer/plane_codecs.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "compositor/codecs/registry.hpp"

namespace mural {

namespace {

using compositor::Codec;
using compositor::MutablePlaneView;
using compositor::PlaneView;

// The index in this list is the codec number. The user's codec follows after the list. Run-length coding is omitted,
// because it is only a baseline for measurements.
constexpr const char* kCodecs[] = {"raw", "bitplane", "slope",  "bitplane-zstd", "slope-zstd",
                                   "lz4", "zstd",     "yuv420", "jpeg-90"};
constexpr CodecNumber kRaw = 0;

CodecNumber numberOf(const std::string& name) {
    return static_cast<CodecNumber>(std::ranges::find(kCodecs, name) - std::begin(kCodecs));
}

bool isName(const std::string& codec) { return codec != kQuickestCodec && codec != kLossyCodec; }

std::vector<std::unique_ptr<Codec>> makeCodecs(const std::string& wanted) {
    compositor::CodecRegistry registry;
    std::vector<std::unique_ptr<Codec>> codecs;
    const auto add = [&](const std::string& name) {
        auto codec = registry.make(name);
        codecs.push_back(codec ? std::move(*codec) : nullptr);
    };
    for (const char* name : kCodecs) add(name);
    if (isName(wanted) && numberOf(wanted) == std::size(kCodecs)) add(wanted);
    return codecs;
}

std::vector<std::string> coloursBy(const std::string& codec) {
    std::vector<std::string> names = {"raw", "bitplane", "bitplane-zstd", "lz4", "zstd"};
    if (codec == kLossyCodec) names.insert(names.end(), {"yuv420", "jpeg-90"});
    return names;
}

compositor::SelectorOptions latencyCounts() {
    compositor::SelectorOptions options;
    options.overlap = compositor::Overlap::Serial; // the receiver decodes only after the whole piece has arrived
    return options;
}

} // namespace

Result<WantedCodec> wantedCodec(const std::string& name) {
    if (!isName(name)) return WantedCodec{true, name != kLossyCodec};
    auto info = compositor::CodecRegistry().find(name);
    if (!info) return info.error();
    return WantedCodec{false, info->lossless};
}

bool mayLose(const std::string& codec) {
    auto wanted = wantedCodec(codec);
    return wanted && !wanted->lossless;
}

PlaneEncoder::PlaneEncoder(const std::string& codec)
    : codecs_(makeCodecs(codec)),
      colour_(coloursBy(codec), latencyCounts()),
      depth_({"raw", "slope", "slope-zstd", "lz4", "zstd"}, latencyCounts()) {
    if (!isName(codec)) return;
    auto info = compositor::CodecRegistry().find(codec);
    const CodecNumber number = numberOf(codec);
    if (!info || !codecs_[number]) return;
    named_ = number;
    namedFormats_ = info->formats;
}
PlaneEncoder::~PlaneEncoder() = default;

// Encodes into scratch_ and returns the size. A size equal to the raw one means no gain.
size_t PlaneEncoder::tryCodec(CodecNumber codec, const PlaneView& plane, int64_t& tookNs) {
    scratch_.resize(std::max(scratch_.size(), codecs_[codec]->boundBytes(shapeOf(plane))));
    const int64_t beganNs = threadCpuNowNs();
    auto size = codecs_[codec]->encode(plane, scratch_);
    tookNs = threadCpuNowNs() - beganNs;
    return size ? std::min(*size, plane.sizeBytes()) : plane.sizeBytes();
}

// Sends the plane raw if the codec enlarges it.
CodecNumber PlaneEncoder::encodeBy(CodecNumber codec, const PlaneView& plane, std::vector<std::byte>& into) {
    int64_t tookNs = 0;
    size_t size = tryCodec(codec, plane, tookNs);
    if (size == plane.sizeBytes() && codec != kRaw) {
        codec = kRaw;
        size = tryCodec(codec, plane, tookNs);
    }
    into.insert(into.end(), scratch_.begin(), scratch_.begin() + static_cast<ptrdiff_t>(size));
    return codec;
}

CodecNumber PlaneEncoder::encode(const PlaneView& plane, std::vector<std::byte>& into) {
    if (named_ && (namedFormats_ & compositor::formatBit(plane.format)) != 0) return encodeBy(*named_, plane, into);
    compositor::CodecSelector& selector = isDepth(plane.format) ? depth_ : colour_;
    const compositor::TileClass tile = compositor::classify(plane);
    const auto choice = selector.choose(tile, plane.sizeBytes());
    CodecNumber codec = numberOf(selector.name(choice.codec));
    if (log::enabled(log::Topic::Picture, log::Level::Debug)) reportSwitch(tile, codec, selector.linkBytesPerSec());
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

void PlaneEncoder::reportSwitch(const compositor::TileClass& tile, CodecNumber codec, double linkBytesPerSec) {
    const auto [last, isFirst] = reported_.try_emplace(tile, codec);
    if (!isFirst && std::exchange(last->second, codec) == codec) return;
    log::debug(log::Topic::Picture, isDepth(tile.format) ? "depth" : "colour", " tiles of class ",
               static_cast<int>(tile.activity), ".", static_cast<int>(tile.change), " are encoded as ", kCodecs[codec],
               "; the link carries ", linkBytesPerSec / 1e6, " MB/s");
}

void PlaneEncoder::measure(compositor::CodecSelector& selector, size_t index, const compositor::TileClass& tile,
                           const PlaneView& plane) {
    const CodecNumber codec = numberOf(selector.name(index));
    int64_t encodeNs = 0;
    const size_t size = tryCodec(codec, plane, encodeNs);
    if (decoded_.format() != plane.format || decoded_.width() != plane.width || decoded_.height() != plane.height)
        decoded_ = {plane.format, plane.width, plane.height};
    const int64_t beganNs = threadCpuNowNs();
    (void)codecs_[codec]->decode({scratch_.data(), size}, decoded_.view());
    selector.measured(tile, index, plane.sizeBytes(), size, encodeNs, threadCpuNowNs() - beganNs);
}

void PlaneEncoder::transferred(uint64_t bytes, int64_t ns) {
    colour_.transferred(bytes, ns);
    depth_.transferred(bytes, ns);
}

PlaneDecoder::PlaneDecoder(const std::string& codec) : codecs_(makeCodecs(codec)) {}
PlaneDecoder::~PlaneDecoder() = default;

Result<void> PlaneDecoder::decode(CodecNumber codec, std::span<const std::byte> bytes, const MutablePlaneView& into) {
    if (codec >= codecs_.size() || !codecs_[codec])
        return Error{"a plane with the unknown codec " + std::to_string(codec) +
                     "; install the same version of mural on all machines"};
    return codecs_[codec]->decode(bytes, into);
}

} // namespace mural
