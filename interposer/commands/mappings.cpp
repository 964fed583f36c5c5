// Mapped buffers. The program writes into the mapping of its own context's buffer; what it wrote is
// shipped when it unmaps or flushes. Persistent mappings are compared with a copy before every draw.
#include <cstdlib>
#include <new>

#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/own_records.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"

namespace mural {

// One mapping that the program has open.
struct PersistentMap {
    GLuint buffer;
    std::byte* memory;
    uint64_t offset, length;   // in the buffer, bytes
    GLbitfield access;
    std::byte* shadow;         // of persistent ones: what the nodes have
    PersistentMap* next;
};

namespace {

constexpr uint64_t kBlockBytes = 1024; // of the comparison: a changed block is shipped whole

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
    case GL_QUERY_BUFFER: name = GL_QUERY_BUFFER_BINDING; break;
    default: return 0;
    }
    GLint buffer = 0;
    gReal.glGetIntegerv(name, &buffer);
    return static_cast<GLuint>(buffer);
}

void ship(ThreadState& t, const PersistentMap& m, uint64_t from, uint64_t bytes) {
    records::bufferBytes(t, m.buffer, m.offset + from, DataArg::of(m.memory + from, bytes));
}

void remember(ThreadState& t, GLuint buffer, void* memory, uint64_t offset, uint64_t length, GLbitfield access) {
    Context* c = t.context;
    if (!c || !memory || !(access & GL_MAP_WRITE_BIT)) return;
    auto* m = static_cast<PersistentMap*>(std::malloc(sizeof(PersistentMap)));
    if (!m) return;
    *m = {buffer, static_cast<std::byte*>(memory), offset, length, access, nullptr, nullptr};
    if (access & GL_MAP_PERSISTENT_BIT) {
        // The nodes' copy is not known (other writers): the first comparison ships everything.
        m->shadow = static_cast<std::byte*>(std::malloc(length ? length : 1));
        if (m->shadow) {
            std::memcpy(m->shadow, memory, length);
            ship(t, *m, 0, length);
        }
    }
    Guard guard(c->group->lock);
    m->next = c->group->maps;
    c->group->maps = m;
    if (m->shadow) ++c->group->persistentMaps;
}

PersistentMap* findMap(Context& c, GLuint buffer) {
    for (PersistentMap* m = c.group->maps; m; m = m->next) {
        if (m->buffer == buffer) return m;
    }
    return nullptr;
}

void shipChanges(ThreadState& t, PersistentMap& m) {
    for (uint64_t at = 0; at < m.length; at += kBlockBytes) {
        uint64_t end = at;
        while (end < m.length) { // a run of changed blocks is one record
            const uint64_t block = m.length - end < kBlockBytes ? m.length - end : kBlockBytes;
            if (std::memcmp(m.shadow + end, m.memory + end, block) == 0) break;
            end += block;
        }
        if (end == at) continue;
        std::memcpy(m.shadow + at, m.memory + at, end - at);
        records::bufferBytes(t, m.buffer, m.offset + at, DataArg::of(m.shadow + at, end - at));
        at = end;
    }
}

// The mapping ends, by unmap, new storage or deletion; `ship` says whether its bytes still count.
void endMap(ThreadState& t, GLuint buffer, bool shipIt) {
    Context* c = t.context;
    if (!c || !c->group->maps) return;
    PersistentMap* m = findMap(*c, buffer);
    if (!m) return;
    if (shipIt) {
        if (m->shadow) shipChanges(t, *m);
        else if (!(m->access & GL_MAP_FLUSH_EXPLICIT_BIT)) ship(t, *m, 0, m->length);
    }
    Guard guard(c->group->lock);
    for (PersistentMap** p = &c->group->maps; *p; p = &(*p)->next) {
        if (*p != m) continue;
        *p = m->next;
        break;
    }
    if (m->shadow) --c->group->persistentMaps;
    std::free(m->shadow);
    std::free(m);
}

void flushMap(ThreadState& t, GLuint buffer, GLintptr offset, GLsizeiptr length) {
    Context* c = t.context;
    PersistentMap* m = c ? findMap(*c, buffer) : nullptr;
    if (!m || offset < 0 || length <= 0 || static_cast<uint64_t>(offset + length) > m->length) return;
    if (m->shadow) std::memcpy(m->shadow + offset, m->memory + offset, static_cast<size_t>(length));
    ship(t, *m, static_cast<uint64_t>(offset), static_cast<uint64_t>(length));
}

