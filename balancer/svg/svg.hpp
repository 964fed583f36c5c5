// Builds an SVG picture shape by shape. Later shapes cover earlier ones; background shapes go to `below`.
#pragma once

#include <string>
#include <string_view>

namespace mural::drawing {

struct Point {
    double x = 0;
    double y = 0;
};

struct Box {
    double x = 0;
    double y = 0; // from the top, as in SVG
    double w = 0;
    double h = 0;
    [[nodiscard]] double right() const { return x + w; }
    [[nodiscard]] double bottom() const { return y + h; }
};

struct Style {
    std::string fill = "none";
    std::string stroke = "none";
    double strokeWidth = 1;
    double rounding = 0;
    std::string dash = {}; // "4 3"
    double opacity = 1;
};

enum class Align { Left, Middle, Right };

struct Font {
    double size = 11;
    std::string color = "#1f2933";
    bool bold = false;
    Align align = Align::Left;
};

class Svg {
public:
    // tip: tooltip text.
    void rect(const Box& box, const Style& style, std::string_view tip = {});
    // at: left, middle or right end of the baseline, depending on the alignment. Text wider than `width` is truncated.
    void text(Point at, std::string_view text, const Font& font, double width = 1e9);
    void line(Point from, Point to, const Style& style);
    // Draws a Bézier curve from `from` (towards `fromHandle`) to `to` (from `toHandle`) with an arrowhead.
    void arrow(Point from, Point fromHandle, Point toHandle, Point to, const Style& style, std::string_view tip = {});

    // Returns the complete document.
    [[nodiscard]] std::string finish(double width, double height) const;

    static double widthOf(std::string_view text, double fontSize);

private:
    std::string shapes_;
};

} // namespace mural::drawing
