#include "economy/pixel_pieces.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/copy_bytes.hpp"
#include "economy/pixel_colours.hpp"
#include "economy/pixel_words.hpp"

namespace mural::economy {
namespace {

// Of twenty parts, so many at most are left of a piece that is like a picture. Others may have what came before, which Zstandard finds as long as
// bytes are where they were: vertices would become twice as large.
constexpr uint32_t kLeftOfTwenty = 13;

// Taken apart, colours are as smooth as they look; grey pixels of three bytes look as smooth byte by byte, too. So these may be rougher, by one part of so many.
constexpr uint32_t kForColours = 32;

// Where a picture is even, edges change all colours, which are more words apart than together. So many bits of its samples are few.
constexpr uint32_t kEvenBits = 2 * kSampledBytes;

size_t bestOf(const Roughness& rough) {
    const auto plain = std::ranges::min_element(rough.begin(), rough.begin() + kPlainWays);
    const auto colours = std::ranges::min_element(rough.begin() + kPlainWays, rough.end());
    const bool apart = *plain >= kEvenBits && *colours * kForColours < *plain * (kForColours + 1);
    return static_cast<size_t>((apart ? colours : plain) - rough.begin());
}

uint8_t wayOf(const std::byte* piece) {
    const auto rough = roughness(piece);
    const size_t best = bestOf(rough);
    return rough[best] * 20 < rough[0] * kLeftOfTwenty ? kPixelWays[best] : uint8_t{0};
}

} // namespace

size_t leftOfPixels(const std::byte* piece) {
    const auto rough = roughness(piece);
    return rough[0] == 0 ? 0 : kPageBytes * rough[bestOf(rough)] / rough[0];
}

bool PixelSplitter::split(std::span<const std::byte> pages) {
    const size_t pieces = pages.size() / kPageBytes;
    front_.resize(pieces);
    pixelPieces_ = 0;
    for (size_t i = 0; i < pieces; ++i) {
        front_[i] = static_cast<std::byte>(wayOf(pages.data() + i * kPageBytes));
        pixelPieces_ += front_[i] != std::byte{0};
    }
    if (pixelPieces_ == 0) return false;
    rest_.clear();
    front_.resize(frontBytes(pages.size(), pixelPieces_));
    if (words_.size() < pixelPieces_ * kPieceWords + kPieceWordRoom) words_.resize(pixelPieces_ * kPieceWords + kPieceWordRoom);
    std::byte* mask = front_.data() + pieces;
    size_t count = 0;
    for (size_t i = 0; i < pieces; ++i) {
        const auto piece = pages.subspan(i * kPageBytes, kPageBytes);
        if (front_[i] == std::byte{0}) {
            rest_.insert(rest_.end(), piece.begin(), piece.end());
            continue;
        }
        const auto way = static_cast<uint8_t>(front_[i]);
        std::byte apart[kPageBytes];
        if (takesColoursApart(way)) takeColoursApart(piece.data(), way, apart);
        count += differences(takesColoursApart(way) ? apart : piece.data(), pixelBytesOf(way), words_.data() + count, mask);
        mask += kPieceMaskBytes;
    }
    const auto last = pages.subspan(pieces * kPageBytes);
    rest_.insert(rest_.end(), last.begin(), last.end());
    planeBytes_ = count * 4;
    if (planes_.size() < planeBytes_) planes_.resize(planeBytes_);
    toPlanes(words_.data(), count, planes_.data());
    return true;
}

size_t frontBytes(size_t pagesBytes, size_t pixelPieces) { return pagesBytes / kPageBytes + pixelPieces * kPieceMaskBytes; }

bool PixelJoiner::begin(std::span<const std::byte> front, size_t pagesBytes, size_t pixelPieces) {
    const size_t pieces = pagesBytes / kPageBytes;
    if (pixelPieces > pieces || front.size() != frontBytes(pagesBytes, pixelPieces)) return false;
    ways_ = front.first(pieces);
    masks_ = front.subspan(pieces);
    pagesBytes_ = pagesBytes;
    pixelPieces_ = 0;
    for (const std::byte b : ways_) {
        if (!isPixelWay(static_cast<uint8_t>(b))) return false;
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

void PixelJoiner::join(std::span<const std::byte> planes, std::span<const std::byte> rest, std::span<std::byte> pages) {
    const size_t count = planeBytes_ / 4;
    if (words_.size() < count + 1) words_.resize(count + 1);
    fromPlanes(planes.data(), count, words_.data());
    const uint32_t* words = words_.data();
    auto masks = masks_;
    for (const std::byte b : ways_) {
        const auto way = static_cast<uint8_t>(b);
        if (way == 0) {
            std::memcpy(pages.data(), rest.data(), kPageBytes);
            rest = rest.subspan(kPageBytes);
        } else {
            std::byte apart[kPageBytes];
            words += sumDifferences(words, masks.data(), pixelBytesOf(way), takesColoursApart(way) ? apart : pages.data());
            if (takesColoursApart(way)) putColoursTogether(apart, way, pages.data());
            masks = masks.subspan(kPieceMaskBytes);
        }
        pages = pages.subspan(kPageBytes);
    }
    copyBytes(rest, pages);
}

} // namespace mural::economy
