// The overlay `names`: host, role, window and area in large text.
#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "nodes/overlay/overlay_font.hpp"
#include "nodes/overlay/overlay_picture.hpp"

namespace mural {

namespace {

constexpr double kBlock = 0.8;       // largest height of all lines, as a part of the window's
constexpr double kLargestLine = 0.4; // of one line
constexpr double kWidth = 0.92;      // largest width of a line
constexpr OverlayColour kBehindNames{0, 0, 0, 170};
constexpr OverlayColour kNames{255, 255, 255, 255};
constexpr OverlayColour kDetails{255, 224, 130, 255};

struct NameLine {
    std::string text;
    double share; // of the block's height
    OverlayColour colour;
};

} // namespace

void drawNames(OverlayImage& image, const OverlayContent& content, const OverlayPlace& place) {
    const std::vector<NameLine> lines = {
        {content.role, 0.42, kNames},
        {content.host, 0.26, kNames},
        {place.title, 0.16, kDetails},
        {fmt::format("{}x{} at {},{}", place.part.w, place.part.h, place.part.x, place.part.y), 0.16, kDetails}};
    const double width = image.width(), block = kBlock * image.height();
    std::vector<double> heights;
    double total = 0, widest = 0;
    for (const NameLine& line : lines) {
        double height = std::min(line.share * block, kLargestLine * image.height());
        // The width grows with the height, but glyphs of a small size are slightly wider.
        if (const double wide = overlayTextWidth(line.text, height); wide > kWidth * width)
            height *= kWidth * width / wide;
        heights.push_back(height);
        total += height;
        widest = std::max(widest, overlayTextWidth(line.text, height));
    }
    const double pad = 0.1 * heights[0];
    const double bottom = (image.height() - total) / 2;
    image.fill({static_cast<int>((width - widest) / 2 - pad), static_cast<int>(bottom - pad),
                static_cast<int>(widest + 2 * pad), static_cast<int>(total + 2 * pad)},
               kBehindNames);
    double top = bottom + total;
    for (size_t i = 0; i < lines.size(); ++i) {
        top -= heights[i];
        drawOverlayText(image, lines[i].text, (width - overlayTextWidth(lines[i].text, heights[i])) / 2, top,
                        heights[i], lines[i].colour);
    }
}

} // namespace mural
