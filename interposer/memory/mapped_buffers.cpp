#include "interposer/memory/mapped_buffers.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "common/memory/dirty_pages.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

// An active mapping of the program.
struct MappedBuffer {
    GLuint buffer;
    std::byte* memory;
    uint64_t offset, length; // in the buffer, bytes
    GLbitfield access;
    DirtyPages changes; // for persistent mappings without explicit flushes
    MappedBuffer* next;
    bool pinned = false; // client memory: a permanent mapping

    [[nodiscard]] bool has(GLbitfield bits) const { return (access & bits) != 0; }
    // Written without further GL calls.
    [[nodiscard]] bool silent() const {
        return has(GL_MAP_PERSISTENT_BIT) && has(GL_MAP_WRITE_BIT) && !has(GL_MAP_FLUSH_EXPLICIT_BIT);
    }
};

namespace {

constexpr uint64_t kRequestBytes = uint64_t{16} << 20; // per request

// Returns whether the nodes draw and the program's own context does not. Only the nodes then know the content of
// buffers that shaders write. Also true for contexts that currently select or compile a list.
bool nodesDraw(const ThreadState& t) {
    return t.context && !swapLocally() && !t.context->drawsPixmap && !t.context->drawsFeedback;
}

// Locks the list of mappings. A request to the nodes ships mappings; the same thread may do so while it holds the lock.
class MapsLocked {
public:
    explicit MapsLocked(ThreadState& t)
        : group_(*t.context->group), outer_(group_.mapsOwner.load(std::memory_order_relaxed) == &t) {
        if (outer_) return;
        group_.mapsLock.lock();
        group_.mapsOwner.store(&t, std::memory_order_relaxed);
    }
    ~MapsLocked() {
        if (outer_) return;
        group_.mapsOwner.store(nullptr, std::memory_order_relaxed);
        group_.mapsLock.unlock();
    }
    MapsLocked(const MapsLocked&) = delete;
    MapsLocked& operator=(const MapsLocked&) = delete;

private:
    ShareGroup& group_;
    bool outer_;
};

MappedBuffer* findMap(const ShareGroup& group, GLuint buffer) {
    for (MappedBuffer* m = group.maps; m; m = m->next) {
        if (m->buffer == buffer) return m;
    }
    return nullptr;
}

void ship(ThreadState& t, const MappedBuffer& m, uint64_t from, const std::byte* bytes, uint64_t count) {
    records::bufferBytes(t, m.buffer, m.offset + from, DataArg::of(bytes, count));
}

void shipChanges(ThreadState& t, MappedBuffer& m) {
    if (!m.changes.active()) return ship(t, m, 0, m.memory, m.length); // no memory for change tracking
    struct Shipping {
        ThreadState& t;
        MappedBuffer& m;
    } shipping{t, m};
    m.changes.collect(
        t.context->group->nodesWriteBuffers,
        [](void* self, size_t from, const std::byte* bytes, size_t count) {
            const auto& its = *static_cast<Shipping*>(self);
            ship(its.t, its.m, from, bytes, count);
        },
        &shipping);
}

bool mayBeWritten(const ShareGroup& group, GLuint buffer) {
    return group.nodesWriteBuffers && (group.nodesWrite.get(buffer) || !NameBits::known(buffer));
}

// Whether the bound buffer allows glBufferSubData, and writable mappings.
struct Writable {
    bool immutable, replaced, mapped;
};
Writable writable(GLenum target) {
    GLint immutable = 0, flags = 0;
    gReal.glGetBufferParameteriv(target, GL_BUFFER_IMMUTABLE_STORAGE, &immutable);
    if (immutable) gReal.glGetBufferParameteriv(target, GL_BUFFER_STORAGE_FLAGS, &flags);
    driverError(); // of drivers without immutable storage
    return {immutable != 0, !immutable || (flags & GL_DYNAMIC_STORAGE_BIT), (flags & GL_MAP_WRITE_BIT) != 0};
}

// Writes to storage that programs may not write, with clears of a few bytes each. Returns false for too many bytes, or
// without the command.
bool clearIntoBound(uint64_t offset, const void* bytes, uint64_t length) {
    constexpr uint64_t kCleared = uint64_t{64} << 10;
    if (!gReal.glClearBufferSubData || length > kCleared) return false;
    constexpr GLenum kPlace[] = {GL_UNPACK_SWAP_BYTES, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS,
                                 GL_UNPACK_SKIP_IMAGES};
    GLint before[4] = {}; // Mesa checks this binding
    for (int i = 0; i < 4; ++i) {
        gReal.glGetIntegerv(kPlace[i], &before[i]);
        gReal.glPixelStorei(kPlace[i], 0);
    }
    struct Element {
        uint64_t bytes; // alignment of the range
        GLenum internal, format, type;
    };
    constexpr Element kElements[] = {{16, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
                                     {4, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT},
                                     {1, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE}};
    for (uint64_t at = 0; at < length;) {
        const Element* e = kElements;
        while ((offset + at) % e->bytes != 0 || length - at < e->bytes) ++e;
        gReal.glClearBufferSubData(GL_COPY_WRITE_BUFFER, e->internal, static_cast<GLintptr>(offset + at),
                                   static_cast<GLsizeiptr>(e->bytes), e->format, e->type,
                                   static_cast<const std::byte*>(bytes) + at);
        at += e->bytes;
    }
    for (int i = 0; i < 4; ++i) gReal.glPixelStorei(kPlace[i], before[i]);
    if (driverError() != GL_NO_ERROR) return false;
    gReal.glFinish(); // it may be mapped
    return true;
}

// Writes with a copy. The temporary buffer uses up the program's next native name, so this is the last resort.
void copyIntoBound(uint64_t offset, const void* bytes, uint64_t length) {
    GLint before = 0;
    GLuint between = 0;
    gReal.glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &before);
    gReal.glGenBuffers(1, &between);
    gReal.glBindBuffer(GL_COPY_READ_BUFFER, between);
    gReal.glBufferData(GL_COPY_READ_BUFFER, static_cast<GLsizeiptr>(length), bytes, GL_STREAM_COPY);
    gReal.glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, static_cast<GLintptr>(offset),
                              static_cast<GLsizeiptr>(length));
    gReal.glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(before));
    gReal.glDeleteBuffers(1, &between);
    gReal.glFinish(); // it may be mapped
}

