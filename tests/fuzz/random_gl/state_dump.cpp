// Reads all state of the GL, and the contents of all objects.
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

void dumpQueries(World& w) {
    constexpr std::size_t bytes = 4096;
    for (const std::uint32_t query : kQueries) {
        void* const out = outputMemory(bytes);
        glGetFloatv(query, static_cast<GLfloat*>(out));
        w.observe(out, bytes);
        w.observe(std::uint64_t{glGetError()});
        if (w.trace) {
            const float* const values = static_cast<float*>(out);
            traceText("state", shown(query) + ": " + shown(values[0]) + " " + shown(values[1]) + " " +
                                   shown(digest(out, bytes)));
        }
    }
}

void dumpBuffers(World& w) {
    for (std::size_t i = 0; i < kSlots; ++i) {
        const GLuint buffer = w.slot(Kind::Buffer, i);
        if (buffer == 0 || glIsBuffer(buffer) == GL_FALSE) {
            continue;
        }
        GLint bytes = 0;
        glBindBuffer(GL_COPY_READ_BUFFER, buffer);
        glGetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
        void* const out = outputMemory(4096);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, bytes < 4096 ? bytes : 4096, out);
        w.observe(out, 4096);
        if (w.trace) {
            traceText("buffer", shown(buffer) + " " + shown(bytes) + " bytes: " + shown(digest(out, 4096)) + " from " +
                                    shown(static_cast<GLuint*>(out)[0]) + " " + shown(static_cast<GLuint*>(out)[1]) +
                                    " " + shown(static_cast<GLuint*>(out)[2]));
        }
    }
}

void dumpTextures(World& w) {
    constexpr GLenum targets[] = {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_2D_ARRAY,
                                  GL_TEXTURE_RECTANGLE};
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (std::size_t i = 0; i < kSlots; ++i) {
        const GLuint texture = w.slot(Kind::Texture, i);
        for (const GLenum target : targets) {
            while (glGetError() != GL_NO_ERROR) {}
            if (texture == 0 || glIsTexture(texture) == GL_FALSE) {
                break;
            }
            glBindTexture(target, texture);
            if (glGetError() != GL_NO_ERROR) {
                continue; // a name of another target
            }
            GLint depth = 0;
            GLint integer = 0;
            glGetTexLevelParameteriv(target, 0, GL_TEXTURE_DEPTH_SIZE, &depth);
            glGetTexLevelParameteriv(target, 0, GL_TEXTURE_RED_TYPE, &integer);
            const bool whole = integer == GL_INT || integer == GL_UNSIGNED_INT;
            constexpr std::size_t bytes = 1 << 17;
            void* const out = outputMemory(bytes);
            glGetTexImage(target, 0,
                          depth > 0 ? GL_DEPTH_COMPONENT
                          : whole   ? GL_RGBA_INTEGER
                                    : GL_RGBA,
                          whole ? GL_INT : GL_UNSIGNED_BYTE, out);
            w.observe(out, bytes);
            if (w.trace) {
                traceText("texture", shown(texture) + " target " + shown(target) + ": " + shown(digest(out, bytes)));
            }
        }
    }
}

} // namespace

void dumpState(World& w) {
    dumpQueries(w);
    if (!w.es()) {
        dumpBuffers(w);
        dumpTextures(w);
    }
}

} // namespace fuzz
