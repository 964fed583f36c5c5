// Drawing a pass of a frame: another place of the samples in their pixels, or every nth pixel only.
//
// Both are a scale and an offset of window coordinates, and viewports take fractions: whatever draws, shaders or not,
// is moved by them. OpenGL ES has no such viewports: there shaders move positions (nodes/shaders/moved_position).
// Source: accuracy 2.5; thesis, "Pixel" and "Subpixel".
#include <algorithm>
#include <cstring>

#include "nodes/replay/replay.hpp"

namespace mural {

bool Replay::movesByShaders() const { return movesPicture() && (c_->api != wire::Api::Desktop || !gl.glViewportIndexedf); }

// A window whose pixels are copied or read, in the frame before, is drawn as if there were no kernel.
RenderPass Replay::passOfWindow() const {
    RenderPass p = config_.pass;
    if (!interleaves(c_->draw)) p.kernelX = p.kernelY = 0, p.kernelWidth = p.kernelHeight = 1;
    return p;
}

// Which pixels of the pass's picture show what is in `r` of the window.
PixelViewport Replay::inKernel(const PixelViewport& r) const {
    const RenderPass& p = config_.pass;
    const auto edge = [](int64_t at, int column, int columns) { // the first pixel at or behind it
        const int64_t n = at - column;
        return static_cast<int32_t>(n > 0 ? (n + columns - 1) / columns : -(-n / columns));
    };
    const int32_t x0 = edge(r.x, p.kernelX, p.kernelWidth), x1 = edge(int64_t{r.x} + r.w, p.kernelX, p.kernelWidth);
    const int32_t y0 = edge(r.y, p.kernelY, p.kernelHeight), y1 = edge(int64_t{r.y} + r.h, p.kernelY, p.kernelHeight);
    return {x0, y0, x1 - x0, y1 - y0};
}

// The pass's pixels `r` of a window that was drawn whole.
const std::byte* Replay::readEveryNth(Window& w, const PixelViewport& r, bool front) {
    const RenderPass& p = config_.pass;
    const PixelViewport from{r.x * p.kernelWidth + p.kernelX, r.y * p.kernelHeight + p.kernelY, (r.w - 1) * p.kernelWidth + 1, (r.h - 1) * p.kernelHeight + 1};
    const std::byte* all = readShown(w, from, front);
    std::vector<std::byte> picked(static_cast<size_t>(r.area()) * 4);
    for (int32_t y = 0; y < r.h; ++y)
        for (int32_t x = 0; x < r.w; ++x)
            std::memcpy(&picked[(static_cast<size_t>(y) * static_cast<size_t>(r.w) + static_cast<size_t>(x)) * 4],
                        all + (static_cast<size_t>(y * p.kernelHeight) * static_cast<size_t>(from.w) + static_cast<size_t>(x * p.kernelWidth)) * 4, 4);
    pixels_ = std::move(picked);
    return pixels_.data();
}

// What a program reads of a window that has every nth pixel only: each stands for its neighbours.
const std::byte* Replay::readRepeated(const PixelViewport& part, GLenum format, GLenum type, size_t group) {
    const RenderPass& p = config_.pass;
    const PixelViewport from{part.x / p.kernelWidth, part.y / p.kernelHeight, (part.right() - 1) / p.kernelWidth - part.x / p.kernelWidth + 1, (part.top() - 1) / p.kernelHeight - part.y / p.kernelHeight + 1};
    (void)readRegion(from, format, type, static_cast<size_t>(from.area()) * group);
    const std::vector<std::byte> few = pixels_;
    pixels_.resize(static_cast<size_t>(part.area()) * group);
    for (int32_t y = 0; y < part.h; ++y)
        for (int32_t x = 0; x < part.w; ++x) {
            const auto fx = static_cast<size_t>((part.x + x) / p.kernelWidth - from.x), fy = static_cast<size_t>((part.y + y) / p.kernelHeight - from.y);
            std::memcpy(&pixels_[(static_cast<size_t>(y) * static_cast<size_t>(part.w) + static_cast<size_t>(x)) * group], &few[(fy * static_cast<size_t>(from.w) + fx) * group], group);
        }
    return pixels_.data();
}

// Where window coordinates of the whole picture lie in this pass's: pixel i of a kernel of n columns shows what is at
// n i + its column + 1/2, and a sample what lies off its pixel's centre.
std::array<double, 2> Replay::placeInPicture(double x, double y) const {
    const RenderPass p = passOfWindow();
    const auto jitter = jitterOf(p.sample, p.samples);
    return {(x - p.kernelX - 0.5 - jitter[0]) / p.kernelWidth + 0.5, (y - p.kernelY - 0.5 - jitter[1]) / p.kernelHeight + 0.5};
}

void Replay::applyMovedViewports() {
    for (GLuint i = 0; i < kViewports; ++i) {
        const auto& v = c_->viewports[i];
        const auto at = placeInPicture(v[0], v[1]);
        gl.glViewportIndexedf(i, static_cast<GLfloat>(at[0]), static_cast<GLfloat>(at[1]), v[2] / static_cast<GLfloat>(passOfWindow().kernelWidth), v[3] / static_cast<GLfloat>(passOfWindow().kernelHeight));
    }
}

// Values for shaders::kMoveUniform.
std::array<GLfloat, 8> Replay::moveOf(GLuint program) const {
    std::array<GLfloat, 8> move{};
    const auto& v = c_->viewports[0];
    if (movesByShaders() && v[2] > 0 && v[3] > 0) {
        // x' = a x + b in window coordinates, x = v + (n + 1) w / 2 for normalised n.
        const auto zero = placeInPicture(0, 0);
        const double ax = 1.0 / passOfWindow().kernelWidth, ay = 1.0 / passOfWindow().kernelHeight;
        move[0] = static_cast<GLfloat>(ax - 1);
        move[1] = static_cast<GLfloat>(ay - 1);
        move[2] = static_cast<GLfloat>(2 * (ax * v[0] + zero[0] - v[0]) / v[2] + ax - 1);
        move[3] = static_cast<GLfloat>(2 * (ay * v[1] + zero[1] - v[1]) / v[3] + ay - 1);
    }
    if (seesWithOtherEye()) {
        // Without any matrix to go by: a field of view of 60 degrees from bottom to top.
        double scale = c_->fixedScale > 0 ? c_->fixedScale : c_->shared->fieldScale;
        const auto own = c_->shared->fieldScales.find(program);
        if (own != c_->shared->fieldScales.end()) scale = own->second;
        if (scale <= 0) scale = 1.7320508 * std::max(1.0f, v[3]) / std::max(1.0f, v[2]);
        move[4] = static_cast<GLfloat>(scale * eyeOffset());
        move[5] = static_cast<GLfloat>(1 / config_.focusDistance);
    }
    return move;
}

} // namespace mural
