#include "interposer/encode/program_layout.hpp"

#include <cstdio>
#include <cstring>

#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"

namespace mural {

namespace {

constexpr GLsizei kNameBytes = 512;

struct LayoutWriter {
    ThreadState& t;
    size_t bytes = 4;
    uint32_t count = 0;

    void add(GLint location, const char* name) {
        const auto length = static_cast<uint32_t>(std::strlen(name));
        auto* out = static_cast<std::byte*>(scratchMemory(t, bytes + 8 + length + 4));
        if (!out) return;
        std::memcpy(out + bytes, &location, 4);
        std::memcpy(out + bytes + 4, &length, 4);
        std::memset(out + bytes + 8 + length / 4 * 4, 0, 4);
        std::memcpy(out + bytes + 8, name, length);
        bytes += 8 + (length + 3) / 4 * 4;
        ++count;
    }
};

// Array elements have separate locations: "a[0]" stands for all `size` elements.
void addUniform(LayoutWriter& w, GLuint program, const char* name, GLint size) {
    const GLint first = gReal.glGetUniformLocation(program, name);
    if (first < 0) return; // in a block, or built-in
    w.add(first, name);
    const size_t length = std::strlen(name);
    if (size <= 1 || length < 3 || std::strcmp(name + length - 3, "[0]") != 0) return;
    char element[kNameBytes + 16];
    for (GLint i = 1; i < size; ++i) {
        snprintf(element, sizeof element, "%.*s[%d]", static_cast<int>(length - 3), name, i);
        const GLint location = gReal.glGetUniformLocation(program, element);
        if (location >= 0) w.add(location, element);
    }
}

} // namespace

bool isLinked(Context& context, GLuint program) {
    GLint status = 0;
    return raisesNothing(context, [&] { gReal.glGetProgramiv(program, GL_LINK_STATUS, &status); }) && status != 0;
}

void bindAttributes(ThreadState& t, GLuint program) {
    if (!gReal.glGetActiveAttrib || !t.context) return;
    if (!isLinked(*t.context, program)) return;
    GLint count = 0;
    gReal.glGetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
    for (GLint i = 0; i < count; ++i) {
        char name[kNameBytes] = "";
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gReal.glGetActiveAttrib(program, static_cast<GLuint>(i), kNameBytes, &length, &size, &type, name);
        const GLint location = gReal.glGetAttribLocation(program, name);
        if (location < 0 || !std::strncmp(name, "gl_", 3)) continue;
        encode_glBindAttribLocation(t, program, static_cast<GLuint>(location), DataArg::text(name));
    }
}

void sendLayout(ThreadState& t, GLuint program) {
    if (!gReal.glGetActiveUniform || !gReal.glGetUniformLocation || !t.context) return;
    if (!isLinked(*t.context, program)) return;
    LayoutWriter w{t};
    if (!scratchMemory(t, 4)) return;
    GLint count = 0;
    gReal.glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char name[kNameBytes] = "";
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gReal.glGetActiveUniform(program, static_cast<GLuint>(i), kNameBytes, &length, &size, &type, name);
        addUniform(w, program, name, size);
    }
    std::memcpy(t.scratch, &w.count, 4);
    if (w.count) records::programLayout(t, program, DataArg::of(t.scratch, w.bytes));
}

} // namespace mural
