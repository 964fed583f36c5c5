#include "compositor/codecs/registry.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "compositor/codecs/bitplane/bitplane_codec.hpp"
#include "compositor/codecs/general/compressed_codec.hpp"
#include "compositor/codecs/general/raw_codec.hpp"
#include "compositor/codecs/lossy/jpeg_codec.hpp"
#include "compositor/codecs/lossy/yuv420_codec.hpp"
#include "compositor/codecs/plugin/codec_library.hpp"
#include "compositor/codecs/rle/rle64_codec.hpp"
#include "compositor/codecs/rle/rle_components_codec.hpp"

namespace mural::compositor {

namespace {

using bitplane::Predictor;
using Made = Result<std::unique_ptr<Codec>>;

template <class T, class... A> Made made(A&&... arguments) {
    return std::unique_ptr<Codec>(std::make_unique<T>(std::forward<A>(arguments)...));
}

// Bit-plane output is small: the fastest level finds the remaining redundancy (repeated rows).
constexpr int kLevelOfBitplanes = -1;
constexpr int kLevelOfRows = 1;
constexpr std::string_view kJpeg = "jpeg-";

// Returns the quality of a name jpeg-N.
std::optional<int> jpegQuality(const std::string& name) {
    if (!name.starts_with(kJpeg)) return std::nullopt;
    int quality = 0;
    const char* end = name.data() + name.size();
    const auto [last, error] = std::from_chars(name.data() + kJpeg.size(), end, quality);
    if (error != std::errc() || last != end || quality < 1 || quality > 100) return std::nullopt;
    return quality;
}

} // namespace

CodecRegistry::CodecRegistry(std::string pluginFolder) : pluginFolder_(std::move(pluginFolder)) {
    add({"raw", true, kAllFormats}, [] { return made<RawCodec>(); });
    add({"rle64", true, kAllFormats}, [] { return made<Rle64Codec>(); });
    add({"rle-components", true, kAllFormats}, [] { return made<RleComponentsCodec>(false); });
    add({"rle-swizzled", true, kAllFormats}, [] { return made<RleComponentsCodec>(true); });
    add({"bitplane", true, kAllFormats}, [] { return made<BitplaneCodec>(Predictor::Above); });
    add({"slope", true, kAllFormats}, [] { return made<BitplaneCodec>(Predictor::Slope); });
    add({"bitplane-zstd", true, kAllFormats}, [] {
        return made<CompressedCodec>("bitplane-zstd", std::make_unique<BitplaneCodec>(Predictor::Above),
                                     makeZstd(kLevelOfBitplanes));
    });
    add({"slope-zstd", true, kAllFormats}, [] {
        return made<CompressedCodec>("slope-zstd", std::make_unique<BitplaneCodec>(Predictor::Slope),
                                     makeZstd(kLevelOfBitplanes));
    });
    add({"lz4", true, kAllFormats}, [] { return made<CompressedCodec>("lz4", nullptr, makeLz4()); });
    add({"zstd", true, kAllFormats}, [] { return made<CompressedCodec>("zstd", nullptr, makeZstd(kLevelOfRows)); });
    add({"yuv420", false, formatBit(PlaneFormat::Rgba8)}, [] { return made<Yuv420Codec>(); });
}

void CodecRegistry::add(CodecInfo info, Maker maker) {
    known_.push_back(std::move(info));
    makers_.push_back(std::move(maker));
}

const CodecRegistry::Maker* CodecRegistry::makerOf(const std::string& name) const {
    const auto at = std::ranges::find(known_, name, &CodecInfo::name);
    return at == known_.end() ? nullptr : &makers_[static_cast<size_t>(at - known_.begin())];
}

// Opens a codec by name and adds it to the known ones.
Result<void> CodecRegistry::open(const std::string& name) {
    if (makerOf(name)) return {};
    if (const auto quality = jpegQuality(name)) {
        // Quality from which chroma is not subsampled.
        constexpr int kFullColour = 96;
        add({name, false, formatBit(PlaneFormat::Rgba8)},
            [quality] { return made<JpegCodec>(*quality, *quality < kFullColour); });
        return {};
    }
    const auto mayBeFile = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    };
    if (pluginFolder_.empty() || name.empty() || !std::ranges::all_of(name, mayBeFile)) {
        std::string names;
        for (const CodecInfo& c : known_) names += c.name + ", ";
        return Error{"unknown codec \"" + name + "\"; use " + names + "or jpeg-N with N from 1 to 100"};
    }
    auto plugin = openCodecPlugin(name, pluginFolder_);
    if (!plugin) return plugin.error();
    add(infoOf(**plugin), [table = *plugin] { return makeCodec(*table); });
    return {};
}

Result<CodecInfo> CodecRegistry::find(const std::string& name) {
    if (auto opened = open(name); !opened) return opened.error();
    return *std::ranges::find(known_, name, &CodecInfo::name);
}

Result<std::unique_ptr<Codec>> CodecRegistry::make(const std::string& name) {
    if (auto opened = open(name); !opened) return opened.error();
    return (*makerOf(name))();
}

std::vector<CodecInfo> CodecRegistry::losslessFor(PlaneFormat format) const {
    std::vector<CodecInfo> fit;
    std::ranges::copy_if(known_, std::back_inserter(fit),
                         [&](const CodecInfo& c) { return c.lossless && c.takes(format); });
    return fit;
}

} // namespace mural::compositor
