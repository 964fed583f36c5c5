#include "nodes/overlay/overlay_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mural {

namespace {

// Divides two products of bytes, in the lower halves of 16 bits each, by 255, rounded to the nearest value.
constexpr uint32_t dividedPair(uint32_t products) {
    const uint32_t sum = products + 0x00800080;
    return (sum + (sum >> 8 & 0x00ff00ff)) >> 8 & 0x00ff00ff;
}

// The components of a word are blue (lowest), green, red and alpha, multiplied with alpha.
constexpr uint32_t drawnOver(uint32_t below, uint32_t above) {
    const uint32_t through = 255 - (above >> 24);
    return above +
           (dividedPair((below & 0x00ff00ff) * through) | dividedPair((below >> 8 & 0x00ff00ff) * through) << 8);
}

constexpr uint32_t wordOf(OverlayColour colour, unsigned alpha) {
    const uint32_t blueRed = colour.blue | uint32_t{colour.red} << 16, greenAlpha = colour.green | 0x00ff0000;
    return dividedPair(blueRed * alpha) | dividedPair(greenAlpha * alpha) << 8;
}

#ifdef __clang__
#define MURAL_VECTORIZED // clang uses vector instructions at -O2, too
#else
#define MURAL_VECTORIZED __attribute__((optimize("O3")))
#endif

// It has no branches, so compilers use vector instructions.
MURAL_VECTORIZED void drawRow8(const uint32_t* from, std::byte* to, size_t pixels) {
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t below = 0;
        std::memcpy(&below, to + 4 * i, sizeof below);
        below = drawnOver(below, from[i]);
        std::memcpy(to + 4 * i, &below, sizeof below);
    }
}

// Does the same for a picture with 10 bits per colour.
void drawRow10(const uint32_t* from, std::byte* to, size_t pixels) {
    for (size_t i = 0; i < pixels; ++i) {
        const uint32_t above = from[i], alpha = above >> 24;
        if (alpha == 0) continue;
        uint32_t word = 0;
        std::memcpy(&word, to + 4 * i, sizeof word);
        const auto mixed = [alpha](uint32_t below, uint32_t colour, uint32_t most) {
            return (below * (255 - alpha) + (colour & 255) * most + 127) / 255;
        };
        word = mixed(word & 1023, above, 1023) | mixed(word >> 10 & 1023, above >> 8, 1023) << 10 |
               mixed(word >> 20 & 1023, above >> 16, 1023) << 20 | mixed(word >> 30, alpha, 3) << 30;
        std::memcpy(to + 4 * i, &word, sizeof word);
    }
}

} // namespace

OverlayImage::OverlayImage(int width, int height)
    : width_(std::max(width, 0)),
      height_(std::max(height, 0)),
      pixels_(static_cast<size_t>(width_) * static_cast<size_t>(height_)),
      rows_(static_cast<size_t>(height_)) {}

std::array<uint8_t, 4> OverlayImage::pixel(int x, int y) const {
    const uint32_t p = pixels_[at(x, y)];
    return {static_cast<uint8_t>(p >> 16), static_cast<uint8_t>(p >> 8), static_cast<uint8_t>(p),
            static_cast<uint8_t>(p >> 24)};
}

// Requires a part that is not empty.
void OverlayImage::widen(int y, int first, int end) {
    Extent& row = rows_[static_cast<size_t>(y)];
    row = row.first == row.end ? Extent{first, end} : Extent{std::min(row.first, first), std::max(row.end, end)};
}

void OverlayImage::plot(int x, int y, OverlayColour colour, double coverage) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || coverage <= 0) return;
    widen(y, x, x + 1);
    uint32_t& pixel = pixels_[at(x, y)];
    pixel =
        drawnOver(pixel, wordOf(colour, static_cast<unsigned>(std::lround(std::min(coverage, 1.0) * colour.alpha))));
}

void OverlayImage::fill(PixelViewport area, OverlayColour colour) {
    const PixelViewport inside = intersect(area, {0, 0, width_, height_});
    if (inside.empty()) return;
    const uint32_t word = wordOf(colour, colour.alpha);
    for (int y = inside.y; y < inside.top(); ++y) {
        widen(y, inside.x, inside.right());
        uint32_t* const row = &pixels_[at(inside.x, y)];
        for (int x = 0; x < inside.w; ++x) row[x] = drawnOver(row[x], word);
    }
}

void OverlayImage::frame(PixelViewport area, OverlayColour colour) {
    if (area.empty()) return;
    fill({area.x, area.y, area.w, 1}, colour);
    if (area.h > 1) fill({area.x, area.top() - 1, area.w, 1}, colour);
    if (area.h <= 2) return;
    fill({area.x, area.y + 1, 1, area.h - 2}, colour);
    if (area.w > 1) fill({area.right() - 1, area.y + 1, 1, area.h - 2}, colour);
}

// Visits only pixels near the line: in each row, between the inner and the outer circle.
void OverlayImage::ring(const Ring& r, OverlayColour colour) {
    const double units = (r.scaleX + r.scaleY) / 2, margin = (r.halfWidth + 1) * units;
    const double outer = r.radius + margin, inner = std::max(r.radius - margin, 0.0);
    const int lowest = std::max(static_cast<int>(std::floor(r.y - outer / r.scaleY)), 0);
    const int highest = std::min(static_cast<int>(std::ceil(r.y + outer / r.scaleY)), height_ - 1);
    for (int y = lowest; y <= highest; ++y) {
        const double dy = (y + 0.5 - r.y) * r.scaleY;
        if (std::abs(dy) > outer) continue;
        const double reach = std::sqrt(outer * outer - dy * dy) / r.scaleX;
        const double hole = std::sqrt(std::max(inner * inner - dy * dy, 0.0)) / r.scaleX;
        const auto arc = [&](double from, double to) {
            const int first = std::max(static_cast<int>(std::floor(from)), 0);
            const int last = std::min(static_cast<int>(std::ceil(to)), width_);
            for (int x = first; x < last; ++x) {
                const double distance = std::hypot((x + 0.5 - r.x) * r.scaleX, dy) - r.radius;
                plot(x, y, colour, r.halfWidth + 0.5 - std::abs(distance) / units);
            }
        };
        if (std::ceil(r.x - hole) >= std::floor(r.x + hole)) {
            arc(r.x - reach, r.x + reach);
        } else {
            arc(r.x - reach, r.x - hole);
            arc(r.x + hole, r.x + reach);
        }
    }
}

void OverlayImage::drawOver(std::byte* pixels, PictureFormat format) const {
    for (int y = 0; y < height_; ++y) {
        const Extent row = rows_[static_cast<size_t>(y)];
        if (row.first == row.end) continue;
        const auto drawRow = format == PictureFormat::Bgra8 ? drawRow8 : drawRow10;
        drawRow(&pixels_[at(row.first, y)], pixels + 4 * at(row.first, y), static_cast<size_t>(row.end - row.first));
    }
}

} // namespace mural
