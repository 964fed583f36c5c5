// Mapped buffers, and commands that end a mapping or change mapped data.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/encode/real_gl.hpp"

using namespace mural;

namespace {

GLuint boundBuffer(GLenum target) {
    GLenum name = 0;
    switch (target) {
    case GL_ARRAY_BUFFER: name = GL_ARRAY_BUFFER_BINDING; break;
    case GL_ELEMENT_ARRAY_BUFFER: name = GL_ELEMENT_ARRAY_BUFFER_BINDING; break;
    case GL_PIXEL_PACK_BUFFER: name = GL_PIXEL_PACK_BUFFER_BINDING; break;
    case GL_PIXEL_UNPACK_BUFFER: name = GL_PIXEL_UNPACK_BUFFER_BINDING; break;
    case GL_UNIFORM_BUFFER: name = GL_UNIFORM_BUFFER_BINDING; break;
    case GL_TRANSFORM_FEEDBACK_BUFFER: name = GL_TRANSFORM_FEEDBACK_BUFFER_BINDING; break;
    case GL_COPY_READ_BUFFER: name = GL_COPY_READ_BUFFER_BINDING; break;
    case GL_COPY_WRITE_BUFFER: name = GL_COPY_WRITE_BUFFER_BINDING; break;
    case GL_DRAW_INDIRECT_BUFFER: name = GL_DRAW_INDIRECT_BUFFER_BINDING; break;
    case GL_DISPATCH_INDIRECT_BUFFER: name = GL_DISPATCH_INDIRECT_BUFFER_BINDING; break;
    case GL_SHADER_STORAGE_BUFFER: name = GL_SHADER_STORAGE_BUFFER_BINDING; break;
    case GL_ATOMIC_COUNTER_BUFFER: name = GL_ATOMIC_COUNTER_BUFFER_BINDING; break;
    case GL_TEXTURE_BUFFER: name = 0x8C2A; break; // GL_TEXTURE_BUFFER_BINDING has the target's value
    case GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD: return tThread->context ? tThread->context->pinnedBuffer : 0;
    case GL_QUERY_BUFFER: name = GL_QUERY_BUFFER_BINDING; break;
    default: return 0;
    }
    GLint buffer = 0;
    gReal.glGetIntegerv(name, &buffer);
    return static_cast<GLuint>(buffer);
}

// Client memory becomes a buffer. The nodes create one with a copy, without changing bindings.
void pin(ThreadState& t, GLsizeiptr size, const void* data, GLenum usage) {
    const GLenum target = GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD;
    if (!raisesNothing(*t.context, [&] { gReal.glBufferData(target, size, data, usage); }) || size <= 0 || !data)
        return;
    GLint before = 0;
    gReal.glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &before);
    encode_glBindBuffer(t, GL_COPY_WRITE_BUFFER, t.context->pinnedBuffer);
    encode_glBufferData(t, GL_COPY_WRITE_BUFFER, size, DataArg::of(data, uint64_t(size)), usage);
    encode_glBindBuffer(t, GL_COPY_WRITE_BUFFER, static_cast<GLuint>(before));
    pinBegins(t, t.context->pinnedBuffer, const_cast<void*>(data), uint64_t(size));
}

bool mapsLast(const ThreadState& t) { return t.context && t.context->group->persistentMaps > 0; }

GLbitfield accessBits(GLenum access) {
    return access == GL_READ_ONLY    ? GL_MAP_READ_BIT
           : access == GL_WRITE_ONLY ? GL_MAP_WRITE_BIT
                                     : GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;
}

uint64_t sizeOf(GLenum target) {
    GLint size = 0;
    gReal.glGetBufferParameteriv(target, GL_BUFFER_SIZE, &size);
    return static_cast<uint64_t>(size);
}
template <class Get> uint64_t sizeOfNamed(Get&& get, GLuint buffer) {
    GLint size = 0;
    get(buffer, GL_BUFFER_SIZE, &size);
    return static_cast<uint64_t>(size);
}

// Fetches data written by the nodes first if the mapping can be read or partially written.
template <class Size, class Map>
void* mapWhole(GLuint buffer, GLenum access, Size&& size, Map&& map, const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    const GLbitfield bits = accessBits(access);
    settleReads(t, buffer, by);
    if (t.context && t.context->group->nodesWriteBuffers) refreshForMap(t, buffer, 0, size(), bits, by);
    void* memory = map();
    if (memory && t.context) mapBegins(t, buffer, memory, 0, size(), bits);
    return memory;
}
template <class Map>
void* mapRange(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access, Map&& map,
               const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    const bool valid = offset >= 0 && length > 0;
    if (access & GL_MAP_PERSISTENT_BIT) bufferUsed(t, buffer, by); // the program accesses it without further GL calls
    settleReads(t, buffer, by);
    if (valid) refreshForMap(t, buffer, static_cast<uint64_t>(offset), static_cast<uint64_t>(length), access, by);
    void* memory = map();
    if (valid) mapBegins(t, buffer, memory, static_cast<uint64_t>(offset), static_cast<uint64_t>(length), access);
    return memory;
}

} // namespace

