// Draws that draw nothing: with policy `state` a draw goes to the program's own context only for the
// errors that it raises there. Each call below passes the checks of the one it stands for and then has
// nothing to draw; arguments that are wrong by themselves go on as they are.
// Measured against the real calls: tests/programs/draw_errors*.cpp.
#pragma once

#include "interposer/context.hpp"
#include "interposer/real_gl.hpp"

namespace mural::quiet {

// A window coordinate outside every framebuffer. Exact as a float.
constexpr GLfloat kFarOutside = -1048576;

// Vertices, instances, draws: none of them, unless the number itself is an error.
inline GLsizei none(GLsizei count) { return count < 0 ? count : 0; }

// What the local call of a draw gets for its count.
inline GLsizei count(const ThreadState& t, GLsizei count) { return t.drawLocally ? count : none(count); }

inline void clear(GLbitfield mask) { gReal.glClear(mask & ~GLbitfield{GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT}); }

// Whether glClearBuffer* and its kin have nothing against these arguments; `planes` are those of its type.
bool clearsBuffer(GLenum buffer, GLint drawBuffer, bool color, GLenum plane);

// For calls that no arguments make harmless: Mesa clears the bound framebuffer when the named one is not there.
template <class Call> void discarded(Call&& call) {
    const bool discards = gReal.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (!discards) gReal.glEnable(GL_RASTERIZER_DISCARD);
    call();
    if (!discards) gReal.glDisable(GL_RASTERIZER_DISCARD);
}

// glClearNamedFramebufferfi.
void clearDepthStencil(GLuint framebuffer, GLenum buffer, GLint drawBuffer, GLfloat depth, GLint stencil);

// What packed vertices and attributes may be.
constexpr bool packed(GLenum type) { return type == GL_INT_2_10_10_10_REV || type == GL_UNSIGNED_INT_2_10_10_10_REV; }

// True where generic attribute 0 would be a vertex of a primitive that shall stay empty.
inline bool vertex(const ThreadState& t, GLuint index) {
    return index == 0 && !t.drawLocally && t.context && t.context->openPrimitive != kNoPrimitive;
}

// Before a command that makes the driver look at vertex arrays without a draw. Mesa settles them in draws, also in those of
// nothing, but takes up what they say only in others: when arrays change in between, glRasterPos* finds them half changed and
// never ends (Mesa 22.3, glDisableVertexAttribArray(0) after glDrawArrays of nothing).
void settleArrays(const ThreadState& t);
void rectangle(const ThreadState& t);
void evalMesh2(GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2);
void drawPixels(const ThreadState& t, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels);
void accumulate(GLenum op, GLfloat value);

struct Area {
    GLint x0, y0, x1, y1;
};
// Calls blit(source, destination) with areas that hold no pixel and are of equal or unequal size as these are,
// turned over or not; OpenGL ES wants areas with samples to be in the same place, too.
template <class Blit> void blit(const Area& from, const Area& to, Blit&& call) {
    const auto size = [](GLint a, GLint b) { return a < b ? int64_t{b} - a : int64_t{a} - b; };
    const bool sameSize = size(from.x0, from.x1) == size(to.x0, to.x1) && size(from.y0, from.y1) == size(to.y0, to.y1);
    const GLint to0 = sameSize && from.x0 == to.x0 && from.y0 == to.y0 && from.x1 == to.x1 && from.y1 == to.y1 ? 0 : 1;
    call(Area{0, 0, sameSize ? 0 : 1, sameSize ? 0 : 1}, Area{to0, to0, to0, to0});
}

// glDrawTex*OES. Drivers refuse empty rectangles; this one lies outside every framebuffer.
template <class T> void drawTexture(T width, T height) {
    const bool isError = width <= 0 || height <= 0;
    gReal.glDrawTexfOES(kFarOutside, kFarOutside, 0, isError ? 0 : 1, isError ? 0 : 1);
}

void meshTasks(GLuint first, GLuint count);
void dispatch(GLuint x, GLuint y, GLuint z);
void dispatchIndirect(GLintptr indirect);
void drawFeedback(const ThreadState& t, GLenum mode, GLuint id);
void drawFeedbackStream(const ThreadState& t, GLenum mode, GLuint id, GLuint stream);

// A part of the buffer that is bound to target; false: there is none, or the part is not in it, or a program has it mapped.
bool withinBuffer(GLenum target, GLenum binding, uint64_t offset, uint64_t sizeBytes);

// Indirect draws: true when the driver shall have the call as it is, for it is an error.
bool indirectIsWrong(const ThreadState& t, const void* indirect, uint64_t sizeBytes);
void drawIndirect(const ThreadState& t, GLenum mode, const void* indirect, GLsizei stride);
void drawElementsIndirect(const ThreadState& t, GLenum mode, GLenum type, const void* indirect, GLsizei stride);

} // namespace mural::quiet
