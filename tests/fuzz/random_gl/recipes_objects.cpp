// Recipes for buffers and mappings, queries, conditional rendering, transform feedback, syncs.
#include <cstring>

#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

constexpr GLenum kBufferTargets[] = {GL_ARRAY_BUFFER,     GL_ARRAY_BUFFER,         GL_UNIFORM_BUFFER,
                                     GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,    GL_PIXEL_UNPACK_BUFFER,
                                     GL_TEXTURE_BUFFER,   GL_SHADER_STORAGE_BUFFER};

void drawSomething(World& w) {
    const auto recipes = drawRecipes();
    const Recipe& recipe = recipes[w.random.chance(70) ? 1 : 5]; // draws, clears
    recipe.cook(w);
}

GLenum bufferTarget(World& w) { return w.profile == Profile::Es1 ? GL_ARRAY_BUFFER : w.random.of(kBufferTargets); }

void fillBuffer(World& w) {
    const GLenum target = bufferTarget(w);
    if (w.random.chance(50)) {
        GLuint buffer = 0;
        GL(glGenBuffers, 1, &buffer);
        w.keep(Kind::Buffer, buffer);
        GL(glBindBuffer, target, buffer);
    } else {
        GL(glBindBuffer, target, w.living(Kind::Buffer));
    }
    constexpr Type types[] = {Type::Float, Type::Float, Type::Int, Type::Byte};
    GL(glBufferData, target, w.random.between(0, 2000), inputOf(w.random.of(types), w.random), GL_DYNAMIC_DRAW);
    GL(glBufferSubData, target, w.random.between(0, 40) * 4, w.random.between(0, 100),
       inputOf(w.random.of(types), w.random));
    if (target == GL_PIXEL_UNPACK_BUFFER && w.random.chance(50)) {
        GL(glBindBuffer, target, 0);
    }
}

void immutableBuffer(World& w) {
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    w.keep(Kind::Buffer, buffer);
    GL(glBindBuffer, GL_COPY_WRITE_BUFFER, buffer);
    GL(glBufferStorage, GL_COPY_WRITE_BUFFER, 600, inputOf(Type::Float, w.random),
       w.random.chance(70) ? GL_DYNAMIC_STORAGE_BIT | GL_MAP_WRITE_BIT | GL_MAP_READ_BIT : 0);
}

// Writes through a mapping, and reads the previous contents.
void mapping(World& w) {
    const GLenum target = GL_COPY_WRITE_BUFFER;
    GL(glBindBuffer, target, w.living(Kind::Buffer));
    const GLintptr offset = w.random.between(0, 10) * 4;
    const GLsizeiptr length = w.random.between(1, 60) * 4;
    const GLbitfield access = w.random.chance(50)   ? GL_MAP_WRITE_BIT | GL_MAP_READ_BIT
                              : w.random.chance(50) ? GL_MAP_WRITE_BIT
                                                    : GL_MAP_READ_BIT;
    const bool flushes = (access & GL_MAP_READ_BIT) == 0 && w.random.chance(30);
    void* const mapped =
        GL(glMapBufferRange, target, offset, length, flushes ? access | GL_MAP_FLUSH_EXPLICIT_BIT : access);
    w.observe(static_cast<std::uint64_t>(mapped != nullptr));
    if (mapped != nullptr) {
        if ((access & GL_MAP_READ_BIT) != 0) {
            w.observe(mapped, static_cast<std::size_t>(length));
        }
        if ((access & GL_MAP_WRITE_BIT) != 0) {
            std::memcpy(mapped, inputOf(Type::Float, w.random), static_cast<std::size_t>(length));
        }
        if (flushes) {
            GL(glFlushMappedBufferRange, target, 0, length);
        }
    }
    w.observe(static_cast<std::uint64_t>(GL(glUnmapBuffer, target)));
}