extern "C" {

void* mural_glMapBuffer(GLenum target, GLenum access) {
    return mapWhole(
        boundBuffer(target), access, [=] { return sizeOf(target); }, [=] { return gReal.glMapBuffer(target, access); });
}
void* mural_glMapBufferRange(GLenum target, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    return mapRange(boundBuffer(target), offset, length, access,
                    [=] { return gReal.glMapBufferRange(target, offset, length, access); });
}
void* mural_glMapNamedBuffer(GLuint buffer, GLenum access) {
    return mapWhole(
        buffer, access, [=] { return sizeOfNamed(gReal.glGetNamedBufferParameteriv, buffer); },
        [=] { return gReal.glMapNamedBuffer(buffer, access); });
}
void* mural_glMapNamedBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    return mapRange(buffer, offset, length, access,
                    [=] { return gReal.glMapNamedBufferRange(buffer, offset, length, access); });
}
void mural_glGetBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
    ThreadState& t = *tThread;
    settleBound(t, target);
    if (t.context && t.context->group->nodesWriteBuffers && offset >= 0 && size > 0)
        refreshBuffer(t, boundBuffer(target), static_cast<uint64_t>(offset), static_cast<uint64_t>(size));
    gReal.glGetBufferSubData(target, offset, size, data);
}
void mural_glGetNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data) {
    ThreadState& t = *tThread;
    settleReads(t, buffer);
    if (offset >= 0 && size > 0) refreshBuffer(t, buffer, static_cast<uint64_t>(offset), static_cast<uint64_t>(size));
    gReal.glGetNamedBufferSubData(buffer, offset, size, data);
}
GLboolean mural_glUnmapBuffer(GLenum target) {
    ThreadState& t = *tThread;
    if (t.context && t.context->group->maps) unmaps(t, boundBuffer(target));
    const GLboolean intact = gReal.glUnmapBuffer(target);
    if (t.context && t.context->group->pendingReads.dueAtUnmap.load(std::memory_order_relaxed)) [[unlikely]]
        unmappedHere(t, boundBuffer(target));
    return intact;
}
GLboolean mural_glUnmapNamedBuffer(GLuint buffer) {
    unmaps(*tThread, buffer);
    const GLboolean intact = gReal.glUnmapNamedBuffer(buffer);
    unmappedHere(*tThread, buffer);
    return intact;
}
void mural_glFlushMappedBufferRange(GLenum target, GLintptr offset, GLsizeiptr length) {
    ThreadState& t = *tThread;
    if (t.context) mapFlushes(t, boundBuffer(target), offset, length);
    gReal.glFlushMappedBufferRange(target, offset, length);
}
void mural_glFlushMappedNamedBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr length) {
    mapFlushes(*tThread, buffer, offset, length);
    gReal.glFlushMappedNamedBufferRange(buffer, offset, length);
}

