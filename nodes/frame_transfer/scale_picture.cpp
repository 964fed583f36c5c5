#include "nodes/frame_transfer/scale_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mural {

namespace {

// Weights of source pixels per target pixel in one direction, as integers of 1/4096, so that all machines round
// equally.
constexpr int64_t kOne = 4096;
constexpr uint32_t kHalf = 1U << 23; // of 2^24, the product of both weights
constexpr size_t kChannels = 4;

class Weights {
public:
    Weights(int32_t begin, int32_t end, double zoom, int32_t from, int32_t count) : from_(from), count_(count) {
        for (int32_t shown = begin; shown < end; ++shown) {
            first_.push_back(parts_.size());
            if (zoom <= 1)
                between(shown, zoom);
            else
                within(shown, zoom);
        }
        first_.push_back(parts_.size());
    }

    struct Part {
        int32_t pixel; // index in the drawn picture
        uint32_t weight;
    };
    [[nodiscard]] size_t size() const { return first_.size() - 1; }
    [[nodiscard]] const Part* begin(size_t shown) const { return parts_.data() + first_[shown]; }
    [[nodiscard]] const Part* end(size_t shown) const { return parts_.data() + first_[shown + 1]; }

private:
    // Extends edge pixels.
    void add(int64_t pixel, int64_t weight) {
        if (weight > 0)
            parts_.push_back(
                {static_cast<int32_t>(std::clamp<int64_t>(pixel, 0, count_ - 1)), static_cast<uint32_t>(weight)});
    }
    void between(int32_t shown, double zoom) {
        constexpr int64_t kSteps = 256;
        const auto at = static_cast<int64_t>(std::lround(((shown + 0.5) * zoom - 0.5 - from_) * kSteps));
        const int64_t part = at & (kSteps - 1);
        add(at >> 8, (kSteps - part) * (kOne / kSteps));
        add((at >> 8) + 1, part * (kOne / kSteps));
    }
    // Weights follow from rounded edges, so that they sum to one.
    void within(int32_t shown, double zoom) {
        const double begin = shown * zoom - from_, end = (shown + 1.0) * zoom - from_;
        const auto edge = [&](double at) {
            return static_cast<int64_t>(std::lround((std::clamp(at, begin, end) - begin) / zoom * kOne));
        };
        for (auto pixel = static_cast<int64_t>(std::floor(begin)); static_cast<double>(pixel) < end; ++pixel)
            add(pixel, edge(static_cast<double>(pixel) + 1) - edge(static_cast<double>(pixel)));
    }

    int32_t from_, count_;
    std::vector<size_t> first_; // index into parts_ per shown pixel
    std::vector<Part> parts_;
};

// Writes the sum of the drawn rows of a shown row, times their weights. At most 255 * kOne per channel.
void weighRows(const Weights& rows, size_t shown, const uint8_t* pixels, size_t rowBytes, std::vector<uint32_t>& line) {
    for (const auto* row = rows.begin(shown); row != rows.end(shown); ++row) {
        const uint8_t* const from = pixels + static_cast<size_t>(row->pixel) * rowBytes;
        const uint32_t weight = row->weight;
        if (row == rows.begin(shown))
            for (size_t i = 0; i < line.size(); ++i) line[i] = from[i] * weight;
        else
            for (size_t i = 0; i < line.size(); ++i) line[i] += from[i] * weight;
    }
}

} // namespace

void scalePicture(const DrawnPicture& from, const Zoom& zoom, const PixelViewport& r, std::byte* into,
                  const PixelViewport& box) {
    if (from.area.empty() || r.empty()) return;
    const Weights columns(r.x, r.right(), zoom.x, from.area.x, from.area.w),
        rows(r.y, r.top(), zoom.y, from.area.y, from.area.h);
    const auto* const pixels = reinterpret_cast<const uint8_t*>(from.pixels);
    // Only the columns of r.
    const auto left = static_cast<size_t>(columns.begin(0)->pixel);
    const auto right = static_cast<size_t>((columns.end(columns.size() - 1) - 1)->pixel) + 1;
    std::vector<uint32_t> line((right - left) * kChannels); // the drawn rows of one shown row, weighted
    for (size_t y = 0; y < rows.size(); ++y) {
        weighRows(rows, y, pixels + left * kChannels, static_cast<size_t>(from.area.w) * kChannels, line);
        auto* to = reinterpret_cast<uint8_t*>(into) +
                   (static_cast<size_t>(r.y - box.y + static_cast<int32_t>(y)) * static_cast<size_t>(box.w) +
                    static_cast<size_t>(r.x - box.x)) *
                       kChannels;
        for (size_t x = 0; x < columns.size(); ++x, to += kChannels) {
            std::array<uint32_t, kChannels> sums;
            sums.fill(kHalf);
            for (const auto* column = columns.begin(x); column != columns.end(x); ++column) {
                const uint32_t* const at = line.data() + (static_cast<size_t>(column->pixel) - left) * kChannels;
                for (size_t c = 0; c < kChannels; ++c) sums[c] += at[c] * column->weight;
            }
            for (size_t c = 0; c < kChannels; ++c) to[c] = static_cast<uint8_t>(sums[c] >> 24);
        }
    }
}

} // namespace mural
