// Accumulation buffers of windows, for framebuffers of this node without one.
#include <cstring>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/features/accumulation.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {
constexpr GLbitfield kBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT | GL_ACCUM_BUFFER_BIT;
} // namespace

// True if this class keeps the accumulation buffer of the draw window.
bool Replay::accumulatesHere() {
    const bool has = drawsWindow() && c_->draw && c_->draw->config.accum > 0 && !platform_->accumulates() &&
                     c_->api == wire::Api::Desktop && !c_->core;
    if (!has || gl.glIsEnabled(GL_RASTERIZER_DISCARD)) return false;
    if (c_->draw->config.red == 8 && c_->draw->config.samples == 0) return true;
    if (!std::exchange(accumulationReported_, true))
        log::warning(
            log::Topic::Replay,
            "accumulation buffers of multisampled windows, and those with other than 8 bits per colour, are not "
            "supported here; use --gl glx");
    return false;
}

// Calls `call` with the values and the place of each row of the program's scissor box within this node's part.
void Replay::forAccumulatedRows(const std::function<void(int16_t*, const PixelViewport&)>& call) {
    Window& w = *c_->draw;
    const size_t values = static_cast<size_t>(w.drawn.area()) * 4;
    if (w.accumulated.size() != values) w.accumulated.assign(values, 0);
    const PixelViewport box = accumulatedBox();
    for (int32_t y = box.y; y < box.top(); ++y) {
        const auto at = static_cast<size_t>(y - w.drawn.y) * static_cast<size_t>(w.drawn.w) +
                        static_cast<size_t>(box.x - w.drawn.x);
        call(w.accumulated.data() + at * 4, {box.x, y, box.w, 1});
    }
}

PixelViewport Replay::accumulatedBox() const {
    const replay::Scissor& app = c_->scissors[0];
    const PixelViewport box = app.enabled ? intersect(c_->draw->drawn, app.box) : c_->draw->drawn;
    return box.empty() ? PixelViewport{} : box;
}

void Replay::glClear(GLbitfield mask) {
    if ((mask & GL_ACCUM_BUFFER_BIT) && !(mask & ~kBuffers) && accumulatesHere()) {
        GLfloat colour[4] = {};
        gl.glGetFloatv(GL_ACCUM_CLEAR_VALUE, colour);
        forAccumulatedRows([&](int16_t* values, const PixelViewport& row) {
            accumulation::clear(values, static_cast<size_t>(row.w), colour);
        });
        mask &= ~GLbitfield{GL_ACCUM_BUFFER_BIT};
    }
    withoutTile([&] { gl.glClear(mask); });
}

void Replay::glAccum(GLenum op, GLfloat value) {
    if (!accumulatesHere()) return gl.glAccum ? withoutTile([&] { gl.glAccum(op, value); }) : void();
    if (c_->readFramebuffer != 0 || c_->read != c_->draw) return; // an error in GL
    const auto count = [](const PixelViewport& row) { return static_cast<size_t>(row.w); };
    switch (op) {
    case GL_MULT:
        return forAccumulatedRows(
            [&](int16_t* values, const PixelViewport& row) { accumulation::multiply(values, count(row), value); });
    case GL_ADD:
        return forAccumulatedRows(
            [&](int16_t* values, const PixelViewport& row) { accumulation::add(values, count(row), value); });
    case GL_LOAD:
    case GL_ACCUM: return accumulateColours(value, op == GL_ACCUM);
    case GL_RETURN: return returnAccumulated(value);
    default: return;
    }
}

void Replay::accumulateColours(GLfloat value, bool add) {
    const PixelViewport box = accumulatedBox();
    if (c_->readBuffer0 == GL_NONE || box.empty()) return;
    const std::byte* pixels = nullptr;
    withPlainTransfer(
        [&] { pixels = readRegion(box, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<size_t>(box.area()) * 4); });
    const auto* colours = reinterpret_cast<const uint8_t*>(pixels);
    forAccumulatedRows([&](int16_t* values, const PixelViewport& row) {
        accumulation::load(values, colours, static_cast<size_t>(row.w), value, add);
        colours += static_cast<size_t>(row.w) * 4;
    });
}

void Replay::returnAccumulated(GLfloat value) {
    const PixelViewport box = accumulatedBox();
    if (c_->drawBuffer0 == GL_NONE || box.empty()) return;
    GLboolean mask[4] = {};
    gl.glGetBooleanv(GL_COLOR_WRITEMASK, mask);
    const bool channels[4] = {mask[0] != 0, mask[1] != 0, mask[2] != 0, mask[3] != 0};
    const size_t bytes = static_cast<size_t>(box.area()) * 4;
    const std::byte* pixels = nullptr; // components that the mask preserves
    withPlainTransfer([&] { pixels = readRegion(box, GL_RGBA, GL_UNSIGNED_BYTE, bytes); });
    std::vector<uint8_t> colours(bytes);
    std::memcpy(colours.data(), pixels, bytes);
    uint8_t* at = colours.data();
    forAccumulatedRows([&](int16_t* values, const PixelViewport& row) {
        accumulation::giveBack(values, at, static_cast<size_t>(row.w), value, channels);
        at += static_cast<size_t>(row.w) * 4;
    });
    fillColor(box, colours.data());
}

} // namespace mural
