// Draws only this node's part of a window.
//
// exact: the framebuffer has the window's size. The scissor, intersected with the program's scissor box, closes
// everything outside the node's region. The specification requires fragments to be independent of the scissor. The
// region is therefore bit-identical to the same part of the whole picture.
//
// lean: the framebuffer has the region's size, and window coordinates are translated.
//
// Framebuffer objects are always drawn whole. Source: docs/architecture/tiling.md and exactness.md.
#include <cstdint>

#include "nodes/player/pixel_mapping.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/engine/to_int.hpp"

namespace mural {

namespace {

// Viewports and boxes set by one command: an invalid one leaves all of them unchanged.
template <class T> bool areBoxes(GLuint maximum, GLuint first, GLsizei count, const T* v) {
    if (!v || count <= 0 || first >= maximum || static_cast<GLuint>(count) > maximum - first) return false;
    for (GLsizei i = 0; i < count; ++i) {
        if (v[4 * i + 2] < 0 || v[4 * i + 3] < 0) return false;
    }
    return true;
}

} // namespace

PixelViewport Replay::origin() const {
    if (!drawsLean() || c_->drawFramebuffer != 0 || !c_->draw) return {};
    return c_->draw->region;
}

void Replay::applyScissor(int index, bool all) {
    const replay::Scissor& app = c_->scissors[static_cast<size_t>(index)];
    bool enabled = app.enabled;
    PixelViewport box = drawsWindow() && interleaves(c_->draw) ? inPass(passOf(*c_->draw), app.box) : app.box;
    if (!isReplicatedDraw() && c_->draw) {
        const PixelViewport part = c_->draw->drawn;
        if (drawsLean()) { // the framebuffer ends at the tile's edges
            box.x = moved(box.x, c_->draw->region.x);
            box.y = moved(box.y, c_->draw->region.y);
        } else {
            box = enabled ? intersect(part, box) : part;
            enabled = true;
        }
    }
    if (all) {
        enabled ? gl.glEnable(GL_SCISSOR_TEST) : gl.glDisable(GL_SCISSOR_TEST);
        gl.glScissor(box.x, box.y, box.w, box.h);
    } else {
        const auto i = static_cast<GLuint>(index);
        enabled ? gl.glEnablei(GL_SCISSOR_TEST, i) : gl.glDisablei(GL_SCISSOR_TEST, i);
        gl.glScissorIndexed(i, box.x, box.y, box.w, box.h);
    }
}

void Replay::applyScissors() {
    if (!bound_ || !gl.glScissor) return;
    splitQueries();
    if (!c_->scissorsDiffer || !gl.glScissorIndexed || !gl.glEnablei) return applyScissor(0, true);
    for (int i = 0; i < replay::kViewports; ++i) applyScissor(i, false);
}

void Replay::withoutTile(const std::function<void()>& call) {
    const bool cut = drawsWindow() && c_->draw && !drawsLean() && c_->draw->drawn != c_->draw->whole;
    if (!cut || c_->compiling) return call();
    tileOff_ = true;
    applyScissors();
    call();
    tileOff_ = false;
    applyScissors();
}

void Replay::applyViewports() {
    if (!bound_) return;
    if (movesPicture() && !movesByShaders()) return applyMovedViewports();
    const PixelViewport o = origin();
    const auto& v = c_->viewports[0];
    if (!c_->viewportsDiffer || !gl.glViewportIndexedf) {
        gl.glViewport(moved(toInt(v[0]), o.x), moved(toInt(v[1]), o.y), toInt(v[2]), toInt(v[3]));
        return;
    }
    for (GLuint i = 0; i < replay::kViewports; ++i) {
        const auto& r = c_->viewports[i];
        gl.glViewportIndexedf(i, r[0] - static_cast<GLfloat>(o.x), r[1] - static_cast<GLfloat>(o.y), r[2], r[3]);
    }
}

// Called after a change of context, framebuffer or window.
void Replay::restoreWindowState() {
    if (!bound_ || !c_->everCurrent) return;
    const bool needsAll = drawsLean() && c_->draw && allDrawn();
    if (needsAll && c_->draw->widens && !c_->compiling) widenToWindow(*c_->draw);
    applyScissors();
    applyColorMasks();
    if (config_.lean || movesPicture()) applyViewports();
    applyTileValues();
}

void Replay::glViewport(GLint x, GLint y, GLsizei width, GLsizei height) {
    if (width < 0 || height < 0) return;
    const std::array<GLfloat, 4> v{static_cast<GLfloat>(x), static_cast<GLfloat>(y), static_cast<GLfloat>(width),
                                   static_cast<GLfloat>(height)};
    c_->viewports.fill(v);
    c_->viewportsDiffer = false;
    if (movesPicture()) {
        applyViewports();
        return applyTileValues();
    }
    const PixelViewport o = origin();
    gl.glViewport(moved(x, o.x), moved(y, o.y), width, height);
    applyTileValues();
}
void Replay::glViewportArrayv(GLuint first, GLsizei count, const Data& v) {
    if (!areBoxes(replay::kViewports, first, count, v.as<GLfloat>())) return;
    for (GLsizei i = 0; i < count; ++i) glViewportIndexedfv(first + static_cast<GLuint>(i), v.as<GLfloat>() + 4 * i);
}
void Replay::glViewportIndexedf(GLuint index, GLfloat x, GLfloat y, GLfloat w, GLfloat h) {
    if (index >= replay::kViewports || w < 0 || h < 0 || !gl.glViewportIndexedf) return;
    c_->viewports[index] = {x, y, w, h};
    c_->viewportsDiffer = true;
    if (movesPicture()) {
        applyViewports();
        return applyTileValues();
    }
    const PixelViewport o = origin();
    gl.glViewportIndexedf(index, x - static_cast<GLfloat>(o.x), y - static_cast<GLfloat>(o.y), w, h);
    if (index == 0) applyTileValues();
}
void Replay::glViewportIndexedfv(GLuint index, const GLfloat* v) { glViewportIndexedf(index, v[0], v[1], v[2], v[3]); }

void Replay::glScissor(GLint x, GLint y, GLsizei width, GLsizei height) {
    if (width < 0 || height < 0) return;
    for (auto& s : c_->scissors) s.box = {x, y, width, height};
    applyScissors();
}
void Replay::glScissorArrayv(GLuint first, GLsizei count, const Data& v) {
    if (!areBoxes(replay::kViewports, first, count, v.as<GLint>())) return;
    for (GLsizei i = 0; i < count; ++i) glScissorIndexedv(first + static_cast<GLuint>(i), v.as<GLint>() + 4 * i);
}
void Replay::glScissorIndexed(GLuint index, GLint left, GLint bottom, GLsizei width, GLsizei height) {
    if (index >= replay::kViewports || width < 0 || height < 0) return;
    c_->scissors[index].box = {left, bottom, width, height};
    c_->scissorsDiffer = true;
    applyScissors();
}
void Replay::glScissorIndexedv(GLuint index, const GLint* v) { glScissorIndexed(index, v[0], v[1], v[2], v[3]); }

void Replay::glEnable(GLenum cap) {
    if (cap == GL_LINE_STIPPLE && !c_->lineStippled) {
        c_->lineStippled = true;
        applyTileValues();
    }
    if (cap == GL_DEBUG_OUTPUT) listenToDriver();
    if (moves()) onTests(cap);
    if (cap != GL_SCISSOR_TEST) return gl.glEnable(cap);
    for (auto& s : c_->scissors) s.enabled = true;
    applyScissors();
}
void Replay::glDisable(GLenum cap) {
    if (cap != GL_SCISSOR_TEST) return gl.glDisable(cap);
    for (auto& s : c_->scissors) s.enabled = false;
    applyScissors();
}
void Replay::glEnablei(GLenum target, GLuint index) {
    if (target != GL_SCISSOR_TEST) return gl.glEnablei ? gl.glEnablei(target, index) : void();
    if (index >= replay::kViewports) return;
    c_->scissors[index].enabled = true;
    c_->scissorsDiffer = true;
    applyScissors();
}
void Replay::glDisablei(GLenum target, GLuint index) {
    if (target != GL_SCISSOR_TEST) return gl.glDisablei ? gl.glDisablei(target, index) : void();
    if (index >= replay::kViewports) return;
    c_->scissors[index].enabled = false;
    c_->scissorsDiffer = true;
    applyScissors();
}

// ---- attribute stack: the replay saves its own copies of state on a stack of its own

void Replay::glPushAttrib(GLbitfield mask) {
    gl.glPushAttrib(mask);
    if (c_->attributes.size() < 64)
        c_->attributes.push_back({mask, c_->scissors, c_->listBase, c_->viewports, c_->drawBuffer0, c_->readBuffer0,
                                  c_->program, c_->colorMasks});
}
void Replay::glPopAttrib() {
    gl.glPopAttrib();
    if (c_->attributes.empty()) return;
    const replay::SavedAttributes saved = c_->attributes.back();
    c_->attributes.pop_back();
    for (size_t i = 0; i < replay::kViewports; ++i) {
        if (saved.mask & (GL_SCISSOR_BIT | GL_ENABLE_BIT)) c_->scissors[i].enabled = saved.scissors[i].enabled;
        if (saved.mask & GL_SCISSOR_BIT) c_->scissors[i].box = saved.scissors[i].box;
    }
    if (saved.mask & GL_LIST_BIT) c_->listBase = saved.listBase;
    if (saved.mask & GL_VIEWPORT_BIT) c_->viewports = saved.viewports;
    if (saved.mask & GL_COLOR_BUFFER_BIT) {
        drawBufferOfWindow(saved.drawBuffer0);
        c_->colorMasks = saved.colorMasks;
        applyColorMasks(); // the framebuffer may have changed since the push
    }
    if (saved.mask & GL_PIXEL_MODE_BIT) readBufferOfWindow(saved.readBuffer0);
    if (saved.mask & (GL_SCISSOR_BIT | GL_ENABLE_BIT | GL_VIEWPORT_BIT)) restoreWindowState();
}

namespace {

// Rotates the pattern for a framebuffer whose lower left corner is at (x, y) in the window.
std::array<GLubyte, 128> turnedStipple(const GLubyte* pattern, int x, int y) {
    std::array<GLubyte, 128> turned{};
    const int shift = x % 32;
    for (int row = 0; row < 32; ++row) {
        const GLubyte* from = pattern + 4 * ((row + y) % 32);
        const uint32_t bits = uint32_t{from[0]} << 24 | uint32_t{from[1]} << 16 | uint32_t{from[2]} << 8 | from[3];
        const uint32_t moved = shift ? bits << shift | bits >> (32 - shift) : bits;
        for (int k = 0; k < 4; ++k)
            turned[4 * static_cast<size_t>(row) + static_cast<size_t>(k)] = static_cast<GLubyte>(moved >> (24 - 8 * k));
    }
    return turned;
}

} // namespace

// The pattern is fixed to the window, so a translated framebuffer needs a rotated pattern.
void Replay::glPolygonStipple(const Data& mask) {
    if (!unpackFor(mask)) return;
    const PixelViewport o = origin();
    if ((o.x % 32 == 0 && o.y % 32 == 0) || (!mask.pointer() && !mask.isOffset()))
        return gl.glPolygonStipple(mask.as<GLubyte>());
    if (!mask.isOffset()) return gl.glPolygonStipple(turnedStipple(mask.as<GLubyte>(), o.x, o.y).data());
    gl.glPolygonStipple(mask.as<GLubyte>()); // from a buffer: GL sets it, then it is queried
    GLubyte pattern[128] = {};
    if (c_->packBuffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    packTightly(true);
    gl.glGetPolygonStipple(pattern);
    packTightly(false);
    if (c_->packBuffer) gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, c_->packBuffer);
    gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    setUnpack(true);
    gl.glPolygonStipple(turnedStipple(pattern, o.x, o.y).data());
    gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, c_->unpackBuffer);
}

} // namespace mural
