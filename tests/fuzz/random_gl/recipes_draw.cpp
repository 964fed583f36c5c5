// Recipes for visible state, vertex arrays, draws of all kinds, and frames.
#include <cstring>

#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

constexpr GLenum kPrimitives[] = {GL_POINTS,    GL_LINES,          GL_LINE_LOOP,   GL_LINE_STRIP,
                                  GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN};
constexpr GLenum kOldPrimitives[] = {GL_QUADS, GL_QUAD_STRIP, GL_POLYGON};
constexpr GLenum kIndexTypes[] = {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT};

GLenum anyPrimitive(World& w) {
    if (w.profile == Profile::Compat && w.random.chance(25)) {
        return w.random.of(kOldPrimitives);
    }
    if (w.shaders() && w.random.chance(5)) {
        return w.random.chance(50) ? GL_PATCHES : GL_TRIANGLES_ADJACENCY;
    }
    const GLenum primitive = w.random.of(kPrimitives);
    // Mesa's software driver draws point sprites one row beyond the scissor: two tiles count them twice.
    return w.countsSamples && primitive == GL_POINTS ? GLenum{GL_LINES} : primitive;
}

const void* offsetOf(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes); // NOLINT: an offset into a buffer
}

// Binds a buffer of floats with enough vertices for all elements. Mesa reads vertices beyond its end as 0, 0, 0, 0,
// which have no position in the window.
void vertexBuffer(World& w) {
    GLuint buffer = w.living(Kind::Buffer);
    if (buffer == 0 || w.random.chance(30)) {
        GL(glGenBuffers, 1, &buffer);
        w.keep(Kind::Buffer, buffer);
    }
    GL(glBindBuffer, GL_ARRAY_BUFFER, buffer);
    GL(glBufferData, GL_ARRAY_BUFFER, w.random.between(320, 800) * 4, inputOf(Type::Float, w.random), GL_STATIC_DRAW);
}

const void* vertexPlace(World& w, bool buffered) {
    return buffered ? offsetOf(std::size_t{w.random.below(12)} * 4) : vertexMemory(w.random);
}

void genericArrays(World& w) {
    const bool buffered = !w.clientArrays() || w.random.chance(60);
    if (buffered) {
        vertexBuffer(w);
    } else {
        GL(glBindVertexArray, 0);
        GL(glBindBuffer, GL_ARRAY_BUFFER, 0);
    }
    constexpr GLenum types[] = {GL_FLOAT, GL_FLOAT,         GL_FLOAT, GL_FLOAT,
                                GL_BYTE,  GL_UNSIGNED_BYTE, GL_SHORT, GL_UNSIGNED_SHORT};
    for (GLuint i = 0; i < 3; ++i) {
        const int size = w.random.between(2, 4);
        // A float input that reads integers is undefined: equal everywhere as a colour, nearly 0 divided by nearly 0 as
        // a position.
        if (w.random.chance(6) && i != 0) {
            GL(glVertexAttribIPointer, i, size, w.random.chance(50) ? GL_INT : GL_UNSIGNED_BYTE, 16,
               vertexPlace(w, buffered));
        } else {
            GL(glVertexAttribPointer, i, size, i == 0 ? GL_FLOAT : w.random.of(types),
               w.random.chance(40) ? GL_TRUE : GL_FALSE, w.random.between(0, 5) * 4, vertexPlace(w, buffered));
        }
        if (w.random.chance(i == 0 ? 95 : 75)) {
            GL(glEnableVertexAttribArray, i);
        }
        GL(glVertexAttribDivisor, i, w.random.chance(85) ? 0 : w.random.below(3));
    }
}

void classicArrays(World& w) {
    const bool buffered = w.random.chance(40);
    if (buffered) {
        vertexBuffer(w);
    } else {
        if (w.profile == Profile::Compat) {
            GL(glBindVertexArray, 0);
        }
        GL(glBindBuffer, GL_ARRAY_BUFFER, 0);
    }
    GL(glVertexPointer, w.random.between(2, 4), GL_FLOAT, w.random.between(0, 5) * 4, vertexPlace(w, buffered));
    GL(glEnableClientState, GL_VERTEX_ARRAY);
    if (w.random.chance(60)) {
        GL(glColorPointer, 4, w.random.chance(50) ? GL_FLOAT : GL_UNSIGNED_BYTE, w.random.between(0, 5) * 4,
           vertexPlace(w, buffered));
        GL(glEnableClientState, GL_COLOR_ARRAY);
    }
    if (w.random.chance(50)) {
        GL(glClientActiveTexture, GL_TEXTURE0 + w.random.below(2));
        GL(glTexCoordPointer, w.random.between(2, 4), GL_FLOAT, w.random.between(0, 5) * 4, vertexPlace(w, buffered));
        GL(glEnableClientState, GL_TEXTURE_COORD_ARRAY);
    }
    if (w.random.chance(40)) {
        GL(glNormalPointer, GL_FLOAT, w.random.between(0, 4) * 4, vertexPlace(w, buffered));
        GL(glEnableClientState, GL_NORMAL_ARRAY);
    }
}

