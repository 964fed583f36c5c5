// Drawing the pass of a frame: with shifted samples, every nth pixel, or zoomed.
//
// All three scale and translate window coordinates. Viewports accept fractions, so they transform every draw, with or
// without shaders. OpenGL ES lacks fractional viewports; its shaders transform positions
// (nodes/shaders/moved_position). Source: docs/architecture/passes.md; thesis, "Pixel", "Subpixel" and "zoom".
#include <algorithm>
#include <cstring>

#include "gl_opcodes.hpp"
#include "nodes/frame_transfer/scale_picture.hpp"
#include "nodes/player/pixel_mapping.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

bool Replay::movesByShaders() const { return c_->api != wire::Api::Desktop || !gl.glViewportIndexedf; }

// Returns the pass of a window's buffer, with the zoom that its areas came with.
RenderPass Replay::passOf(const Window& w, bool front) const {
    RenderPass p = config_.pass;
    const ViewportAssignment* const areas = areasOf(w, front);
    if (!config_.movesZoom || !areas || config_.plant == "zoom") return p; // planted fault: never takes a zoom over
    const double zoom = areas->zoomOf(static_cast<size_t>(config_.node));
    p.zoom = {p.zoom.x * zoom, p.zoom.y * zoom};
    return p;
}

// Returns the pass for the current draws. A window whose pixels were copied or read in the previous frame is drawn
// without a kernel. A draw that only shows an already sampled scene is not sampled again (stereo_scenes.cpp).
RenderPass Replay::passOfDraws() const {
    RenderPass p = c_->draw ? passOf(*c_->draw) : config_.pass;
    if (!drawsWindow() || !interleaves(c_->draw))
        p.kernelX = p.kernelY = 0, p.kernelWidth = p.kernelHeight = 1, p.zoom = {};
    if (!drawsScene()) p.sample = 0, p.samples = 1;
    return p;
}

// This node's part of the window in the drawn picture.
PixelViewport Replay::partDrawn(const Window& w, bool front) const {
    const PixelViewport part = front ? partOf(w, areasOf(w, true)) : w.part;
    return interleaves(&w) ? inPass(passOf(w, front), part) : part;
}

// The required size of the framebuffer: large enough for the drawn and the shown picture. The zoom of the pass is the
// largest one. Pictures with smaller zooms use the lower left corner of the framebuffer.
PixelViewport Replay::surfaceOf(const Window& w, bool lean) const {
    const PixelViewport shown = lean ? w.part : w.whole, drawn = inPass(config_.pass, shown);
    return {0, 0, std::max({shown.w, drawn.w, 1}), std::max({shown.h, drawn.h, 1})};
}

// Reads pixels `r` of the output picture from a window drawn at another size. Pixels of other nodes are not available:
// edge pixels of this node's part are extended.
const std::byte* Replay::readScaled(Window& w, const PixelViewport& r, bool front) {
    const RenderPass p = passOf(w, front);
    const PixelViewport part = front ? partOf(w, areasOf(w, true)) : w.part;
    const PixelViewport all = inShown(p, part), area = w.plain ? inKernel(p, part) : regionOf(w, front);
    const Zoom drawnBy = w.plain ? Zoom{} : p.zoom;
    std::vector<std::byte> drawn(static_cast<size_t>(area.area()) * 4);
    if (!drawn.empty())
        std::memcpy(drawn.data(), w.plain && hasKernel() ? readEveryNth(w, area, front) : readShown(w, area, front),
                    drawn.size());
    std::vector<std::byte> shown(static_cast<size_t>(r.area()) * 4);
    if (!drawn.empty())
        scalePicture({drawn.data(), area}, {drawnBy.x / p.shown.x, drawnBy.y / p.shown.y}, intersect(r, all),
                     shown.data(), r);
    pixels_ = std::move(shown);
    return pixels_.data();
}

// Reads the pass's pixels `r` from a window drawn without the kernel.
const std::byte* Replay::readEveryNth(Window& w, const PixelViewport& r, bool front) {
    const RenderPass& p = config_.pass;
    const PixelViewport from = shownByKernel(p, r);
    const std::byte* all = readShown(w, from, front);
    std::vector<std::byte> picked(static_cast<size_t>(r.area()) * 4);
    for (int32_t y = 0; y < r.h; ++y)
        for (int32_t x = 0; x < r.w; ++x)
            std::memcpy(&picked[(static_cast<size_t>(y) * static_cast<size_t>(r.w) + static_cast<size_t>(x)) * 4],
                        all + (static_cast<size_t>(y * p.kernelHeight) * static_cast<size_t>(from.w) +
                               static_cast<size_t>(x * p.kernelWidth)) *
                                  4,
                        4);
    pixels_ = std::move(picked);
    return pixels_.data();
}

// Returns pixels of a window with every nth pixel drawn, for a program's read. Each pixel is repeated for its
// neighbours.
const std::byte* Replay::readRepeated(const PixelViewport& part, bool front, GLenum format, GLenum type, size_t group) {
    const RenderPass p = passOf(*c_->read, front);
    const PixelViewport picture = inPass(p, c_->read->whole);
    const PixelViewport from = intersect(standingFor(p, part), picture);
    if (!from.empty()) (void)readRegion(from, format, type, static_cast<size_t>(from.area()) * group);
    const std::vector<std::byte> few = pixels_;
    pixels_.assign(static_cast<size_t>(part.area()) * group, std::byte{0});
    if (from.empty()) return pixels_.data(); // too small to contain a pixel
    for (int32_t y = 0; y < part.h; ++y)
        for (int32_t x = 0; x < part.w; ++x) {
            const PassPixel at = standingFor(p, part.x + x, part.y + y);
            const auto fx = static_cast<size_t>(std::clamp(at.x - from.x, 0, from.w - 1)),
                       fy = static_cast<size_t>(std::clamp(at.y - from.y, 0, from.h - 1));
            std::memcpy(
                &pixels_[(static_cast<size_t>(y) * static_cast<size_t>(part.w) + static_cast<size_t>(x)) * group],
                &few[(fy * static_cast<size_t>(from.w) + fx) * group], group);
        }
    return pixels_.data();
}

void Replay::applyMovedViewports() {
    const RenderPass p = passOfDraws();
    for (GLuint i = 0; i < replay::kViewports; ++i) {
        const auto& v = c_->viewports[i];
        const auto at = placeInPass(p, v[0], v[1]);
        gl.glViewportIndexedf(i, static_cast<GLfloat>(at[0]), static_cast<GLfloat>(at[1]),
                              v[2] * static_cast<GLfloat>(p.zoom.x / p.kernelWidth),
                              v[3] * static_cast<GLfloat>(p.zoom.y / p.kernelHeight));
    }
}

// Values for shaders::kMoveUniform.
std::array<GLfloat, 20> Replay::moveOf(GLuint program) const {
    std::array<GLfloat, 20> move{};
    if (movesPicture() && movesByShaders())
        std::ranges::copy(moveInViewport(passOfDraws(), c_->viewports[0]), move.begin());
    if (!movesView()) return move;
    const ClipTransform view = viewMove(projectionOf(program));
    const auto put = [&](size_t at, const std::array<double, 4>& row) {
        std::ranges::transform(row, move.begin() + static_cast<long>(at),
                               [](double v) { return static_cast<GLfloat>(v); });
    };
    put(4, view.x);
    put(8, view.y);
    put(12, view.w);
    move[16] = static_cast<GLfloat>(view.z);
    return move;
}

} // namespace mural
