#include "interposer/readback/node_requests.hpp"

#include <utility>

#include "interposer/context/context.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/context/open_primitive.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

namespace {

// Sends one request and reads its reply into the memory that room(sizeBytes) returns. Null skips the reply. If the
// session ends before the reply arrives, a GL error informs the program.
template <class Send, class Room> bool requestReply(ThreadState& t, const char* by, Room&& memoryFor, Send&& send) {
    Session* s = Session::current();
    if (!s || !t.context) return false;
    if (!s->alive()) {
        answerLost(*t.context);
        return false;
    }
    buffersRead(t);
    const uint32_t request = s->beginRequest(by);
    send(request);
    s->publish(t, false);
    wire::ReplyHeader header{};
    bool ok = s->answerHeader(request, header);
    if (ok) {
        void* const into = header.failed ? nullptr : memoryFor(header.sizeBytes);
        ok = s->answerBytes(into, header.sizeBytes) && into;
    }
    s->endRequest();
    takeDriverEvents(t);
    if (!s->alive()) {
        if (!ok) answerLost(*t.context);
        refreshDrawLocally(t);
    }
    return ok;
}

// The same for a reply of known size. `into` must hold sizeBytes.
template <class Send> bool requestReply(ThreadState& t, const char* by, void* into, uint64_t sizeBytes, Send&& send) {
    return requestReply(
        t, by, [=](uint64_t replyBytes) { return replyBytes == sizeBytes ? into : nullptr; }, send);
}

} // namespace

GLenum takeError(ThreadState& t) {
    Context& c = *t.context;
    const GLenum later = gReal.glGetError(); // a driver keeps only the first error; later ones are lost natively, too
    if (c.stashedError && !later && c.compatible() && answersNothing()) return GL_NO_ERROR;
    const GLenum error = c.stashedError ? c.stashedError : later;
    c.stashedError = 0;
    if (error) {
        if (records::errorReported(t)) ++c.errorsReported;
        return error;
    }
    return std::exchange(c.outOfMemoryDue, false) ? GL_OUT_OF_MEMORY : GL_NO_ERROR;
}

GLenum driverError() { return gReal.glGetError(); }

bool executesInPrimitive(const Context& c) { return c.drawsList && answersNothing(); }

void stashError(Context& c, GLenum error) {
    if (!c.stashedError) c.stashedError = error; // GL keeps the first
}

void answerLost(Context& c) {
    stashError(c, driverError()); // an earlier error of the program takes precedence
    stashError(c, GL_OUT_OF_MEMORY);
}

const void* requestPixels(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type,
                          uint32_t how, const char* by) {
    const uint32_t group = sizes::groupBytes(format, type);
    if (w <= 0 || h <= 0 || group == 0) return nullptr;
    const uint64_t bytes = uint64_t(w) * uint64_t(h) * group;
    void* into = secondScratch(t, bytes);
    if (!into) return nullptr;
    const ReadPixelsCache::Kind kind{format, type, group, how};
    const ReadPixelsCache::Box box{x, y, w, h};
    if (t.pixels.find(t, kind, box, into)) return into;
    const ReadPixelsCache::Box wide = t.pixels.wider(t, kind, box);
    const bool keeps = wide.w != w || wide.h != h;
    const uint64_t wideBytes = keeps ? uint64_t(wide.w) * uint64_t(wide.h) * group : bytes;
    void* const answer = keeps ? t.pixels.memory(wideBytes) : into;
    const bool ok = answer && requestReply(t, by, answer, wideBytes, [&](uint32_t request) {
                        records::requestPixels(t, request, wide.x, wide.y, wide.w, wide.h, format, type, group | how);
                    });
    if (!ok) return nullptr;
    t.pixels.answered(t, kind, wide, keeps);
    return !keeps || t.pixels.find(t, kind, box, into) ? into : nullptr;
}

void* requestTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type,
                      uint64_t sizeBytes, const char* by) {
    void* into = secondScratch(t, sizeBytes);
    if (!into || sizeBytes == 0) return nullptr;
    const bool ok = requestReply(t, by, into, sizeBytes, [&](uint32_t request) {
        records::requestTexImage(t, request, byName, targetOrTexture, level, format, type, sizeBytes);
    });
    return ok ? into : nullptr;
}

bool requestQuery(ThreadState& t, GLuint query, GLenum name, uint64_t& value, const char* by) {
    return requestReply(t, by, &value, sizeof value,
                        [&](uint32_t request) { records::requestQuery(t, request, query, name); });
}

const void* requestBuffer(ThreadState& t, GLuint buffer, uint64_t offset, uint64_t sizeBytes, const char* by) {
    void* into = sizeBytes ? secondScratch(t, sizeBytes) : nullptr;
    if (!into) return nullptr;
    return requestReply(t, by, into, sizeBytes,
                        [&](uint32_t request) { records::requestBuffer(t, request, buffer, offset, sizeBytes); })
               ? into
               : nullptr;
}

const void* requestProgram(ThreadState& t, GLuint program, uint64_t& sizeBytes, const char* by) {
    void* into = nullptr;
    const auto memoryFor = [&](uint64_t replyBytes) {
        sizeBytes = replyBytes;
        return into = replyBytes ? secondScratch(t, replyBytes) : nullptr;
    };
    return requestReply(t, by, memoryFor, [&](uint32_t request) { records::requestProgram(t, request, program); })
               ? into
               : nullptr;
}

bool requestFinish(ThreadState& t, const char* by) {
    uint64_t nothing = 0;
    if (t.context) stashError(*t.context, driverError());
    const GLenum before = t.context ? t.context->stashedError : GL_NO_ERROR;
    const bool finished =
        requestReply(t, by, &nothing, sizeof nothing, [&](uint32_t request) { records::requestFinish(t, request); });
    if (!finished && t.context) t.context->stashedError = before; // the request has no result that could be wrong
    return finished;
}

} // namespace mural