// Returns elements below 48, in memory or in a buffer of their own.
const void* elements(World& w, GLenum type) {
    if (w.clientArrays() && w.random.chance(50)) {
        GL(glBindBuffer, GL_ELEMENT_ARRAY_BUFFER, 0);
        return indexMemory(w.random, type);
    }
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    w.keep(Kind::Buffer, buffer);
    GL(glBindBuffer, GL_ELEMENT_ARRAY_BUFFER, buffer);
    GL(glBufferData, GL_ELEMENT_ARRAY_BUFFER, 256, indexMemory(w.random, type), GL_STATIC_DRAW);
    return offsetOf(std::size_t{w.random.below(4)} * 4);
}

void drawElements(World& w, GLenum mode, int count) {
    const GLenum type = w.random.of(kIndexTypes);
    const void* const indices = elements(w, type);
    if (w.profile == Profile::Es1 || w.random.chance(40)) {
        GL(glDrawElements, mode, count, type, indices);
        return;
    }
    switch (w.random.below(w.es() ? 4 : 6)) {
    case 0: GL(glDrawElementsInstanced, mode, count, type, indices, w.random.between(1, 3)); break;
    case 1: GL(glDrawRangeElements, mode, 0U, 60U, count, type, indices); break;
    case 2: GL(glDrawElementsBaseVertex, mode, count, type, indices, w.random.between(0, 9)); break;
    case 3: GL(glDrawElementsInstancedBaseVertex, mode, count, type, indices, 2, 3); break;
    case 4:
        GL(glDrawElementsInstancedBaseVertexBaseInstance, mode, count, type, indices, 2, 1, w.random.below(3));
        break;
    default: {
        const GLsizei counts[] = {count, 3, 4};
        const void* const places[] = {indices, indices, indices};
        const GLint bases[] = {0, 2, 4};
        if (w.random.chance(50)) {
            GL(glMultiDrawElements, mode, counts, type, places, 3);
        } else {
            GL(glMultiDrawElementsBaseVertex, mode, counts, type, places, 3, bases);
        }
    }
    }
}

void drawAny(World& w) {
    if (!drawsAnything(w)) {
        return;
    }
    const GLenum mode = anyPrimitive(w);
    const int count = w.random.between(3, 18);
    const int first = w.random.below(6);
    if (mode == GL_PATCHES) {
        GL(glPatchParameteri, GL_PATCH_VERTICES, 3);
    }
    if (w.random.chance(50)) {
        drawElements(w, mode, count);
        return;
    }
    if (w.profile == Profile::Es1 || w.random.chance(50)) {
        GL(glDrawArrays, mode, first, count);
        return;
    }
    if (w.es() || w.random.chance(40)) {
        GL(glDrawArraysInstanced, mode, first, count, w.random.between(1, 3));
    } else if (w.random.chance(50)) {
        GL(glDrawArraysInstancedBaseInstance, mode, first, count, w.random.between(1, 3), w.random.below(3));
    } else {
        const GLint firsts[] = {first, 0, 4};
        const GLsizei counts[] = {count, 4, 3};
        GL(glMultiDrawArrays, mode, firsts, counts, 3);
    }
}

void drawAnyInOrder(World& w) {
    barrier(w);
    drawAny(w);
    barrier(w);
}

void setVertexArray(World& w) {
    if (w.random.chance(w.profile == Profile::Core ? 20 : 70)) {
        return;
    }
    GLuint array = w.living(Kind::VertexArray);
    if (array == 0) {
        GL(glGenVertexArrays, 1, &array);
        w.keep(Kind::VertexArray, array);
        GL(glBindVertexArray, array);
        pointAll(w, true);
        return;
    }
    GL(glBindVertexArray, array);
}

void draw(World& w) {
    if (w.random.chance(30)) {
        calm(w);
    }
    const bool shaded = w.shaders() && (w.profile != Profile::Compat || w.random.chance(60));
    if (shaded) {
        useAnyProgram(w);
        setVertexArray(w);
        genericArrays(w);
    } else {
        if (w.profile == Profile::Compat) {
            GL(glUseProgram, 0);
        }
        classicArrays(w);
    }
    drawAnyInOrder(w);
}

void drawAgain(World& w) {
    if (w.clientArrays() || w.random.chance(50)) {
        drawAnyInOrder(w);
    } else {
        useAnyProgram(w);
        drawAnyInOrder(w);
    }
}

