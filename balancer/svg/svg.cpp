#include "balancer/svg/svg.hpp"

#include <cmath>
#include <fmt/format.h>

namespace mural::drawing {

namespace {

// Average letter width of sans-serif fonts, relative to the font size.
constexpr double kLetterWidth = .54;
constexpr double kBolder = 1.14; // width of bold letters, relative to regular ones

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= ' ')
            out += c;
        else
            out += ' ';
    }
    return out;
}

std::string attributes(const Style& s) {
    std::string text = fmt::format(" fill=\"{}\" stroke=\"{}\"", s.fill, s.stroke);
    if (s.stroke != "none") text += fmt::format(" stroke-width=\"{:.4g}\"", s.strokeWidth);
    if (s.rounding > 0) text += fmt::format(" rx=\"{:.4g}\"", s.rounding);
    if (!s.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", s.dash);
    if (s.opacity < 1) text += fmt::format(" opacity=\"{:.3g}\"", s.opacity);
    return text;
}

std::string tipOf(std::string_view tip) { return tip.empty() ? std::string() : "<title>" + escaped(tip) + "</title>"; }

// Truncates at a character boundary, never within a UTF-8 sequence.
std::string cut(std::string_view text, double width, double fontSize) {
    const auto letters = static_cast<size_t>(std::max(1., width / (fontSize * kLetterWidth)));
    size_t count = 0, at = 0, end = text.size();
    for (; at < text.size(); ++at) {
        if ((static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) continue;
        if (++count == letters) end = at;
    }
    return count <= letters ? std::string(text) : std::string(text.substr(0, end)) + "…";
}

} // namespace

double Svg::widthOf(std::string_view text, double fontSize) {
    return static_cast<double>(text.size()) * fontSize * kLetterWidth;
}

void Svg::rect(const Box& b, const Style& style, std::string_view tip) {
    shapes_ += fmt::format("<rect x=\"{:.6g}\" y=\"{:.6g}\" width=\"{:.6g}\" height=\"{:.6g}\"{}", b.x, b.y,
                           std::max(0., b.w), std::max(0., b.h), attributes(style));
    shapes_ += tip.empty() ? "/>\n" : ">" + tipOf(tip) + "</rect>\n";
}

void Svg::text(Point at, std::string_view text, const Font& font, double width) {
    const char* anchor = font.align == Align::Middle ? "middle" : font.align == Align::Right ? "end" : "start";
    const std::string shown = cut(text, font.bold ? width / kBolder : width, font.size);
    shapes_ += fmt::format(
        "<text x=\"{:.6g}\" y=\"{:.6g}\" font-size=\"{:.4g}\" fill=\"{}\" text-anchor=\"{}\"{}>{}{}</text>\n", at.x,
        at.y, font.size, font.color, anchor, font.bold ? " font-weight=\"bold\"" : "", escaped(shown),
        shown == text ? "" : tipOf(text));
}

void Svg::line(Point from, Point to, const Style& style) {
    shapes_ += fmt::format("<line x1=\"{:.6g}\" y1=\"{:.6g}\" x2=\"{:.6g}\" y2=\"{:.6g}\"{}/>\n", from.x, from.y, to.x,
                           to.y, attributes(style));
}

void Svg::arrow(Point from, Point fromHandle, Point toHandle, Point to, const Style& style, std::string_view tip) {
    // The arrowhead is a separate triangle, because not every viewer colours SVG markers like their line.
    const double length = std::max(1e-6, std::hypot(to.x - toHandle.x, to.y - toHandle.y));
    const double dx = (to.x - toHandle.x) / length, dy = (to.y - toHandle.y) / length, size = 4 + style.strokeWidth;
    const Point neck{to.x - dx * size, to.y - dy * size};
    shapes_ += fmt::format("<g>{}<path d=\"M{:.6g} {:.6g} C{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\"{}/>", tipOf(tip),
                           from.x, from.y, fromHandle.x, fromHandle.y, toHandle.x, toHandle.y, neck.x, neck.y,
                           attributes(style));
    shapes_ += fmt::format("<path d=\"M{:.6g} {:.6g} L{:.6g} {:.6g} L{:.6g} {:.6g} Z\" fill=\"{}\"/></g>\n", to.x, to.y,
                           neck.x - dy * size * .5, neck.y + dx * size * .5, neck.x + dy * size * .5,
                           neck.y - dx * size * .5, style.stroke);
}

std::string Svg::finish(double width, double height) const {
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
                       "{0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n"
                       "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
                       width, height, shapes_);
}

} // namespace mural::drawing
