#include "interposer/entry/glx_fonts.hpp"

#include <cstdlib>
#include <cstring>
#include <X11/Xutil.h>

#include <GL/gl.h>

#include "interposer/entry/xlib.hpp"
#include "interposer/encode/real_gl.hpp"

namespace mural {

namespace {

// The required functions of Xlib.
struct FontCalls {
    decltype(&::XQueryFont) queryFont;
    decltype(&::XFreeFontInfo) freeFontInfo;
    decltype(&::XDefaultRootWindow) rootWindow;
    decltype(&::XCreatePixmap) createPixmap;
    decltype(&::XFreePixmap) freePixmap;
    decltype(&::XCreateGC) createGc;
    decltype(&::XFreeGC) freeGc;
    decltype(&::XSetForeground) setForeground;
    decltype(&::XFillRectangle) fillRectangle;
    decltype(&::XDrawString16) drawString;
    decltype(&::XGetImage) getImage;
};

template <class F> bool find(F& function, const char* name) {
    function = reinterpret_cast<F>(xlibSymbol(name));
    return function != nullptr;
}

bool findFontCalls(FontCalls& x) {
    return find(x.queryFont, "XQueryFont") && find(x.freeFontInfo, "XFreeFontInfo") &&
           find(x.rootWindow, "XDefaultRootWindow") && find(x.createPixmap, "XCreatePixmap") &&
           find(x.freePixmap, "XFreePixmap") && find(x.createGc, "XCreateGC") && find(x.freeGc, "XFreeGC") &&
           find(x.setForeground, "XSetForeground") && find(x.fillRectangle, "XFillRectangle") &&
           find(x.drawString, "XDrawString16") && find(x.getImage, "XGetImage");
}

// The GL commands used here, through the program's own entry.
struct ListCalls {
    decltype(&::glNewList) newList;
    decltype(&::glEndList) endList;
    decltype(&::glBitmap) bitmap;
    decltype(&::glPixelStorei) pixelStore;
};

bool findListCalls(ListCalls& gl) {
    gl.newList = reinterpret_cast<decltype(gl.newList)>(wrapperFor("glNewList"));
    gl.endList = reinterpret_cast<decltype(gl.endList)>(wrapperFor("glEndList"));
    gl.bitmap = reinterpret_cast<decltype(gl.bitmap)>(wrapperFor("glBitmap"));
    gl.pixelStore = reinterpret_cast<decltype(gl.pixelStore)>(wrapperFor("glPixelStorei"));
    return gl.newList && gl.endList && gl.bitmap && gl.pixelStore && gReal.glGetIntegerv;
}

// Sets the unpack state for these bitmaps: rows of whole bytes, most significant bit first. Restores it at the end.
class UnpackState {
public:
    explicit UnpackState(const ListCalls& gl) : gl_(gl) {
        for (int i = 0; i < kCount; ++i) {
            gReal.glGetIntegerv(kNames[i], &before_[i]);
            gl_.pixelStore(kNames[i], kNames[i] == GL_UNPACK_ALIGNMENT ? 1 : 0);
        }
    }
    ~UnpackState() {
        for (int i = 0; i < kCount; ++i) gl_.pixelStore(kNames[i], before_[i]);
    }
    UnpackState(const UnpackState&) = delete;
    UnpackState& operator=(const UnpackState&) = delete;

private:
    static constexpr int kCount = 6;
    static constexpr GLenum kNames[kCount] = {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST,   GL_UNPACK_ROW_LENGTH,
                                              GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS, GL_UNPACK_ALIGNMENT};
    const ListCalls& gl_;
    GLint before_[kCount] = {};
};

// The metrics of a character; null if the font lacks it.
const XCharStruct* metricsOf(const XFontStruct& font, unsigned character) {
    unsigned column = character, index = 0;
    if (font.min_byte1 == 0 && font.max_byte1 == 0) { // one row: the character is a plain index
        if (column < font.min_char_or_byte2 || column > font.max_char_or_byte2) return nullptr;
        index = column - font.min_char_or_byte2;
    } else {
        const unsigned row = character >> 8;
        column = character & 0xFF;
        if (row < font.min_byte1 || row > font.max_byte1) return nullptr;
        if (column < font.min_char_or_byte2 || column > font.max_char_or_byte2) return nullptr;
        index = (row - font.min_byte1) * (font.max_char_or_byte2 - font.min_char_or_byte2 + 1) + column -
                font.min_char_or_byte2;
    }
    return font.per_char ? font.per_char + index : &font.max_bounds;
}

// Draws characters of a font and reads their bits from the server.
class GlyphReader {
public:
    GlyphReader(const FontCalls& x, Display* dpy, Font font, const XFontStruct& metrics)
        : x_(x),
          dpy_(dpy),
          width_(metrics.max_bounds.rbearing - metrics.min_bounds.lbearing),
          height_(metrics.max_bounds.ascent + metrics.max_bounds.descent) {
        if (width_ <= 0 || height_ <= 0) return;
        bytes_ =
            static_cast<GLubyte*>(std::malloc((static_cast<size_t>(width_) + 7) / 8 * static_cast<size_t>(height_)));
        if (!bytes_) return;
        pixmap_ =
            x_.createPixmap(dpy, x_.rootWindow(dpy), static_cast<unsigned>(width_), static_cast<unsigned>(height_), 1);
        XGCValues values{};
        values.font = font;
        values.graphics_exposures = False;
        gc_ = x_.createGc(dpy, pixmap_, GCFont | GCGraphicsExposures, &values);
    }
    ~GlyphReader() {
        if (gc_) x_.freeGc(dpy_, gc_);
        if (pixmap_) x_.freePixmap(dpy_, pixmap_);
        std::free(bytes_);
    }
    GlyphReader(const GlyphReader&) = delete;
    GlyphReader& operator=(const GlyphReader&) = delete;

