#include "compositor/image/region_of_interest.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/base/little_endian.hpp"
#include "compositor/kernels/find_first_difference.hpp"

namespace mural::compositor {

namespace {

struct Pattern {
    uint32_t words[4];
    uint32_t mask[4];
};

Pattern patternOf(const PlaneView& plane, const Background& background) {
    Pattern p{};
    const size_t step = bytesPerPixel(plane.format);
    std::byte repeated[16];
    for (size_t at = 0; at < sizeof repeated; at += step) std::memcpy(repeated + at, background.pixel.data(), step);
    std::memcpy(p.words, repeated, sizeof repeated);
    std::ranges::fill(p.mask, plane.format == PlaneFormat::D24S8 ? 0xffffff00u : 0xffffffffu);
    return p;
}

class TileMarks {
public:
    TileMarks(const PlaneView& plane, int32_t tilePixels)
        : width_(plane.width),
          height_(plane.height),
          tile_(tilePixels),
          columns_((plane.width + tilePixels - 1) / tilePixels),
          rows_((plane.height + tilePixels - 1) / tilePixels),
          marks_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {}

    void markUnlike(const PlaneView& plane, const Pattern& pattern) {
        const size_t wordsPerPixel = bytesPerPixel(plane.format) / 4;
        const size_t tileWords = static_cast<size_t>(tile_) * wordsPerPixel;
        const size_t rowWords = static_cast<size_t>(plane.width) * wordsPerPixel;
        for (int32_t y = 0; y < plane.height; ++y) {
            const auto* words = reinterpret_cast<const uint32_t*>(plane.row(y));
            char* marks = marks_.data() + static_cast<size_t>(y / tile_) * static_cast<size_t>(columns_);
            // Skips marked tiles, and whole runs of background.
            for (size_t at = 0; at < rowWords;) {
                if (marks[at / tileWords]) {
                    at = (at / tileWords + 1) * tileWords;
                    continue;
                }
                at += findFirstDifference(words + at, rowWords - at, pattern.words, pattern.mask);
                if (at < rowWords) marks[at / tileWords] = 1;
                at = (at / tileWords + 1) * tileWords;
            }
        }
    }

    // Runs of tiles become rectangles; equal runs in consecutive rows are merged.
    [[nodiscard]] Region region() const {
        Region found;
        std::vector<PixelViewport> open, next; // rectangles that end in the row below
        for (int32_t row = 0; row < rows_; ++row) {
            next.clear();
            const int32_t y0 = row * tile_, y1 = std::min(height_, y0 + tile_);
            for (int32_t c = 0; c < columns_;) {
                if (!marked(row, c)) {
                    ++c;
                    continue;
                }
                const int32_t from = c;
                while (c < columns_ && marked(row, c)) ++c;
                PixelViewport run{from * tile_, y0, std::min(width_, c * tile_) - from * tile_, y1 - y0};
                const auto below =
                    std::ranges::find_if(open, [&](const PixelViewport& o) { return o.x == run.x && o.w == run.w; });
                if (below != open.end()) {
                    run.y = below->y;
                    run.h += below->h;
                    open.erase(below);
                }
                next.push_back(run);
            }
            for (const PixelViewport& done : open) found.add(done);
            open.swap(next);
        }
        for (const PixelViewport& done : open) found.add(done);
        return found;
    }

private:
    [[nodiscard]] bool marked(int32_t row, int32_t column) const {
        return marks_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)] != 0;
    }
    int32_t width_, height_, tile_, columns_, rows_;
    std::vector<char> marks_;
};

} // namespace

Background Background::ofWord(uint32_t word) {
    Background b;
    std::memcpy(b.pixel.data(), &word, sizeof word);
    return b;
}

Region findRegionOfInterest(const PlaneView& plane, const Background& background, int32_t tilePixels) {
    TileMarks marks(plane, tilePixels);
    marks.markUnlike(plane, patternOf(plane, background));
    return marks.region();
}

Region findRegionOfInterest(const PlaneView& colour, const Background& colourBackground, const PlaneView& depth,
                            const Background& depthBackground, int32_t tilePixels) {
    TileMarks marks(colour, tilePixels);
    marks.markUnlike(colour, patternOf(colour, colourBackground));
    marks.markUnlike(depth, patternOf(depth, depthBackground));
    return marks.region();
}

} // namespace mural::compositor
