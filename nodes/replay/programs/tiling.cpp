#include "nodes/replay/programs/tiling.hpp"

#include <cmath>

#include "nodes/player/pixel_mapping.hpp"

namespace mural {

namespace {

// GL may silently clamp larger viewports, after which the positions of fragments are unknown.
constexpr GLfloat kLargestViewport = 16384;

bool known(const std::array<GLfloat, 4>& v) {
    for (const GLfloat value : v) {
        if (!(std::fabs(value) <= kLargestViewport)) return false;
    }
    return v[2] >= 1 && v[3] >= 1;
}

} // namespace

TileValues tileValues(const TilePlace& p) {
    TileValues values;
    const PixelViewport framebuffer = p.translated ? p.tile : p.window;
    const PassMapping to = passToWindow(p.pass);
    values.place = {static_cast<GLfloat>(to.scale[0] * framebuffer.x + to.from[0]),
                    static_cast<GLfloat>(to.scale[1] * framebuffer.y + to.from[1]),
                    static_cast<GLfloat>(p.window.top() - to.scale[1] * framebuffer.top() - to.from[1]),
                    0,
                    static_cast<GLfloat>(to.scale[0] - 1),
                    static_cast<GLfloat>(to.scale[1] - 1),
                    static_cast<GLfloat>(1 / to.scale[0] - 1),
                    static_cast<GLfloat>(1 / to.scale[1] - 1)};
    if (!p.mayCull || p.tile == p.window || !known(p.viewport)) return values;
    // Window coordinate x is at 2 (x - vx) / vw - 1 within the viewport's -1 to 1.
    const auto edge = [](double position, GLfloat from, GLfloat size) {
        return static_cast<GLfloat>(2 * (position - from) / size - 1);
    };
    const auto& v = p.viewport;
    const double m = p.marginPixels;
    values.cull = {edge(p.tile.x - m, v[0], v[2]),
                   edge(p.tile.right() + m, v[0], v[2]),
                   edge(p.tile.y - m, v[1], v[3]),
                   edge(p.tile.top() + m, v[1], v[3]),
                   1,
                   p.marginPixels,
                   2 / v[2],
                   2 / v[3]};
    return values;
}

} // namespace mural