// Binds the buffer temporarily to a target from which nothing draws.
class OwnCopy {
public:
    OwnCopy(const Context& c, GLuint buffer) : copies_(c.version >= (c.api == wire::Api::Desktop ? 31 : 30)) {
        gReal.glGetIntegerv(copies_ ? GL_COPY_WRITE_BUFFER_BINDING : GL_PIXEL_PACK_BUFFER_BINDING, &before_);
        gReal.glBindBuffer(target(), buffer);
    }
    ~OwnCopy() {
        gReal.glBindBuffer(target(), static_cast<GLuint>(before_));
        driverError(); // our own error, not the program's
    }
    OwnCopy(const OwnCopy&) = delete;
    OwnCopy& operator=(const OwnCopy&) = delete;
    [[nodiscard]] GLenum target() const { return copies_ ? GL_COPY_WRITE_BUFFER : GL_PIXEL_PACK_BUFFER; }

private:
    bool copies_;
    GLint before_ = 0;
};

void writeBound(GLenum target, uint64_t offset, const void* bytes, uint64_t length) {
    const auto at = static_cast<GLintptr>(offset);
    const auto size = static_cast<GLsizeiptr>(length);
    const Writable may = writable(target);
    if (may.replaced) {
        gReal.glBufferSubData(target, at, size, bytes);
        if (may.immutable) gReal.glFinish(); // it may be mapped
        return;
    }
    void* const mapped = may.mapped ? gReal.glMapBufferRange(target, at, size, GL_MAP_WRITE_BIT) : nullptr;
    driverError(); // the program may have mapped it
    if (mapped) {
        std::memcpy(mapped, bytes, length);
        gReal.glUnmapBuffer(target);
    } else if (!clearIntoBound(offset, bytes, length)) {
        copyIntoBound(offset, bytes, length);
    }
}

} // namespace

void writeOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, const void* bytes, uint64_t length) {
    stashError(*t.context, driverError());
    const OwnCopy own(*t.context, buffer);
    writeBound(own.target(), offset, bytes, length);
}

