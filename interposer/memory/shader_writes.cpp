#include "interposer/memory/shader_writes.hpp"

#include <GL/glext.h>
#include <cstring>

#include "interposer/wrappers/copies.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/program_layout.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/memory/shader_storage_scan.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

constexpr GLsizei kMaxShaders = 64; // attached to one program

bool isImage(GLint type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

GLint activeCount(GLuint program, GLenum kind) {
    GLint count = 0;
    gReal.glGetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
    return count;
}

// Whether the fragment shader uses a resource of that kind; of uniforms, images only.
bool fragmentUses(GLuint program, GLenum kind) {
    const bool uniforms = kind == GL_UNIFORM;
    const GLint count = activeCount(program, kind);
    for (GLint i = 0; i < count; ++i) {
        const GLenum names[2] = {GL_REFERENCED_BY_FRAGMENT_SHADER, GL_TYPE};
        GLint values[2] = {};
        gReal.glGetProgramResourceiv(program, kind, static_cast<GLuint>(i), uniforms ? 2 : 1, names, 2, nullptr,
                                     values);
        if (values[0] && (!uniforms || isImage(values[1]))) return true;
    }
    return false;
}

bool mayHaveWriters(const ThreadState& t) {
    const Session* s = Session::current();
    if (!t.context || !s || !s->alive() || s->welcome().nodeCount < 2 || t.context->group->allDrawn) return false;
    const bool may = t.context->version >= (t.context->api == wire::Api::Desktop ? 42 : 31);
    return may && gReal.glGetProgramInterfaceiv && gReal.glGetProgramResourceiv;
}

// fragmentMayStore(): one of its fragment shaders may write to storage blocks.
template <class MayStore> void note(ThreadState& t, GLuint program, MayStore&& fragmentMayStore) {
    if (!mayHaveWriters(t) || !isLinked(*t.context, program)) return;
    const bool writes = fragmentUses(program, GL_ATOMIC_COUNTER_BUFFER) || fragmentUses(program, GL_UNIFORM) ||
                        (activeCount(program, GL_SHADER_STORAGE_BLOCK) > 0 && fragmentMayStore());
    if (writes) copies::drawAll(t, "glLinkProgram");
}

// True for modules as well, which have no text.
bool shaderMayStore(ThreadState& t, GLuint shader) {
    GLint type = 0, bytes = 0;
    gReal.glGetShaderiv(shader, GL_SHADER_TYPE, &type);
    if (type != GL_FRAGMENT_SHADER) return false;
    gReal.glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &bytes);
    auto* const text = bytes > 1 ? static_cast<GLchar*>(scratchMemory(t, static_cast<size_t>(bytes))) : nullptr;
    if (!text) return true;
    GLsizei length = 0;
    gReal.glGetShaderSource(shader, bytes, &length, text);
    StorageScan scan;
    scan.feed(text, static_cast<size_t>(length));
    return scan.mayWrite();
}

} // namespace

void recordMemoryWriter(ThreadState& t, GLuint program) {
    note(t, program, [&] {
        GLuint attached[kMaxShaders] = {};
        GLsizei count = 0;
        gReal.glGetAttachedShaders(program, kMaxShaders, &count, attached);
        for (GLsizei i = 0; i < count; ++i)
            if (shaderMayStore(t, attached[i])) return true;
        return false;
    });
}

void recordMemoryWriter(ThreadState& t, GLuint program, GLenum type, GLsizei count, const GLchar* const* strings) {
    note(t, program, [&] {
        StorageScan scan;
        for (GLsizei i = 0; type == GL_FRAGMENT_SHADER && i < count; ++i)
            scan.feed(strings[i], std::strlen(strings[i]));
        return scan.mayWrite();
    });
}

void recordMemoryWriter(ThreadState& t, GLuint program, const std::byte* recipe, size_t sizeBytes) {
    note(t, program, [&] {
        size_t at = 4; // after `separable`
        const auto number = [&] {
            uint32_t value = 0;
            if (at + 4 <= sizeBytes) std::memcpy(&value, recipe + at, 4);
            at += 4;
            return value;
        };
        for (uint32_t shaders = number(); shaders > 0 && at < sizeBytes; --shaders) {
            const uint32_t type = number(), length = number();
            if (at > sizeBytes || length > sizeBytes - at) break;
            StorageScan scan;
            if (type == GL_FRAGMENT_SHADER) scan.feed(reinterpret_cast<const char*>(recipe + at), length);
            if (scan.mayWrite()) return true;
            at += length;
        }
        return false;
    });
}

} // namespace mural
