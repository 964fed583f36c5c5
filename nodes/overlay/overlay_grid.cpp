// The overlay `grid`, with which operators adjust projectors and monitors. Its raster and its circles have the wall's
// coordinates, so they continue from window to window.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "nodes/overlay/overlay_font.hpp"
#include "nodes/overlay/overlay_picture.hpp"

namespace mural {

namespace {

constexpr double kStep = 100;       // mm, or pixels without them
constexpr double kSmallestStep = 4; // in pixels; denser millimetres are an error of the configuration
constexpr double kFarthest = 1e8;   // limit of a line's place, in pixels
constexpr int kGreySteps = 16;
constexpr int kEmphasis = 5;                   // each such line is wide and has a label
constexpr OverlayColour kDimmed{0, 0, 0, 150}; // the picture under the grid
constexpr OverlayColour kLine{255, 255, 255, 255};
constexpr OverlayColour kWideLine{255, 224, 130, 110};
constexpr OverlayColour kCircle{0, 220, 255, 255};
constexpr OverlayColour kBorder{0, 255, 0, 255};
constexpr OverlayColour kLabel{255, 224, 130, 255};

class GridPainter {
public:
    GridPainter(OverlayImage& image, const OverlayPlace& place) : image_(image), place_(place) {
        if (place.wallWidthMm <= 0 || place.wallHeightMm <= 0 || place.wallWidth <= 0 || place.wallHeight <= 0) return;
        const double unitsX = place.wallWidthMm / place.wallWidth, unitsY = place.wallHeightMm / place.wallHeight;
        if (kSmallestStep * std::max(unitsX, unitsY) > kStep) return;
        isMetric_ = true;
        unitsX_ = unitsX;
        unitsY_ = unitsY;
    }

    void paint() {
        image_.fill({0, 0, image_.width(), image_.height()}, kDimmed);
        lines();
        circles();
        labels();
        greys();
        image_.frame({0, 0, image_.width(), image_.height()}, kBorder);
    }

private:
    // Returns the pixel of line `number` from the wall's lower left corner, in the window.
    [[nodiscard]] int column(int number) const { return pixelOf(number, unitsX_) - place_.part.x; }
    [[nodiscard]] int row(int number) const { return pixelOf(number, unitsY_) - place_.part.y; }
    static int pixelOf(int number, double units) {
        return static_cast<int>(std::lround(std::min(number * kStep / units, kFarthest)));
    }

    // Returns the number of a line before the window: the wide part or the label of a line may reach into it.
    static int firstLine(int from, double units) {
        return std::max(static_cast<int>(from * units / kStep) - kEmphasis, 0);
    }

    template <class Visit> void eachColumn(Visit&& visit) const {
        for (int i = firstLine(place_.part.x, unitsX_); column(i) <= image_.width(); ++i) visit(i, column(i));
    }
    template <class Visit> void eachRow(Visit&& visit) const {
        for (int i = firstLine(place_.part.y, unitsY_); row(i) <= image_.height(); ++i) visit(i, row(i));
    }

    void lines() {
        eachColumn([&](int number, int x) {
            if (number % kEmphasis == 0) image_.fill({x - 1, 0, 3, image_.height()}, kWideLine);
            image_.fill({x, 0, 1, image_.height()}, kLine);
        });
        eachRow([&](int number, int y) {
            if (number % kEmphasis == 0) image_.fill({0, y - 1, image_.width(), 3}, kWideLine);
            image_.fill({0, y, image_.width(), 1}, kLine);
        });
    }

    // One in the middle of the wall, and one in each corner.
    void circles() {
        const double width = place_.wallWidth * unitsX_, height = place_.wallHeight * unitsY_;
        const double large = 0.45 * std::min(width, height), small = std::min(width, height) / 6;
        circle(width / 2, height / 2, large);
        for (const double x : {small, width - small})
            for (const double y : {small, height - small}) circle(x, y, small);
    }

    void circle(double x, double y, double radius) {
        image_.ring({x / unitsX_ - place_.part.x, y / unitsY_ - place_.part.y, unitsX_, unitsY_, radius, 1}, kCircle);
    }

    // The coordinates of the crossings of wide lines.
    void labels() {
        constexpr double kHeight = 14;
        eachColumn([&](int i, int x) {
            eachRow([&](int j, int y) {
                if (i % kEmphasis != 0 || j % kEmphasis != 0) return;
                const std::string text = fmt::format("{},{}{}", static_cast<int>(i * kStep),
                                                     static_cast<int>(j * kStep), isMetric_ ? " mm" : "");
                drawOverlayText(image_, text, x + 5, y + 4, kHeight, kLabel);
            });
        });
    }

    // Each window has all steps, so that windows can be compared.
    void greys() {
        const int step = image_.width() * 3 / 4 / kGreySteps, height = std::max(image_.height() / 16, 1);
        if (step < 1 || image_.height() < 4) return;
        const int left = (image_.width() - step * kGreySteps) / 2, bottom = image_.height() / 8;
        for (int i = 0; i < kGreySteps; ++i) {
            const auto grey = static_cast<uint8_t>(255 * i / (kGreySteps - 1));
            image_.fill({left + i * step, bottom, step, height}, {grey, grey, grey, 255});
        }
    }

    OverlayImage& image_;
    const OverlayPlace& place_;
    bool isMetric_ = false;
    double unitsX_ = 1, unitsY_ = 1; // per pixel
};

} // namespace

void drawGrid(OverlayImage& image, const OverlayPlace& place) { GridPainter(image, place).paint(); }

} // namespace mural