bool ownSize(ThreadState& t, GLuint buffer, uint64_t& size) {
    stashError(*t.context, driverError());
    const OwnCopy own(*t.context, buffer);
    GLint bytes = 0, mapped = GL_FALSE;
    gReal.glGetBufferParameteriv(own.target(), GL_BUFFER_SIZE, &bytes);
    gReal.glGetBufferParameteriv(own.target(), GL_BUFFER_MAPPED, &mapped);
    size = bytes > 0 ? static_cast<uint64_t>(bytes) : 0;
    return mapped == GL_FALSE;
}

bool readOwnCopy(ThreadState& t, GLuint buffer, uint64_t offset, void* into, uint64_t length) {
    stashError(*t.context, driverError());
    const OwnCopy own(*t.context, buffer);
    const auto at = static_cast<GLintptr>(offset);
    const auto size = static_cast<GLsizeiptr>(length);
    if (t.context->api == wire::Api::Desktop) {
        gReal.glGetBufferSubData(own.target(), at, size, into);
        return driverError() == GL_NO_ERROR;
    }
    const void* const mapped = gReal.glMapBufferRange(own.target(), at, size, GL_MAP_READ_BIT);
    if (!mapped) return false;
    std::memcpy(into, mapped, length);
    gReal.glUnmapBuffer(own.target());
    return true;
}

void refreshBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length, const char* by) {
    if (!nodesDraw(t) || !t.context->group->nodesWriteBuffers || buffer == 0 || !gReal.glBindBuffer ||
        nodesLack(t, buffer))
        return;
    if (!gReal.glIsBuffer(buffer)) return; // an unused name: binding it would create a buffer
    for (uint64_t at = 0; at < length; at += kRequestBytes) {
        const uint64_t count = length - at < kRequestBytes ? length - at : kRequestBytes;
        const void* bytes = requestBuffer(t, buffer, offset + at, count, by);
        if (!bytes) return;
        writeOwnCopy(t, buffer, offset + at, bytes, count);
    }
}

void refreshForMap(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t length, GLbitfield access, const char* by) {
    constexpr GLbitfield kForgets =
        GL_MAP_INVALIDATE_RANGE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT | GL_MAP_FLUSH_EXPLICIT_BIT;
    if (!t.context || !t.context->group->nodesWriteBuffers) return;
    const bool shipsAll = !(access & kForgets) && mayBeWritten(*t.context->group, buffer);
    if (access & GL_MAP_READ_BIT || shipsAll) refreshBuffer(t, buffer, offset, length, by);
}

namespace {

// Writes only the differences: other threads may write elsewhere in the mapping.
void showInMap(ThreadState& t, MappedBuffer& m, uint64_t from, const std::byte* bytes, uint64_t count) {
    struct Showing {
        ThreadState& t;
        MappedBuffer& m;
    } showing{t, m};
    if (m.changes.active()) {
        m.changes.accept(
            from, bytes, count,
            [](void* self, size_t at, const std::byte* changed, size_t size) {
                const auto& its = *static_cast<Showing*>(self);
                writeOwnCopy(its.t, its.m.buffer, its.m.offset + at, changed, size);
            },
            &showing);
    } else if (std::memcmp(m.memory + from, bytes, count) != 0) {
        writeOwnCopy(t, m.buffer, m.offset + from, bytes, count);
    }
}

} // namespace

void refreshMaps(ThreadState& t, const char* by) {
    if (!t.context || !t.context->group->persistentMaps || !t.context->group->nodesWriteBuffers || !nodesDraw(t))
        return;
    const ShareGroup& group = *t.context->group;
    const MapsLocked locked(t);
    for (MappedBuffer* m = group.maps; m; m = m->next) {
        // Data written by the nodes is the baseline for change detection, even if the program does not read it.
        const bool stale = m->has(GL_MAP_READ_BIT) || mayBeWritten(group, m->buffer);
        if (!m->has(GL_MAP_PERSISTENT_BIT) || !stale) continue;
        for (uint64_t at = 0; at < m->length; at += kRequestBytes) {
            const uint64_t count = m->length - at < kRequestBytes ? m->length - at : kRequestBytes;
            const void* bytes = requestBuffer(t, m->buffer, m->offset + at, count, by);
            if (bytes) showInMap(t, *m, at, static_cast<const std::byte*>(bytes), count);
        }
    }
}

