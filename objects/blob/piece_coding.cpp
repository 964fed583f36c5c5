#include "objects/blob/piece_coding.hpp"

#include <algorithm>
#include <zstd.h>

namespace mural::objects {

namespace {

constexpr int kLevel = -1;                    // fast: the coding must keep up with a network
constexpr size_t kLeastBytes = 4096;          // smaller pieces stay raw
constexpr double kDecodingNsPerByte = .7;     // about 1.5 GB/s
constexpr double kLeastGain = 1.1;            // raw bytes are preferred where the difference is small
constexpr uint64_t kFastLink = 4'000'000'000; // bytes per second, above which no coding can gain
constexpr size_t kWord = 4;

void toPlanes(std::span<const std::byte> words, std::vector<std::byte>& planes) {
    const size_t count = words.size() / kWord;
    planes.resize(words.size());
    for (size_t plane = 0; plane < kWord; ++plane) {
        std::byte* const to = planes.data() + plane * count;
        for (size_t i = 0; i < count; ++i) to[i] = words[kWord * i + plane];
    }
    std::copy(words.begin() + static_cast<ptrdiff_t>(count * kWord), words.end(),
              planes.begin() + static_cast<ptrdiff_t>(count * kWord));
}

void fromPlanes(std::span<const std::byte> planes, std::byte* words) {
    const size_t count = planes.size() / kWord;
    for (size_t plane = 0; plane < kWord; ++plane) {
        const std::byte* const from = planes.data() + plane * count;
        for (size_t i = 0; i < count; ++i) words[kWord * i + plane] = from[i];
    }
    std::copy(planes.begin() + static_cast<ptrdiff_t>(count * kWord), planes.end(), words + count * kWord);
}

} // namespace

PieceCoding PieceCoder::fastest(const OfBlob& known, uint64_t bytesPerSecond) {
    const double linkNsPerByte = 1e9 / static_cast<double>(bytesPerSecond);
    PieceCoding best = PieceCoding::Raw;
    double least = linkNsPerByte / kLeastGain;
    for (const PieceCoding coding : {PieceCoding::Zstd, PieceCoding::ZstdPlanes}) {
        const Measured& m = known[static_cast<size_t>(coding)];
        const double time = m.nsPerByte + m.ratio * linkNsPerByte + kDecodingNsPerByte;
        if (time >= least) continue;
        least = time;
        best = coding;
    }
    return best;
}

CodedPiece PieceCoder::coded(PieceCoding coding, std::span<const std::byte> raw, Measured& measured) {
    if (coding == PieceCoding::Raw) return {coding, raw, 0};
    const int64_t begin = now_();
    if (coding == PieceCoding::ZstdPlanes) toPlanes(raw, planes_);
    const std::span<const std::byte> from =
        coding == PieceCoding::ZstdPlanes ? std::span<const std::byte>(planes_) : raw;
    coded_.resize(ZSTD_compressBound(raw.size()));
    const size_t size = ZSTD_compress(coded_.data(), coded_.size(), from.data(), from.size(), kLevel);
    if (ZSTD_isError(size)) return {PieceCoding::Raw, raw, 0}; // out of memory
    const int64_t ns = std::max<int64_t>(now_() - begin, 0);
    measured = {static_cast<double>(ns) / static_cast<double>(raw.size()),
                static_cast<double>(size) / static_cast<double>(raw.size())};
    return {coding, std::span<const std::byte>(coded_).first(size), static_cast<uint32_t>(ns / 1000)};
}

CodedPiece PieceCoder::code(const BlobName& blob, std::span<const std::byte> raw, uint64_t bytesPerSecond) {
    if (bytesPerSecond == 0 || bytesPerSecond > kFastLink || raw.size() < kLeastBytes)
        return {PieceCoding::Raw, raw, 0};
    if (known_.size() >= kMostKnown && !known_.contains(blob)) known_.clear();
    const auto [known, isNew] = known_.try_emplace(blob);
    OfBlob& ofBlob = known->second;
    if (isNew)
        for (const PieceCoding coding : {PieceCoding::Zstd, PieceCoding::ZstdPlanes})
            coded(coding, raw, ofBlob[static_cast<size_t>(coding)]);
    const PieceCoding chosen = fastest(ofBlob, bytesPerSecond);
    const CodedPiece piece = coded(chosen, raw, ofBlob[static_cast<size_t>(chosen)]);
    return piece.bytes.size() < raw.size() ? piece : CodedPiece{PieceCoding::Raw, raw, piece.codingMicroseconds};
}

std::optional<std::span<const std::byte>> decodePiece(PieceCoding coding, std::span<const std::byte> coded,
                                                      size_t rawBytes, std::vector<std::byte>& scratch) {
    if (coding == PieceCoding::Raw) {
        if (coded.size() != rawBytes) return std::nullopt;
        return coded;
    }
    const bool hasPlanes = coding == PieceCoding::ZstdPlanes;
    scratch.resize(hasPlanes ? 2 * rawBytes : rawBytes);
    const size_t size = ZSTD_decompress(scratch.data(), rawBytes, coded.data(), coded.size());
    if (ZSTD_isError(size) || size != rawBytes) return std::nullopt;
    const std::span<const std::byte> bytes(scratch.data(), rawBytes);
    if (!hasPlanes) return bytes;
    fromPlanes(bytes, scratch.data() + rawBytes);
    return std::span<const std::byte>(scratch.data() + rawBytes, rawBytes);
}

} // namespace mural::objects
