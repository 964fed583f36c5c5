#include "streamcodec/delta/entropy/pixel_filter.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/base/copy_bytes.hpp"
#include "streamcodec/delta/entropy/green_subtraction.hpp"
#include "streamcodec/delta/entropy/pixel_deltas.hpp"
#include "streamcodec/delta/entropy/section_codec.hpp"

namespace mural::delta {
namespace {

// A piece is a picture if filtering leaves at most this many twentieths. Other pieces may repeat earlier data, which
// Zstandard finds only unfiltered: vertices would double in size.
constexpr uint32_t kLeftOfTwenty = 13;

// Additional tolerance, as a fraction of 1/kForColours, for green subtraction: grey pixels of three bytes look equally
// smooth byte by byte.
constexpr uint32_t kForColours = 32;

// In uniform pictures an edge changes all colours, which are more words after the split. A piece with at most this many
// sample bits is uniform.
constexpr uint32_t kEvenBits = 2 * kSampledBytes;

// Parts of uniform pictures may repeat: letters, dotted lines, tiles. Zstandard finds more repeats in such pixels than
// in their differences, so they stay unfiltered. LZ4 decides on two samples of kEvenPieces pieces: they must shrink to
// 1/kLeftOfEven. Above that, Zstandard compresses better than LZ4 predicts.
constexpr size_t kEvenPieces = 4, kLeftOfEven = 8;

size_t bestOf(const Roughness& rough) {
    const auto plain = std::ranges::min_element(rough.begin(), rough.begin() + kByteFilters);
    const auto colours = std::ranges::min_element(rough.begin() + kByteFilters, rough.end());
    const bool apart = *plain >= kEvenBits && *colours * kForColours < *plain * (kForColours + 1);
    return static_cast<size_t>((apart ? colours : plain) - rough.begin());
}

struct ChosenFilter {
    uint8_t filter = 0;
    uint32_t roughness = 0; // estimated bits after the filter
};

ChosenFilter chooseFilter(const std::byte* piece) {
    const auto rough = roughness(piece);
    const size_t best = bestOf(rough);
    return rough[best] * 20 < rough[0] * kLeftOfTwenty ? ChosenFilter{kPixelFilters[best], rough[best]}
                                                       : ChosenFilter{};
}

// Size without run lengths: LZ4 spends a byte per 255 bytes of a run, Zstandard none.
size_t beyondRuns(std::span<const std::byte> bytes, std::vector<std::byte>& scratch) {
    const size_t coded = bytes.empty() ? 0 : lz4Bytes(bytes, scratch), ofRuns = bytes.size() / 255;
    return coded - std::min(coded, ofRuns);
}

} // namespace

size_t leftOfPixels(const std::byte* piece) {
    const auto rough = roughness(piece);
    return rough[0] == 0 ? 0 : kPageBytes * rough[bestOf(rough)] / rough[0];
}

bool PixelFilterEncoder::split(std::span<const std::byte> pages) {
    const size_t pieces = pages.size() / kPageBytes;
    filters_.resize(pieces);
    size_t pixelPieces = 0;
    uint64_t left = 0;
    for (size_t i = 0; i < pieces; ++i) {
        const ChosenFilter filter = chooseFilter(pages.data() + i * kPageBytes);
        filters_[i] = filter.filter;
        pixelPieces += filter.filter != 0;
        left += filter.roughness;
    }
    if (pixelPieces == 0 || (left < pixelPieces * kEvenBits && repeats(pages))) return false;
    takeApart(pages, filters_);
    return true;
}

// Estimates with LZ4, which is fast, whether unfiltered data is smaller.
bool PixelFilterEncoder::repeats(std::span<const std::byte> pages) {
    const size_t all = filters_.size(), pieces = std::min(kEvenPieces, (all + 1) / 2), before = (all - pieces) / 3;
    size_t asIs = 0, apart = 0;
    for (const size_t first : {before, all - pieces - before}) {
        const auto sample = pages.subspan(first * kPageBytes, pieces * kPageBytes);
        takeApart(sample, std::span(filters_).subspan(first, pieces));
        for (const auto part : {front(), planes(), rest()}) apart += beyondRuns(part, scratch_);
        asIs += beyondRuns(sample, scratch_);
    }
    return asIs < apart && asIs * kLeftOfEven < 2 * pieces * kPageBytes;
}

void PixelFilterEncoder::takeApart(std::span<const std::byte> pages, std::span<const uint8_t> filters) {
    const size_t pieces = filters.size();
    pixelPieces_ = pieces - static_cast<size_t>(std::ranges::count(filters, uint8_t{0}));
    rest_.clear();
    front_.resize(frontBytes(pages.size(), pixelPieces_));
    if (words_.size() < pixelPieces_ * kPieceWords + kPieceWordRoom)
        words_.resize(pixelPieces_ * kPieceWords + kPieceWordRoom);
    std::byte* mask = front_.data() + pieces;
    size_t count = 0;
    for (size_t i = 0; i < pieces; ++i) {
        const auto piece = pages.subspan(i * kPageBytes, kPageBytes);
        const uint8_t filter = filters[i];
        front_[i] = static_cast<std::byte>(filter);
        if (filter == 0) {
            rest_.insert(rest_.end(), piece.begin(), piece.end());
            continue;
        }
        std::byte apart[kPageBytes];
        if (takesColoursApart(filter)) subtractGreen(piece.data(), filter, apart);
        count += differences(takesColoursApart(filter) ? apart : piece.data(), pixelBytesOf(filter),
                             words_.data() + count, mask);
        mask += kPieceMaskBytes;
    }
    const auto last = pages.subspan(pieces * kPageBytes);
    rest_.insert(rest_.end(), last.begin(), last.end());
    planeBytes_ = count * 4;
    if (planes_.size() < planeBytes_) planes_.resize(planeBytes_);
    toPlanes(words_.data(), count, planes_.data());
}

size_t frontBytes(size_t pagesBytes, size_t pixelPieces) {
    return pagesBytes / kPageBytes + pixelPieces * kPieceMaskBytes;
}

bool PixelFilterDecoder::begin(std::span<const std::byte> front, size_t pagesBytes, size_t pixelPieces) {
    const size_t pieces = pagesBytes / kPageBytes;
    if (pixelPieces > pieces || front.size() != frontBytes(pagesBytes, pixelPieces)) return false;
    filters_ = front.first(pieces);
    masks_ = front.subspan(pieces);
    pagesBytes_ = pagesBytes;
    pixelPieces_ = 0;
    for (const std::byte b : filters_) {
        if (!isPixelFilter(static_cast<uint8_t>(b))) return false;
        pixelPieces_ += b != std::byte{0};
    }
    if (pixelPieces_ != pixelPieces) return false;
    size_t bits = 0;
    for (size_t i = 0; i < masks_.size(); i += 8) {
        uint64_t eight = 0;
        std::memcpy(&eight, masks_.data() + i, 8);
        bits += static_cast<size_t>(std::popcount(eight));
    }
    planeBytes_ = bits * 4;
    return true;
}

void PixelFilterDecoder::join(std::span<const std::byte> planes, std::span<const std::byte> rest,
                              std::span<std::byte> pages) {
    const size_t count = planeBytes_ / 4;
    if (words_.size() < count + 1) words_.resize(count + 1);
    fromPlanes(planes.data(), count, words_.data());
    const uint32_t* words = words_.data();
    auto masks = masks_;
    for (const std::byte b : filters_) {
        const auto filter = static_cast<uint8_t>(b);
        if (filter == 0) {
            std::memcpy(pages.data(), rest.data(), kPageBytes);
            rest = rest.subspan(kPageBytes);
        } else {
            std::byte apart[kPageBytes];
            words += sumDifferences(words, masks.data(), pixelBytesOf(filter),
                                    takesColoursApart(filter) ? apart : pages.data());
            if (takesColoursApart(filter)) addGreen(apart, filter, pages.data());
            masks = masks.subspan(kPieceMaskBytes);
        }
        pages = pages.subspan(kPageBytes);
    }
    copyBytes(rest, pages);
}

} // namespace mural::delta
