#include "nodes/overlay/overlay_font.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

// The bytes of the font, followed by a symbol for their end.
__asm__(".pushsection .rodata\n"
        ".balign 16\n"
        ".global mural_overlay_font\n"
        ".hidden mural_overlay_font\n"
        "mural_overlay_font:\n"
        ".incbin \"" MURAL_OVERLAY_FONT "\"\n"
        ".byte 0\n"
        ".popsection\n");

extern "C" const unsigned char mural_overlay_font[];

namespace mural {

namespace {

constexpr double kLargestHeight = 2000; // of a line, in pixels; limits the memory of a glyph

struct Font {
    stbtt_fontinfo info{};
    int ascent = 0, descent = 0; // in units of the font; descent is negative
    bool isUsable = false;

    Font() {
        isUsable = stbtt_InitFont(&info, mural_overlay_font, stbtt_GetFontOffsetForIndex(mural_overlay_font, 0)) != 0;
        int gap = 0;
        if (isUsable) stbtt_GetFontVMetrics(&info, &ascent, &descent, &gap);
    }
    [[nodiscard]] float scaleOf(double height) const {
        return stbtt_ScaleForPixelHeight(&info, static_cast<float>(height));
    }
};

const Font& font() {
    static const Font loaded;
    return loaded;
}

// Takes the first character of the text. An invalid byte counts as U+FFFD.
int takeCharacter(std::string_view& text) {
    const auto byteAt = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const unsigned first = byteAt(0);
    const size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
    unsigned code = length == 1 ? first : first & (0x7fU >> length);
    bool isValid = length > 0;
    for (size_t i = 1; i < length; ++i) {
        isValid = isValid && byteAt(i) >> 6 == 2;
        code = code << 6 | (byteAt(i) & 63U);
    }
    text.remove_prefix(isValid ? length : 1);
    return isValid ? static_cast<int>(code) : 0xfffd;
}

// Calls visit(glyph, x) for each glyph; x: its place in pixels from the begin. Returns the width.
template <class Visit> double eachGlyph(std::string_view text, float scale, Visit&& visit) {
    double x = 0;
    int before = 0;
    while (!text.empty()) {
        const int glyph = stbtt_FindGlyphIndex(&font().info, takeCharacter(text));
        if (before != 0) x += scale * static_cast<float>(stbtt_GetGlyphKernAdvance(&font().info, before, glyph));
        visit(glyph, x);
        int advance = 0, bearing = 0;
        stbtt_GetGlyphHMetrics(&font().info, glyph, &advance, &bearing);
        x += scale * static_cast<float>(advance);
        before = glyph;
    }
    return x;
}

} // namespace

double overlayTextWidth(std::string_view text, double height) {
    if (!font().isUsable || !(height > 0) || height > kLargestHeight) return 0;
    return eachGlyph(text, font().scaleOf(height), [](int, double) {});
}

void drawOverlayText(OverlayImage& image, std::string_view text, double x, double y, double height,
                     OverlayColour colour) {
    if (!font().isUsable || !(height > 0) || height > kLargestHeight) return;
    const float scale = font().scaleOf(height);
    const double baseline = y - scale * static_cast<float>(font().descent);
    std::vector<unsigned char> bitmap;
    eachGlyph(text, scale, [&](int glyph, double offset) {
        const double left = std::floor(x + offset), bottom = std::floor(baseline);
        const auto shiftX = static_cast<float>(x + offset - left);
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0; // y down from the baseline
        stbtt_GetGlyphBitmapBoxSubpixel(&font().info, glyph, scale, scale, shiftX, 0, &x0, &y0, &x1, &y1);
        const int width = x1 - x0, rows = y1 - y0;
        if (width <= 0 || rows <= 0) return;
        bitmap.assign(static_cast<size_t>(width) * static_cast<size_t>(rows), 0);
        stbtt_MakeGlyphBitmapSubpixel(&font().info, bitmap.data(), width, rows, width, scale, scale, shiftX, 0, glyph);
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < width; ++column)
                if (const unsigned char covered =
                        bitmap[static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column)])
                    image.plot(static_cast<int>(left) + x0 + column, static_cast<int>(bottom) - 1 - (y0 + row), colour,
                               covered / 255.0);
    });
}

} // namespace mural
