#include "interposer/readback/read_area.hpp"

#include <GL/glext.h>
#include <cstring>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

// A read of one pixel outside the framebuffer leaves memory unchanged.
bool isInside(GLint x, GLint y, GLenum format, GLenum type) {
    unsigned char once[64], again[64];
    std::memset(once, 0, sizeof once);
    std::memset(again, 0xff, sizeof again);
    gReal.glReadPixels(x, y, 1, 1, format, type, once);
    gReal.glReadPixels(x, y, 1, 1, format, type, again);
    const uint32_t bytes = sizes::groupBytes(format, type);
    return bytes > sizeof once || std::memcmp(once, again, bytes) == 0;
}

// Bisection: the first outside position between `low`, which is inside, and `high`, which is outside.
template <class Inside> GLint firstOutside(GLint low, GLint high, Inside&& inside) {
    while (high - low > 1) {
        const GLint middle = low + (high - low) / 2;
        (inside(middle) ? low : high) = middle;
    }
    return high;
}

// No GL version reports the size of a framebuffer object, so its edges are searched.
bool cutToObject(Context& c, GLenum format, GLenum type, ReadArea& area, GLint x1, GLint y1) {
    stashError(c, driverError());
    const TightPack pack(c);
    if (!pack.ready() || isInside(x1 - 1, y1 - 1, format, type)) return true;
    if (!isInside(area.x, area.y, format, type)) return false;
    if (!isInside(x1 - 1, area.y, format, type))
        area.w = firstOutside(area.x, x1 - 1, [&](GLint x) { return isInside(x, area.y, format, type); }) - area.x;
    if (!isInside(area.x, y1 - 1, format, type))
        area.h = firstOutside(area.y, y1 - 1, [&](GLint y) { return isInside(area.x, y, format, type); }) - area.y;
    return true;
}

} // namespace

bool readsWindow(const Context& c) {
    GLint framebuffer = 0;
    gReal.glGetIntegerv(c.api == wire::Api::Desktop || c.version >= 30 ? GL_READ_FRAMEBUFFER_BINDING
                                                                       : GL_FRAMEBUFFER_BINDING,
                        &framebuffer);
    return framebuffer == 0;
}

bool cutToReadFramebuffer(Context& c, GLenum format, GLenum type, ReadArea& area) {
    const bool ofWindow = readsWindow(c);
    const Window* window = ofWindow ? findWindowById(c.readWindow) : nullptr;
    if (ofWindow && !window) return true;
    constexpr int64_t kFar = 1 << 20; // larger than any framebuffer
    const int64_t width = window ? window->config.width : kFar, height = window ? window->config.height : kFar;
    const int64_t x1 = int64_t{area.x} + area.w < width ? int64_t{area.x} + area.w : width;
    const int64_t y1 = int64_t{area.y} + area.h < height ? int64_t{area.y} + area.h : height;
    area.x = area.x < 0 ? 0 : area.x;
    area.y = area.y < 0 ? 0 : area.y;
    if (x1 <= area.x || y1 <= area.y) return false;
    area.w = static_cast<GLsizei>(x1 - area.x);
    area.h = static_cast<GLsizei>(y1 - area.y);
    return ofWindow || cutToObject(c, format, type, area, static_cast<GLint>(x1), static_cast<GLint>(y1));
}

} // namespace mural