// Brings the program's own copy up to date before it is read. Immutable storage without the dynamic
// bit can't be written so; then what the program's own context has stands.
void refresh(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length) {
    Context* c = t.context;
    if (!c || !c->group->nodesWriteBuffers || t.drawLocally || buffer == 0 || length == 0) return;
    const void* bytes = askBuffer(t, buffer, offset, length);
    if (!bytes || !gReal.glBindBuffer) return;
    GLint before = 0;
    gReal.glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &before);
    raisesNothing(*c, [&] {
        gReal.glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
        gReal.glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(length), bytes);
        gReal.glBindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(before));
        driverError(); // ours, not the program's
    });
}

GLbitfield accessBits(GLenum access) {
    return access == GL_READ_ONLY ? GL_MAP_READ_BIT : access == GL_WRITE_ONLY ? GL_MAP_WRITE_BIT : GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;
}

uint64_t sizeOf(GLenum target) {
    GLint size = 0;
    gReal.glGetBufferParameteriv(target, GL_BUFFER_SIZE, &size);
    return static_cast<uint64_t>(size);
}

// By the buffer's name. What the nodes have written into it comes first, when it may be read.
template <class Size, class Map> void* mapNamed(GLuint buffer, GLenum access, Size&& size, Map&& map) {
    ThreadState& t = *tThread;
    GLint bytes = 0;
    if (t.context && access != GL_WRITE_ONLY && t.context->group->nodesWriteBuffers) {
        size(&bytes);
        refresh(t, buffer, 0, static_cast<uint64_t>(bytes));
    }
    void* memory = map();
    if (memory && t.context) {
        size(&bytes);
        remember(t, buffer, memory, 0, static_cast<uint64_t>(bytes), accessBits(access));
    }
    return memory;
}
template <class Map> void* mapNamedRange(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access, Map&& map) {
    ThreadState& t = *tThread;
    if (t.context && (access & GL_MAP_READ_BIT) && offset >= 0 && length > 0)
        refresh(t, buffer, static_cast<uint64_t>(offset), static_cast<uint64_t>(length));
    void* memory = map();
    if (memory && t.context) remember(t, buffer, memory, static_cast<uint64_t>(offset), static_cast<uint64_t>(length), access);
    return memory;
}

} // namespace

void shipPersistentMaps(ThreadState& t, ShareGroup& group) {
    for (PersistentMap* m = group.maps; m; m = m->next) {
        if (m->shadow && !(m->access & GL_MAP_FLUSH_EXPLICIT_BIT)) shipChanges(t, *m);
    }
}

} // namespace mural

using namespace mural;

extern "C" {

void* mural_glMapBuffer(GLenum target, GLenum access) {
    ThreadState& t = *tThread;
    if (t.context && access != GL_WRITE_ONLY && t.context->group->nodesWriteBuffers) refresh(t, boundBuffer(target), 0, sizeOf(target));
    void* memory = gReal.glMapBuffer(target, access);
    if (memory && t.context) remember(t, boundBuffer(target), memory, 0, sizeOf(target), accessBits(access));
    return memory;
}
void* mural_glMapBufferRange(GLenum target, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    ThreadState& t = *tThread;
    if (t.context && (access & GL_MAP_READ_BIT) && offset >= 0 && length > 0)
        refresh(t, boundBuffer(target), static_cast<uint64_t>(offset), static_cast<uint64_t>(length));
    void* memory = gReal.glMapBufferRange(target, offset, length, access);
    if (memory && t.context) remember(t, boundBuffer(target), memory, static_cast<uint64_t>(offset), static_cast<uint64_t>(length), access);
    return memory;
}
void* mural_glMapNamedBuffer(GLuint buffer, GLenum access) {
    const auto size = [=](GLint* bytes) { gReal.glGetNamedBufferParameteriv(buffer, GL_BUFFER_SIZE, bytes); };
    return mapNamed(buffer, access, size, [=] { return gReal.glMapNamedBuffer(buffer, access); });
}
void* mural_glMapNamedBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    return mapNamedRange(buffer, offset, length, access, [=] { return gReal.glMapNamedBufferRange(buffer, offset, length, access); });
}
void mural_glGetBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
    ThreadState& t = *tThread;
    if (t.context && t.context->group->nodesWriteBuffers && offset >= 0 && size > 0)
        refresh(t, boundBuffer(target), static_cast<uint64_t>(offset), static_cast<uint64_t>(size));
    gReal.glGetBufferSubData(target, offset, size, data);
}
void mural_glGetNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data) {
    ThreadState& t = *tThread;
    if (offset >= 0 && size > 0) refresh(t, buffer, static_cast<uint64_t>(offset), static_cast<uint64_t>(size));
    gReal.glGetNamedBufferSubData(buffer, offset, size, data);
}
GLboolean mural_glUnmapBuffer(GLenum target) {
    ThreadState& t = *tThread;
    if (t.context && t.context->group->maps) endMap(t, boundBuffer(target), true);
    return gReal.glUnmapBuffer(target);
}
GLboolean mural_glUnmapNamedBuffer(GLuint buffer) {
    endMap(*tThread, buffer, true);
    return gReal.glUnmapNamedBuffer(buffer);
}
void mural_glFlushMappedBufferRange(GLenum target, GLintptr offset, GLsizeiptr length) {
    ThreadState& t = *tThread;
    if (t.context) flushMap(t, boundBuffer(target), offset, length);
    gReal.glFlushMappedBufferRange(target, offset, length);
}
void mural_glFlushMappedNamedBufferRange(GLuint buffer, GLintptr offset, GLsizeiptr length) {
    flushMap(*tThread, buffer, offset, length);
    gReal.glFlushMappedNamedBufferRange(buffer, offset, length);
}