// New storage ends a mapping and discards its data (GL 4.6 §6.3.3). A deleted buffer keeps its data while it is
// attached.
void mural_glBufferData(GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
    ThreadState& t = *tThread;
    if (t.context && t.context->group->maps) mapEnds(t, boundBuffer(target), false);
    settleBound(t, target);
    if (t.context && t.context->group->pendingReads.dueAtUnmap.load(std::memory_order_relaxed)) [[unlikely]]
        newStorage(t, boundBuffer(target));
    if (t.context && target == GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD) return pin(t, size, data, usage);
    encode_glBufferData(t, target, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), usage);
    gReal.glBufferData(target, size, data, usage);
}
void mural_glNamedBufferData(GLuint buffer, GLsizeiptr size, const void* data, GLenum usage) {
    ThreadState& t = *tThread;
    mapEnds(t, buffer, false);
    settleReads(t, buffer);
    newStorage(t, buffer);
    encode_glNamedBufferData(t, buffer, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), usage);
    gReal.glNamedBufferData(buffer, size, data, usage);
}
void mural_glBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
    ThreadState& t = *tThread;
    settleBound(t, target);
    // writes client memory
    if (t.context && target == GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD)
        return gReal.glBufferSubData(target, offset, size, data);
    encode_glBufferSubData(t, target, offset, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0));
    gReal.glBufferSubData(target, offset, size, data);
}
void mural_glNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
    ThreadState& t = *tThread;
    settleReads(t, buffer);
    encode_glNamedBufferSubData(t, buffer, offset, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0));
    gReal.glNamedBufferSubData(buffer, offset, size, data);
}
// The program's own context may copy outdated data. That copy does not count as a write of the program.
void mural_glCopyBufferSubData(GLenum readTarget, GLenum writeTarget, GLintptr readOffset, GLintptr writeOffset,
                               GLsizeiptr size) {
    ThreadState& t = *tThread;
    boundUsed(t, readTarget);
    boundUsed(t, writeTarget);
    buffersRead(t);
    encode_glCopyBufferSubData(t, readTarget, writeTarget, readOffset, writeOffset, size);
    gReal.glCopyBufferSubData(readTarget, writeTarget, readOffset, writeOffset, size);
    if (mapsLast(t)) copiedHere(t, boundBuffer(writeTarget));
}
void mural_glCopyNamedBufferSubData(GLuint readBuffer, GLuint writeBuffer, GLintptr readOffset, GLintptr writeOffset,
                                    GLsizeiptr size) {
    ThreadState& t = *tThread;
    bufferUsed(t, readBuffer);
    bufferUsed(t, writeBuffer);
    buffersRead(t);
    encode_glCopyNamedBufferSubData(t, readBuffer, writeBuffer, readOffset, writeOffset, size);
    gReal.glCopyNamedBufferSubData(readBuffer, writeBuffer, readOffset, writeOffset, size);
    if (mapsLast(t)) copiedHere(t, writeBuffer);
}
void mural_glNamedCopyBufferSubDataEXT(GLuint readBuffer, GLuint writeBuffer, GLintptr readOffset, GLintptr writeOffset,
                                       GLsizeiptr size) {
    ThreadState& t = *tThread;
    bufferUsed(t, readBuffer);
    bufferUsed(t, writeBuffer);
    buffersRead(t);
    encode_glNamedCopyBufferSubDataEXT(t, readBuffer, writeBuffer, readOffset, writeOffset, size);
    gReal.glNamedCopyBufferSubDataEXT(readBuffer, writeBuffer, readOffset, writeOffset, size);
    if (mapsLast(t)) copiedHere(t, writeBuffer);
}
// The nodes write to persistent storage with glBufferSubData, which needs the dynamic bit.
void mural_glBufferStorage(GLenum target, GLsizeiptr size, const void* data, GLbitfield flags) {
    ThreadState& t = *tThread;
    settleBound(t, target);
    const GLbitfield wide = flags & GL_MAP_WRITE_BIT ? flags | GL_DYNAMIC_STORAGE_BIT : flags;
    encode_glBufferStorage(t, target, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), wide);
    gReal.glBufferStorage(target, size, data, flags);
}
void mural_glNamedBufferStorage(GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags) {
    ThreadState& t = *tThread;
    settleReads(t, buffer);
    const GLbitfield wide = flags & GL_MAP_WRITE_BIT ? flags | GL_DYNAMIC_STORAGE_BIT : flags;
    encode_glNamedBufferStorage(t, buffer, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), wide);
    gReal.glNamedBufferStorage(buffer, size, data, flags);
}
void mural_glNamedBufferStorageEXT(GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags) {
    ThreadState& t = *tThread;
    const GLbitfield wide = flags & GL_MAP_WRITE_BIT ? flags | GL_DYNAMIC_STORAGE_BIT : flags;
    encode_glNamedBufferStorageEXT(t, buffer, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), wide);
    gReal.glNamedBufferStorageEXT(buffer, size, data, flags);
}
void mural_glDeleteBuffers(GLsizei n, const GLuint* buffers) {
    ThreadState& t = *tThread;
    if (t.context && n > 0 && buffers) {
        for (GLsizei i = 0; i < n; ++i) {
            mapEnds(t, buffers[i], true);
            forgetReads(t, buffers[i]);
        }
        t.context->arrays.forgetBuffers(n, buffers);
        for (GLsizei i = 0; i < n; ++i) {
            if (buffers[i] == t.context->queryBuffer) t.context->queryBuffer = 0;
        }
    }
    encode_glDeleteBuffers(t, n, DataArg::of(buffers, n > 0 ? uint64_t(n) * 4 : 0));
    gReal.glDeleteBuffers(n, buffers);
}

// The EXT variants create the buffer of an unused name; the driver does that.
void mural_glGetNamedBufferSubDataEXT(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data) {
    ThreadState& t = *tThread;
    settleReads(t, buffer);
    if (offset >= 0 && size > 0) refreshBuffer(t, buffer, static_cast<uint64_t>(offset), static_cast<uint64_t>(size));
    gReal.glGetNamedBufferSubDataEXT(buffer, offset, size, data);
}
void* mural_glMapNamedBufferEXT(GLuint buffer, GLenum access) {
    return mapWhole(
        buffer, access, [=] { return sizeOfNamed(gReal.glGetNamedBufferParameterivEXT, buffer); },
        [=] { return gReal.glMapNamedBufferEXT(buffer, access); });
}
void* mural_glMapNamedBufferRangeEXT(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    return mapRange(buffer, offset, length, access,
                    [=] { return gReal.glMapNamedBufferRangeEXT(buffer, offset, length, access); });
}
GLboolean mural_glUnmapNamedBufferEXT(GLuint buffer) {
    unmaps(*tThread, buffer);
    const GLboolean intact = gReal.glUnmapNamedBufferEXT(buffer);
    unmappedHere(*tThread, buffer);
    return intact;
}
void mural_glFlushMappedNamedBufferRangeEXT(GLuint buffer, GLintptr offset, GLsizeiptr length) {
    mapFlushes(*tThread, buffer, offset, length);
    gReal.glFlushMappedNamedBufferRangeEXT(buffer, offset, length);
}

} // extern "C"