void drawIndirect(World& w) {
    useAnyProgram(w);
    if (!w.clientArrays()) {
        setVertexArray(w);
    } else {
        GLuint array = 0;
        GL(glGenVertexArrays, 1, &array);
        GL(glBindVertexArray, array);
        pointAll(w, true);
    }
    vertexBuffer(w);
    GL(glVertexAttribPointer, 0U, 4, GL_FLOAT, GL_FALSE, 16, offsetOf(0));
    GL(glEnableVertexAttribArray, 0U);
    const GLuint commands[] = {w.random.below(9), 2, 1, 0, 0, 6, 1, w.random.below(4), 0, 0, 4, 1, 2, 0, 0};
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    GL(glBindBuffer, GL_DRAW_INDIRECT_BUFFER, buffer);
    GL(glBufferData, GL_DRAW_INDIRECT_BUFFER, static_cast<GLsizeiptr>(sizeof commands), commands, GL_STATIC_DRAW);
    const bool indexed = w.random.chance(50);
    GLenum type = GL_UNSIGNED_SHORT;
    if (indexed) {
        GLuint indexBuffer = 0;
        type = w.random.of(kIndexTypes);
        GL(glGenBuffers, 1, &indexBuffer);
        GL(glBindBuffer, GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
        GL(glBufferData, GL_ELEMENT_ARRAY_BUFFER, 256, indexMemory(w.random, type), GL_STATIC_DRAW);
    }
    const GLenum mode = anyPrimitive(w);
    if (!drawsAnything(w)) {
        // Draws nothing in this case.
    } else if (indexed && (w.es() || w.random.chance(50))) {
        GL(glDrawElementsIndirect, mode, type, offsetOf(0));
    } else if (indexed) {
        GL(glMultiDrawElementsIndirect, mode, type, offsetOf(0), 3, 20);
    } else if (w.es() || w.random.chance(50)) {
        GL(glDrawArraysIndirect, mode, offsetOf(w.random.below(2) * std::size_t{20}));
    } else {
        GL(glMultiDrawArraysIndirect, mode, offsetOf(0), 3, 20);
    }
    GL(glDeleteBuffers, 1, &buffer);
    if (w.profile == Profile::Core) {
        GL(glBindVertexArray, w.programVertexArray);
    } else {
        GL(glBindVertexArray, 0);
    }
}

void frame(World& w) {
    observeTargets(w);
    clearAll(w);
}

void clears(World& w) {
    GL(glClearColor, w.random.unit(), w.random.unit(), w.random.unit(), w.random.unit());
    GL(glClearStencil, w.random.between(0, 300));
    GL(glClear, (w.random.chance(70) ? GL_COLOR_BUFFER_BIT : 0) | (w.random.chance(50) ? GL_DEPTH_BUFFER_BIT : 0) |
                    (w.random.chance(50) ? GL_STENCIL_BUFFER_BIT : 0));
}

void boxes(World& w) {
    if (w.random.chance(60)) {
        GL(glViewport, w.random.between(-9, 20), w.random.between(-9, 20), w.random.between(20, 90),
           w.random.between(20, 70));
    }
    if (w.random.chance(60)) {
        GL(glScissor, w.random.between(-5, 30), w.random.between(-5, 25), w.random.between(0, 60),
           w.random.between(0, 50));
        w.random.chance(60) ? GL(glEnable, GL_SCISSOR_TEST) : GL(glDisable, GL_SCISSOR_TEST);
    }
}

void tests(World& w) {
    constexpr GLenum functions[] = {GL_LESS, GL_LEQUAL, GL_ALWAYS, GL_GREATER, GL_NOTEQUAL, GL_EQUAL};
    constexpr GLenum operations[] = {GL_KEEP, GL_INCR, GL_DECR, GL_REPLACE, GL_INVERT, GL_ZERO};
    constexpr GLenum factors[] = {GL_ONE, GL_ZERO, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA_SATURATE, GL_ONE};
    constexpr GLenum switches[] = {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_BLEND,
                                   GL_DITHER,     GL_CULL_FACE,    GL_POLYGON_OFFSET_FILL};
    w.random.chance(50) ? GL(glEnable, w.random.of(switches)) : GL(glDisable, w.random.of(switches));
    GL(glDepthFunc, w.random.of(functions));
    GL(glStencilFunc, w.random.of(functions), w.random.between(0, 4), w.random.below(256));
    GL(glStencilOp, w.random.of(operations), w.random.of(operations), w.random.of(operations));
    GL(glBlendFunc, w.random.of(factors), w.random.of(factors));
}

constexpr Recipe kRecipes[] = {
    {"calm", calm, "ck13", 5},
    {"draw", draw, "ck13", 22},
    {"draw again", drawAgain, "ck13", 6},
    {"draw indirect", drawIndirect, "ck3", 3},
    {"frame", frame, "ck13", 1},
    {"clear", clears, "ck13", 4},
    {"boxes", boxes, "ck13", 4},
    {"tests", tests, "ck13", 5},
};

} // namespace

void barrier(World& w) {
    if (!w.es()) {
        GL(glMemoryBarrier, GL_ALL_BARRIER_BITS);
    }
}

void drawBuffered(World& w) {
    setVertexArray(w);
    genericArrays(w);
    drawAnyInOrder(w);
}

std::span<const Recipe> drawRecipes() { return kRecipes; }

} // namespace fuzz
