#include "streamcodec/delta/entropy/huffman_codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <zstd.h>

#include "streamcodec/delta/entropy/section_codec.hpp"

namespace mural::delta {

namespace {

constexpr size_t kMinBytes = 4096;
constexpr size_t kSampledOf = 16, kMinSampleBytes = 1024, kMaxSampleBytes = 4096; // size of each of two samples
constexpr double kOfCounts = 1.4;  // LZ4 exceeds the entropy of data with few repeats by this factor
constexpr double kMinLeft = 0.125; // a Huffman code has at least one bit
constexpr int kFastest = -100;     // a level that skips nearly all match searches
// ZSTD_c_literalCompressionMode by its stable number, set to "always". Negative levels otherwise leave literals
// uncompressed.
constexpr ZSTD_cParameter kLiterals = ZSTD_c_experimentalParam5;
constexpr int kAlways = 1;
constexpr int kWindowLog = 17; // one block

using Counts = std::array<uint32_t, 256>;

// Returns the size by the entropy of the byte counts.
double leftByCounts(const Counts& counts, size_t bytes) {
    double bits = 0;
    for (const uint32_t count : counts)
        if (count != 0) bits -= count * std::log2(static_cast<double>(count) / static_cast<double>(bytes));
    return bits / 8 / static_cast<double>(bytes);
}

} // namespace

struct HuffmanCompressor::State {
    std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> zstd{nullptr, ZSTD_freeCCtx};
    bool tried = false;
    std::vector<std::byte> scratch{};

    // Returns null without memory, or without support in the library.
    ZSTD_CCtx* open() {
        if (std::exchange(tried, true)) return zstd.get();
        zstd.reset(ZSTD_createCCtx());
        if (!zstd) return nullptr;
        for (const auto& [parameter, value] : {std::pair{ZSTD_c_compressionLevel, kFastest},
                                               {kLiterals, kAlways},
                                               {ZSTD_c_windowLog, kWindowLog},
                                               {ZSTD_c_contentSizeFlag, 0}})
            if (ZSTD_isError(ZSTD_CCtx_setParameter(zstd.get(), parameter, value))) {
                zstd.reset();
                break;
            }
        return zstd.get();
    }
};

HuffmanCompressor::HuffmanCompressor() : state_(std::make_unique<State>()) {}
HuffmanCompressor::~HuffmanCompressor() = default;
HuffmanCompressor::HuffmanCompressor(HuffmanCompressor&&) noexcept = default;

bool HuffmanCompressor::suits(std::span<const std::byte> bytes) {
    if (bytes.size() < kMinBytes || state_->open() == nullptr) return false;
    const size_t sizeBytes = std::clamp(bytes.size() / kSampledOf, kMinSampleBytes, kMaxSampleBytes),
                 before = (bytes.size() - sizeBytes) / 3;
    Counts counts{};
    size_t byRepeats = 0;
    for (const size_t at : {before, 2 * before}) {
        const auto sample = bytes.subspan(at, sizeBytes);
        byRepeats += lz4Bytes(sample, state_->scratch);
        for (const std::byte byte : sample) ++counts[static_cast<size_t>(byte)];
    }
    const size_t sampled = 2 * sizeBytes;
    return static_cast<double>(byRepeats) >
           kOfCounts * std::max(leftByCounts(counts, sampled), kMinLeft) * static_cast<double>(sampled);
}

bool HuffmanCompressor::compress(std::span<const std::byte> bytes, std::vector<std::byte>& into) {
    ZSTD_CCtx* const zstd = state_->open();
    if (zstd == nullptr) return false;
    auto& scratch = state_->scratch;
    if (const size_t room = ZSTD_compressBound(bytes.size()); scratch.size() < room) scratch.resize(room);
    const size_t size = ZSTD_compress2(zstd, scratch.data(), scratch.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(size)) return false;
    into.insert(into.end(), scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(size));
    return true;
}

void HuffmanCompressor::prepare() {
    const std::vector<std::byte> nothing(size_t{2} << kWindowLog);
    std::vector<std::byte> into;
    (void)compress(nothing, into);
}

struct HuffmanDecompressor::State {
    std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> zstd{nullptr, ZSTD_freeDCtx};
};

HuffmanDecompressor::HuffmanDecompressor() : state_(std::make_unique<State>()) {}
HuffmanDecompressor::~HuffmanDecompressor() = default;
HuffmanDecompressor::HuffmanDecompressor(HuffmanDecompressor&&) noexcept = default;

bool HuffmanDecompressor::decompress(std::span<const std::byte> bytes, std::span<std::byte> into) {
    if (!state_->zstd) state_->zstd.reset(ZSTD_createDCtx());
    return state_->zstd &&
           ZSTD_decompressDCtx(state_->zstd.get(), into.data(), into.size(), bytes.data(), bytes.size()) == into.size();
}

} // namespace mural::delta