    // Rows from the lowest up, valid until the next call; null if the server returns none.
    const GLubyte* read(unsigned character, const XCharStruct& metrics, int width, int height) {
        if (!gc_ || width > width_ || height > height_) return nullptr;
        const auto w = static_cast<unsigned>(width), h = static_cast<unsigned>(height);
        const XChar2b text = {static_cast<unsigned char>(character >> 8 & 0xFF),
                              static_cast<unsigned char>(character & 0xFF)};
        x_.setForeground(dpy_, gc_, 0);
        x_.fillRectangle(dpy_, pixmap_, gc_, 0, 0, w, h);
        x_.setForeground(dpy_, gc_, 1);
        x_.drawString(dpy_, pixmap_, gc_, -metrics.lbearing, metrics.ascent, &text, 1);
        XImage* image = x_.getImage(dpy_, pixmap_, 0, 0, w, h, 1, XYPixmap);
        if (!image) return nullptr;
        const size_t rowBytes = (static_cast<size_t>(width) + 7) / 8;
        std::memset(bytes_, 0, rowBytes * h);
        for (int y = 0; y < height; ++y) {
            GLubyte* row = bytes_ + rowBytes * static_cast<size_t>(height - 1 - y);
            for (int i = 0; i < width; ++i) {
                if (XGetPixel(image, i, y)) row[i / 8] = static_cast<GLubyte>(row[i / 8] | 0x80 >> i % 8);
            }
        }
        XDestroyImage(image);
        return bytes_;
    }

private:
    const FontCalls& x_;
    Display* dpy_;
    int width_, height_;
    GLubyte* bytes_ = nullptr;
    Pixmap pixmap_ = 0;
    GC gc_ = nullptr;
};

// GLX 1.4, section 3.3.11. A character without ink is an empty bitmap, created as Mesa does: its lists reject that
// bitmap (GL_OUT_OF_MEMORY), which programs observe.
void compileGlyph(const ListCalls& gl, GlyphReader& reader, const XFontStruct& font, unsigned character) {
    const XCharStruct* known = metricsOf(font, character);
    const XCharStruct& m = known ? *known : font.max_bounds;
    const int width = m.rbearing - m.lbearing, height = m.ascent + m.descent;
    const GLubyte* bits = known && width > 0 && height > 0 ? reader.read(character, m, width, height) : nullptr;
    if (bits)
        gl.bitmap(width, height, static_cast<GLfloat>(-m.lbearing), static_cast<GLfloat>(m.descent - 1), m.width, 0,
                  bits);
    else
        gl.bitmap(0, 0, 0, 0, m.width, 0, nullptr);
}

} // namespace

bool listsFromXFont(Display* dpy, Font font, int first, int count, int listBase) {
    FontCalls x;
    ListCalls gl;
    if (!findFontCalls(x) || !findListCalls(gl)) return false;
    XFontStruct* metrics = x.queryFont(dpy, font);
    if (!metrics) return true; // the X server has called the program's error handler
    {
        GlyphReader reader(x, dpy, font, *metrics);
        UnpackState unpack(gl);
        for (int i = 0; i < count; ++i) {
            gl.newList(static_cast<GLuint>(listBase) + static_cast<GLuint>(i), GL_COMPILE);
            compileGlyph(gl, reader, *metrics, static_cast<unsigned>(first) + static_cast<unsigned>(i));
            gl.endList();
        }
    }
    x.freeFontInfo(nullptr, metrics, 1);
    return true;
}

} // namespace mural