// New storage and deletion end a mapping without its bytes counting (GL 4.6 §6.3.3).
void mural_glBufferData(GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
    ThreadState& t = *tThread;
    if (t.context && t.context->group->maps) endMap(t, boundBuffer(target), false);
    encode_glBufferData(t, target, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), usage);
    gReal.glBufferData(target, size, data, usage);
}
void mural_glNamedBufferData(GLuint buffer, GLsizeiptr size, const void* data, GLenum usage) {
    ThreadState& t = *tThread;
    endMap(t, buffer, false);
    encode_glNamedBufferData(t, buffer, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), usage);
    gReal.glNamedBufferData(buffer, size, data, usage);
}
void mural_glBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
    ThreadState& t = *tThread;
    encode_glBufferSubData(t, target, offset, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0));
    gReal.glBufferSubData(target, offset, size, data);
}
void mural_glNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
    ThreadState& t = *tThread;
    encode_glNamedBufferSubData(t, buffer, offset, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0));
    gReal.glNamedBufferSubData(buffer, offset, size, data);
}
// The nodes write into persistent storage through glBufferSubData: they need the dynamic bit.
void mural_glBufferStorage(GLenum target, GLsizeiptr size, const void* data, GLbitfield flags) {
    ThreadState& t = *tThread;
    const GLbitfield wide = flags & GL_MAP_WRITE_BIT ? flags | GL_DYNAMIC_STORAGE_BIT : flags;
    encode_glBufferStorage(t, target, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), wide);
    gReal.glBufferStorage(target, size, data, flags);
}
void mural_glNamedBufferStorage(GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags) {
    ThreadState& t = *tThread;
    const GLbitfield wide = flags & GL_MAP_WRITE_BIT ? flags | GL_DYNAMIC_STORAGE_BIT : flags;
    encode_glNamedBufferStorage(t, buffer, size, DataArg::of(data, size > 0 ? uint64_t(size) : 0), wide);
    gReal.glNamedBufferStorage(buffer, size, data, flags);
}
void mural_glDeleteBuffers(GLsizei n, const GLuint* buffers) {
    ThreadState& t = *tThread;
    if (t.context && n > 0 && buffers) {
        for (GLsizei i = 0; i < n; ++i) endMap(t, buffers[i], false);
        t.context->arrays.forgetBuffers(n, buffers);
        for (GLsizei i = 0; i < n; ++i) {
            if (buffers[i] == t.context->queryBuffer) t.context->queryBuffer = 0;
        }
    }
    encode_glDeleteBuffers(t, n, DataArg::of(buffers, n > 0 ? uint64_t(n) * 4 : 0));
    gReal.glDeleteBuffers(n, buffers);
}

// The EXT forms differ in that they make the buffer when it has only a name yet; the driver does that.
void* mural_glMapNamedBufferEXT(GLuint buffer, GLenum access) {
    const auto size = [=](GLint* bytes) { gReal.glGetNamedBufferParameterivEXT(buffer, GL_BUFFER_SIZE, bytes); };
    return mapNamed(buffer, access, size, [=] { return gReal.glMapNamedBufferEXT(buffer, access); });
}
void* mural_glMapNamedBufferRangeEXT(GLuint buffer, GLintptr offset, GLsizeiptr length, GLbitfield access) {
    return mapNamedRange(buffer, offset, length, access, [=] { return gReal.glMapNamedBufferRangeEXT(buffer, offset, length, access); });
}
GLboolean mural_glUnmapNamedBufferEXT(GLuint buffer) {
    endMap(*tThread, buffer, true);
    return gReal.glUnmapNamedBufferEXT(buffer);
}
void mural_glFlushMappedNamedBufferRangeEXT(GLuint buffer, GLintptr offset, GLsizeiptr length) {
    flushMap(*tThread, buffer, offset, length);
    gReal.glFlushMappedNamedBufferRangeEXT(buffer, offset, length);
}

} // extern "C"