void query(World& w) {
    constexpr GLenum targets[] = {GL_ANY_SAMPLES_PASSED,
                                  GL_ANY_SAMPLES_PASSED_CONSERVATIVE,
                                  GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN,
                                  GL_SAMPLES_PASSED,
                                  GL_SAMPLES_PASSED,
                                  GL_PRIMITIVES_GENERATED};
    const GLenum target = targets[w.random.below(w.es() ? 3 : 6)];
    GLuint name = 0;
    GL(glGenQueries, 1, &name);
    w.keep(Kind::Query, name);
    GL(glBeginQuery, target, name);
    w.countsSamples = target == GL_SAMPLES_PASSED;
    for (std::uint32_t i = w.random.between(1, 2); i > 0; --i) {
        drawSomething(w);
    }
    w.countsSamples = false;
    GL(glEndQuery, target);
    GLuint result = 0;
    GL(glGetQueryObjectuiv, name, GL_QUERY_RESULT, &result);
    w.observe(std::uint64_t{result});
}

void condition(World& w) {
    GLuint name = 0;
    GL(glGenQueries, 1, &name);
    w.keep(Kind::Query, name);
    GL(glBeginQuery, GL_ANY_SAMPLES_PASSED, name);
    if (w.random.chance(60)) {
        drawSomething(w);
    }
    GL(glEndQuery, GL_ANY_SAMPLES_PASSED);
    constexpr GLenum modes[] = {GL_QUERY_WAIT, GL_QUERY_BY_REGION_WAIT, GL_QUERY_WAIT_INVERTED};
    GL(glBeginConditionalRender, name, w.random.of(modes));
    drawSomething(w);
    GL(glEndConditionalRender);
}

void capture(World& w) {
    useAnyProgram(w);
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    w.keep(Kind::Buffer, buffer);
    for (GLuint i = 0; i < 2; ++i) {
        if (i == 1) {
            GL(glGenBuffers, 1, &buffer);
        }
        GL(glBindBuffer, GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
        GL(glBufferData, GL_TRANSFORM_FEEDBACK_BUFFER, 4096, inputOf(Type::Float, w.random), GL_STREAM_COPY);
        GL(glBindBufferBase, GL_TRANSFORM_FEEDBACK_BUFFER, i, buffer);
    }
    constexpr GLenum modes[] = {GL_POINTS, GL_LINES, GL_TRIANGLES};
    const GLenum mode = w.random.of(modes);
    GL(glBeginTransformFeedback, mode);
    if (w.clientArrays()) {
        GL(glBindVertexArray, 0);
    }
    GL(glDrawArrays, mode, 0, w.random.between(0, 12));
    if (w.random.chance(30)) {
        GL(glPauseTransformFeedback);
        drawSomething(w);
        GL(glResumeTransformFeedback);
    }
    GL(glEndTransformFeedback);
    const void* const mapped =
        GL(glMapBufferRange, GL_TRANSFORM_FEEDBACK_BUFFER, 0, 1024, static_cast<GLbitfield>(GL_MAP_READ_BIT));
    if (mapped != nullptr) {
        w.observe(mapped, 1024);
    }
    GL(glUnmapBuffer, GL_TRANSFORM_FEEDBACK_BUFFER);
}

void sync(World& w) {
    if (!w.syncs.empty() && w.random.chance(60)) {
        GLsync const old = w.syncs.back();
        w.syncs.pop_back();
        GL(glWaitSync, old, 0U, GL_TIMEOUT_IGNORED);
        const GLenum state =
            GL(glClientWaitSync, old, static_cast<GLbitfield>(GL_SYNC_FLUSH_COMMANDS_BIT), GLuint64{10000000000});
        w.observe(static_cast<std::uint64_t>(state == GL_ALREADY_SIGNALED ? GL_CONDITION_SATISFIED : state));
        GL(glDeleteSync, old);
    } else {
        w.syncs.push_back(GL(glFenceSync, GL_SYNC_GPU_COMMANDS_COMPLETE, 0U));
    }
}

constexpr Recipe kRecipes[] = {
    {"fill buffer", fillBuffer, "ck13", 6},
    {"immutable buffer", immutableBuffer, "ck", 2},
    {"mapping", mapping, "ck3", 4},
    {"query", query, "ck3", 3},
    {"condition", condition, "ck", 1},
    {"transform feedback", capture, "ck3", 3},
    {"sync", sync, "ck3", 2},
};

} // namespace

std::span<const Recipe> objectRecipes() { return kRecipes; }

} // namespace fuzz
