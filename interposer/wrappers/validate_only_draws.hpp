// Harmless replacements for draws. With local rendering off, the program's own context executes a draw only for its
// errors. Each call below passes the checks of its original call and draws nothing. Arguments that are invalid by
// themselves are passed on unchanged. Verified against the original calls: tests/programs/draw_errors*.cpp.
#pragma once

#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"

namespace mural::quiet {

// A window coordinate outside every framebuffer. Exact as a float.
constexpr GLfloat kFarOutside = -1048576;

// Returns 0 vertices, instances or draws, unless the count itself is an error.
inline GLsizei none(GLsizei count) { return count < 0 ? count : 0; }

// Returns the count for the local call of a draw.
inline GLsizei count(const ThreadState& t, GLsizei count) { return t.drawLocally ? count : none(count); }

inline void clear(GLbitfield mask) {
    gReal.glClear(mask & ~GLbitfield{GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT});
}

// Returns whether glClearBuffer* and similar commands accept these arguments. `plane` is the buffer of the command's
// type.
bool clearsBuffer(GLenum buffer, GLint drawBuffer, bool color, GLenum plane);

// Runs a call with rasterizer discard, for calls that no arguments make harmless. Mesa clears the bound framebuffer if
// the named one does not exist.
template <class Call> void discarded(Call&& call) {
    const bool discards = gReal.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (!discards) gReal.glEnable(GL_RASTERIZER_DISCARD);
    call();
    if (!discards) gReal.glDisable(GL_RASTERIZER_DISCARD);
}

// glClearNamedFramebufferfi.
void clearDepthStencil(GLuint framebuffer, GLenum buffer, GLint drawBuffer, GLfloat depth, GLint stencil);

// Returns whether packed vertices and attributes accept the type.
constexpr bool packed(GLenum type) { return type == GL_INT_2_10_10_10_REV || type == GL_UNSIGNED_INT_2_10_10_10_REV; }

// Returns true if generic attribute 0 would add a vertex to a primitive that must stay empty.
inline bool vertex(const ThreadState& t, GLuint index) {
    return index == 0 && !t.drawLocally && t.context && t.context->openPrimitive != kNoPrimitive;
}

// Call before a command that makes the driver evaluate vertex arrays without a draw. Mesa updates its array state in
// every draw, but applies the update only in draws that are not empty. If arrays change in between, glRasterPos* sees
// the state half updated and never ends. (Mesa 22.3: glDisableVertexAttribArray(0) after an empty glDrawArrays.)
void settleArrays(const ThreadState& t);
void rectangle(const ThreadState& t);
void evalMesh2(GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2);
void drawPixels(const ThreadState& t, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels);
void accumulate(GLenum op, GLfloat value);

struct Area {
    GLint x0, y0, x1, y1;
};
// Calls blit(source, destination) with empty areas. Their sizes are equal exactly if the original sizes are equal,
// mirrored or not. OpenGL ES also requires multisampled areas to be in the same place.
template <class Blit> void blit(const Area& from, const Area& to, Blit&& call) {
    const auto size = [](GLint a, GLint b) { return a < b ? int64_t{b} - a : int64_t{a} - b; };
    const bool sameSize = size(from.x0, from.x1) == size(to.x0, to.x1) && size(from.y0, from.y1) == size(to.y0, to.y1);
    const GLint to0 = sameSize && from.x0 == to.x0 && from.y0 == to.y0 && from.x1 == to.x1 && from.y1 == to.y1 ? 0 : 1;
    call(Area{0, 0, sameSize ? 0 : 1, sameSize ? 0 : 1}, Area{to0, to0, to0, to0});
}

// glDrawTex*OES. Drivers reject empty rectangles; this one lies outside every framebuffer.
template <class T> void drawTexture(T width, T height) {
    const bool isError = width <= 0 || height <= 0;
    gReal.glDrawTexfOES(kFarOutside, kFarOutside, 0, isError ? 0 : 1, isError ? 0 : 1);
}

void meshTasks(GLuint first, GLuint count);
void dispatch(GLuint x, GLuint y, GLuint z);
void dispatchIndirect(GLintptr indirect);
void drawFeedback(const ThreadState& t, GLenum mode, GLuint id);
void drawFeedbackStream(const ThreadState& t, GLenum mode, GLuint id, GLuint stream);

// Returns whether the range lies within the buffer bound to target, and the program has not mapped that buffer.
bool withinBuffer(GLenum target, GLenum binding, uint64_t offset, uint64_t sizeBytes);

// Returns true if an indirect draw is an error, so the driver must receive the call unchanged.
bool indirectIsWrong(const ThreadState& t, const void* indirect, uint64_t sizeBytes);
void drawIndirect(const ThreadState& t, GLenum mode, const void* indirect, GLsizei stride);
void drawElementsIndirect(const ThreadState& t, GLenum mode, GLenum type, const void* indirect, GLsizei stride);

} // namespace mural::quiet
