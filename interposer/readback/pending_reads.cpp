#include "interposer/readback/pending_reads.hpp"

#include <cstdlib>
#include <new>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/readback/deferred_replies.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/readback/read_area.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

struct PendingRead {
    GLuint buffer;
    PackTarget target;
    DeferredReply* answer;
    PendingRead* next;
};

namespace {

constexpr uint64_t kRecordBytes = uint64_t{16} << 20; // bytes per record

// Returns null without a live session, and between glBegin and glEnd, where the driver accepts no such call.
Session* sessionFor(const ThreadState& t) {
    Session* const s = Session::current();
    return s && s->alive() && t.context && t.context->openPrimitive == kNoPrimitive ? s : nullptr;
}

void put(ThreadState& t, const PendingRead& read) {
    const sizes::ImageLayout& layout = read.target.layout;
    keepPart(read.answer->bytes, read.target.part);
    if (isTight(layout))
        return writeOwnCopy(t, read.buffer, read.target.offset + static_cast<uint64_t>(layout.firstByte),
                            read.answer->bytes, sizes::tightBytes(layout));
    const size_t span = sizes::spanBytes(layout);
    void* const whole = scratchMemory(t, span);
    if (!whole || !readOwnCopy(t, read.buffer, read.target.offset, whole, span)) return; // preserves bytes between rows
    sizes::unpackTight(whole, read.answer->bytes, layout);
    writeOwnCopy(t, read.buffer, read.target.offset, whole, span);
}

// Removes the entry at `p` from the list.
void drop(PendingReads& reads, PendingRead*& p) {
    PendingRead* const read = p;
    p = read->next;
    reads.sizeBytes -= read->answer->sizeBytes;
    reads.count.fetch_sub(1, std::memory_order_relaxed);
    deferred::release(read->answer);
    std::free(read);
}

// Completes the read at `p` and removes it from the list. Requires the lock, as does settleLocked().
void settleFirst(ThreadState& t, Session& s, PendingReads& reads, PendingRead*& p, const char* by) {
    if (!s.waitDeferred(p->answer->request, by))
        answerLost(*t.context);
    else if (p->answer->state == DeferredReply::State::Arrived)
        put(t, *p);
    drop(reads, p);
}

void settleLocked(ThreadState& t, Session& s, PendingReads& reads, GLuint buffer, const char* by) {
    for (PendingRead** p = &reads.first; *p;) {
        if ((*p)->buffer == buffer)
            settleFirst(t, s, reads, *p, by);
        else
            p = &(*p)->next;
    }
}

// Drops pending reads into the buffer after the end of the session. Their error is raised when the program uses the
// buffer.
void loseReads(ThreadState& t, GLuint buffer) {
    const Session* const s = Session::current();
    if (!s || s->alive() || !t.context) return;
    PendingReads& reads = t.context->group->pendingReads;
    Guard guard(reads.lock);
    for (PendingRead** p = &reads.first; *p;) {
        if ((*p)->buffer != buffer) {
            p = &(*p)->next;
            continue;
        }
        answerLost(*t.context);
        drop(reads, *p);
    }
}

// Call after a wait, without a lock held, because driver events may call functions of the program.
void waited(ThreadState& t, const Session& s) {
    takeDriverEvents(t);
    if (!s.alive()) refreshDrawLocally(t);
}

// Sends the buffer's bytes to the nodes. Returns false if the buffer is mapped, so they cannot be read now.
bool sendToNodes(ThreadState& t, GLuint buffer) {
    uint64_t size = 0;
    if (!ownSize(t, buffer, size)) return false;
    for (uint64_t at = 0; at < size; at += kRecordBytes) {
        const uint64_t count = size - at < kRecordBytes ? size - at : kRecordBytes;
        void* const bytes = scratchMemory(t, count);
        if (!bytes || !readOwnCopy(t, buffer, at, bytes, count)) return true; // nothing can be sent
        records::bufferBytes(t, buffer, at, DataArg::of(bytes, count));
    }
    return true;
}

bool append(PendingReads& reads, GLuint buffer, const PackTarget& target, DeferredReply* answer) {
    void* const memory = std::malloc(sizeof(PendingRead));
    if (!memory) return false;
    PendingRead** end = &reads.first;
    while (*end) end = &(*end)->next;
    *end = new (memory) PendingRead{buffer, target, answer, nullptr};
    reads.sizeBytes += answer->sizeBytes;
    reads.count.fetch_add(1, std::memory_order_relaxed);
    return true;
}

// Returns an entry for the reply; null: no memory. Completes the oldest reads first if the limits are reached.
DeferredReply* makeRoom(ThreadState& t, Session& s, PendingReads& reads, uint64_t sizeBytes, const char* by) {
    s.takeArrived();
    while (reads.first && (reads.count.load(std::memory_order_relaxed) >= kMaxDeferred ||
                           reads.sizeBytes + sizeBytes > kMaxDeferredReplyBytes))
        settleFirst(t, s, reads, reads.first, by);
    while (const uint32_t oldest = deferred::conflictingWith(sizeBytes))
        if (!s.waitDeferred(oldest, by)) return nullptr;
    return deferred::add(s.nextDeferred(), sizeBytes);
}

template <class Send>
bool defer(ThreadState& t, const PackTarget& target, uint64_t sizeBytes, const char* by, Send&& send) {
    Session* const s = sessionFor(t);
    if (!s || sizeBytes == 0 || sizeBytes > kMaxDeferredReplyBytes) return false;
    const GLuint buffer = boundPackBuffer();
    PendingReads& reads = t.context->group->pendingReads;
    // A buffer that another context of the share group has deleted may still be bound here.
    if (!reads.onlyReadInto(buffer) || !gReal.glIsBuffer(buffer)) return false;
    buffersRead(t);
    {
        Guard guard(reads.lock);
        DeferredReply* const answer = reads.onlyReadInto(buffer) ? makeRoom(t, *s, reads, sizeBytes, by) : nullptr;
        if (!answer) return false;
        if (!append(reads, buffer, target, answer)) {
            deferred::arrived(answer->request, false);
            deferred::release(answer);
            return false;
        }
        reads.nodesLack.set(buffer, true);
        send(answer->request);
        s->publish(t, false, false);
    }
    waited(t, *s);
    return true;
}

} // namespace