void copiedHere(ThreadState& t, GLuint buffer) {
    if (!t.context->group->nodesWriteBuffers || !nodesDraw(t)) return;
    const MapsLocked locked(t);
    MappedBuffer* m = findMap(*t.context->group, buffer);
    if (!m || !m->changes.active()) return;
    gReal.glFinish();
    m->changes.accept(
        0, m->memory, m->length, [](void*, size_t, const std::byte*, size_t) {}, nullptr);
}

void nodesMayWrite(ThreadState& t, GLuint buffer) {
    if (!t.context) return;
    t.context->group->nodesWriteBuffers = true;
    if (buffer) t.context->group->nodesWrite.set(buffer, true);
}

void buffersMayBeWritten(ThreadState& t, GLsizei count, const GLuint* buffers) {
    nodesMayWrite(t, 0);
    for (GLsizei i = 0; buffers && i < count; ++i) nodesMayWrite(t, buffers[i]);
}

namespace {

void begin(ThreadState& t, GLuint buffer, void* memory, uint64_t offset, uint64_t length, GLbitfield access,
           bool pinned) {
    void* storage = std::malloc(sizeof(MappedBuffer));
    if (!storage) return;
    auto* m = new (storage)
        MappedBuffer{buffer, static_cast<std::byte*>(memory), offset, length, access, {}, nullptr, pinned};
    // Pinned client memory is not write-protected: other processes may share it, and the program may remap it.
    if (m->silent()) m->changes.begin(memory, length, !pinned);
    ShareGroup& group = *t.context->group;
    const MapsLocked locked(t);
    m->next = group.maps;
    group.maps = m;
    if (m->has(GL_MAP_PERSISTENT_BIT)) ++group.persistentMaps;
}

bool isPinned(ThreadState& t, GLuint buffer) {
    const MapsLocked locked(t);
    const MappedBuffer* m = findMap(*t.context->group, buffer);
    return m && m->pinned;
}

} // namespace

void mapBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t offset, uint64_t length, GLbitfield access) {
    if (!t.context || !memory || !(access & (GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT)) || isPinned(t, buffer)) return;
    begin(t, buffer, memory, offset, length, access, false);
}

void pinBegins(ThreadState& t, GLuint buffer, void* memory, uint64_t length) {
    if (t.context && memory && length > 0)
        begin(t, buffer, memory, 0, length, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT, true);
}

void forgetMaps(ShareGroup& group) {
    while (MappedBuffer* m = group.maps) {
        group.maps = m->next;
        m->~MappedBuffer();
        std::free(m);
    }
}

void unmaps(ThreadState& t, GLuint buffer) {
    if (t.context && t.context->group->maps && !isPinned(t, buffer)) mapEnds(t, buffer, true);
}

void mapEnds(ThreadState& t, GLuint buffer, bool shipIt) {
    if (!t.context || !t.context->group->maps) return;
    ShareGroup& group = *t.context->group;
    const MapsLocked locked(t);
    for (MappedBuffer** p = &group.maps; *p; p = &(*p)->next) {
        MappedBuffer* m = *p;
        if (m->buffer != buffer) continue;
        if (shipIt && m->silent())
            shipChanges(t, *m);
        else if (shipIt && m->has(GL_MAP_WRITE_BIT) && !m->has(GL_MAP_FLUSH_EXPLICIT_BIT))
            ship(t, *m, 0, m->memory, m->length);
        *p = m->next;
        if (m->has(GL_MAP_PERSISTENT_BIT)) --group.persistentMaps;
        m->~MappedBuffer();
        std::free(m);
        return;
    }
}

void mapFlushes(ThreadState& t, GLuint buffer, GLintptr offset, GLsizeiptr length) {
    if (!t.context || !t.context->group->maps || offset < 0 || length <= 0) return;
    const MapsLocked locked(t);
    const MappedBuffer* m = findMap(*t.context->group, buffer);
    if (!m || static_cast<uint64_t>(offset + length) > m->length) return;
    ship(t, *m, static_cast<uint64_t>(offset), m->memory + offset, static_cast<uint64_t>(length));
}

void flushPersistentMaps(ThreadState& t) {
    const Session* s = Session::current();
    if (!s || !s->alive() || t.context->group->mapsOwner.load(std::memory_order_relaxed) == &t) return;
    const MapsLocked locked(t);
    for (MappedBuffer* m = t.context->group->maps; m; m = m->next) {
        if (m->silent()) shipChanges(t, *m);
    }
}

} // namespace mural