GLuint boundPackBuffer() {
    GLint buffer = 0;
    gReal.glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer);
    return static_cast<GLuint>(buffer);
}

bool deferPixels(ThreadState& t, const ReadArea& area, GLenum format, GLenum type, const PackTarget& target,
                 const char* by) {
    const uint32_t group = sizes::groupBytes(format, type);
    if (area.w <= 0 || area.h <= 0 || group == 0 ||
        t.pixels.inSeries(t, {format, type, group, false}, {area.x, area.y, area.w, area.h}))
        return false;
    const bool defers = defer(t, target, uint64_t(area.w) * uint64_t(area.h) * group, by, [&](uint32_t request) {
        records::requestPixels(t, request, area.x, area.y, area.w, area.h, format, type, group);
    });
    if (defers) t.pixels.answered(t, {format, type, group, false}, {area.x, area.y, area.w, area.h}, false);
    return defers;
}

bool deferTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type,
                   uint64_t sizeBytes, const PackTarget& target, const char* by) {
    return defer(t, target, sizeBytes, by, [&](uint32_t request) {
        records::requestTexImage(t, request, byName, targetOrTexture, level, format, type, sizeBytes);
    });
}

void settle(ThreadState& t, GLuint buffer, const char* by) {
    Session* const s = sessionFor(t);
    if (!s) return loseReads(t, buffer);
    if (buffer == 0) return;
    PendingReads& reads = t.context->group->pendingReads;
    {
        Guard guard(reads.lock);
        settleLocked(t, *s, reads, buffer, by);
    }
    waited(t, *s);
}

void firstUse(ThreadState& t, GLuint buffer, const char* by) {
    Session* const s = sessionFor(t);
    if (!s) return loseReads(t, buffer);
    PendingReads& reads = t.context->group->pendingReads;
    {
        Guard guard(reads.lock);
        settleLocked(t, *s, reads, buffer, by);
        if (reads.nodesLack.get(buffer)) {
            if (sendToNodes(t, buffer))
                reads.nodesLack.set(buffer, false);
            else
                reads.dueAtUnmap.store(true, std::memory_order_relaxed);
        }
        reads.usedElsewhere.set(buffer, true);
    }
    waited(t, *s);
}

bool nodesLack(const ThreadState& t, GLuint buffer) {
    return t.context && t.context->group->pendingReads.nodesLack.get(buffer);
}

void unmappedHere(ThreadState& t, GLuint buffer) {
    if (!t.context || !t.context->group->pendingReads.dueAtUnmap.load(std::memory_order_relaxed) || !sessionFor(t))
        return;
    PendingReads& reads = t.context->group->pendingReads;
    Guard guard(reads.lock);
    if (nodesLack(t, buffer) && reads.usedElsewhere.get(buffer) && sendToNodes(t, buffer))
        reads.nodesLack.set(buffer, false);
}

// After the buffer's first other use the nodes lack the bytes that reads have written into its new storage.
void newStorage(ThreadState& t, GLuint buffer) {
    if (!t.context) return;
    PendingReads& reads = t.context->group->pendingReads;
    if (reads.dueAtUnmap.load(std::memory_order_relaxed) && reads.usedElsewhere.get(buffer))
        reads.nodesLack.set(buffer, false);
}

void forgetReads(ThreadState& t, GLuint buffer, const char* by) {
    if (!t.context || buffer == 0 || t.context->openPrimitive != kNoPrimitive) return;
    PendingReads& reads = t.context->group->pendingReads;
    if (reads.count.load(std::memory_order_relaxed) > 0) {
        // The buffer persists while another context has it bound.
        if (known::sharerOf(*t.context)) settle(t, buffer, by);
        if (!sessionFor(t)) return;
        Guard guard(reads.lock);
        for (PendingRead** p = &reads.first; *p;) {
            if ((*p)->buffer == buffer)
                drop(reads, *p);
            else
                p = &(*p)->next;
        }
    }
    reads.usedElsewhere.set(buffer, false);
    reads.nodesLack.set(buffer, false);
}

void forgetReads(ShareGroup& group) {
    while (group.pendingReads.first) drop(group.pendingReads, group.pendingReads.first);
}

} // namespace mural
