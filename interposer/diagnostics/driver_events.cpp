#include "interposer/diagnostics/driver_events.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/context/thread_state.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

// Filters messages that the program has already received from its own driver. The nodes' drivers replay the same calls
// and report the same messages. The n-th message from the nodes is new only if the local driver has reported fewer than
// n.
struct DebugListener {
    struct Delivered {
        uint64_t hash;
        uint32_t local, nodes;
    };
    static constexpr uint32_t kMessages = 256; // limit of remembered messages; replaces the oldest
    Lock lock;                                 // drivers call back from their own threads
    GLDEBUGPROC callback = nullptr;
    const void* user = nullptr;
    Delivered delivered[kMessages] = {};
    uint32_t next = 0;

    Delivered& find(uint64_t hash) {
        for (Delivered& t : delivered) {
            if (t.hash == hash) return t;
        }
        Delivered& t = delivered[next++ % kMessages];
        t = {hash, 0, 0};
        return t;
    }
};

namespace {

struct Waiting {
    wire::DriverEvent event;
    Waiting* next;
    char text[capture::kDriverEventTextBytes + 1];
};
constexpr int kMaxWaiting = 64; // limit for threads that take no events; drops the oldest
Lock driverEventLock;
Waiting* waiting = nullptr; // oldest first
int waitingCount = 0;

// Excludes message numbers, because they differ between processes.
uint64_t hashOf(GLenum source, GLenum type, GLenum severity, const char* text, size_t length) {
    uint64_t hash = 1469598103934665603u;
    const auto add = [&](uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
    add(source);
    add(type);
    add(severity);
    for (size_t i = 0; i < length; ++i) add(static_cast<unsigned char>(text[i]));
    return hash | 1; // 0 marks an empty entry
}

void APIENTRY onLocalMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* text,
                             const void* user) {
    auto& listener = *static_cast<DebugListener*>(const_cast<void*>(user));
    GLDEBUGPROC callback = nullptr;
    const void* with = nullptr;
    {
        Guard guard(listener.lock);
        const size_t bytes = !text ? 0 : length < 0 ? std::strlen(text) : static_cast<size_t>(length);
        ++listener
              .find(hashOf(source, type, severity, text,
                           bytes < capture::kDriverEventTextBytes ? bytes : capture::kDriverEventTextBytes))
              .local;
        callback = listener.callback;
        with = listener.user;
    }
    if (callback) callback(source, type, id, severity, length, text, with);
}

void deliverMessage(Context& c, const wire::DriverEvent& n, const char* text) {
    GLDEBUGPROC callback = nullptr;
    const void* user = nullptr;
    if (c.debug) {
        Guard guard(c.debug->lock);
        DebugListener::Delivered& delivered = c.debug->find(hashOf(n.source, n.type, n.severity, text, n.textBytes));
        if (++delivered.nodes <= delivered.local) return;
        callback = c.debug->callback;
        user = c.debug->user;
    }
    if (callback) return callback(n.source, n.type, n.id, n.severity, static_cast<GLsizei>(n.textBytes), text, user);
    // The driver's own log already contains errors and compiler messages.
    if (n.type == GL_DEBUG_TYPE_ERROR || n.source == GL_DEBUG_SOURCE_SHADER_COMPILER || !gReal.glDebugMessageInsert)
        return;
    gReal.glDebugMessageInsert(GL_DEBUG_SOURCE_THIRD_PARTY, n.type, n.id, n.severity, static_cast<GLsizei>(n.textBytes),
                               text);
}

// GL keeps the first error until a query. The local driver executed the same call, and may have run out of memory or
// raised an error before. An error that the program has received since, or that is still pending, stands for both.
void deliverOutOfMemory(Context& c, const wire::DriverEvent& n) {
    if (n.type != c.errorsReported) return;
    stashError(c, driverError());
    if (!c.stashedError) c.outOfMemoryDue = true;
}

void reportLost(Context& c, const wire::DriverEvent& n) {
    if (c.losesOnReset) {
        c.resetStatus = n.type;
        stashError(c, GL_CONTEXT_LOST);
        return;
    }
    static bool once = false;
    if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
        say("a node's graphics driver was reset, and this program did not enable reset notification: its pictures are "
            "incomplete from now on; restart it");
}

void deliver(Context& c, const Waiting& w) {
    switch (static_cast<wire::DriverEventKind>(w.event.kind)) {
    case wire::DriverEventKind::DebugMessage: return deliverMessage(c, w.event, w.text);
    case wire::DriverEventKind::OutOfMemory: return deliverOutOfMemory(c, w.event);
    case wire::DriverEventKind::ContextLost: return reportLost(c, w.event);
    }
}

void dropOldest() {
    Waiting* oldest = waiting;
    waiting = oldest->next;
    --waitingCount;
    std::free(oldest);
}

void collect(Session& s) {
    Waiting** end = &waiting;
    while (*end) end = &(*end)->next;
    while (s.hasDriverEvents()) {
        auto* w = static_cast<Waiting*>(std::malloc(sizeof(Waiting)));
        if (!w) return;
        w->next = nullptr;
        if (!s.takeDriverEvents(w->event, w->text)) return std::free(w);
        *end = w;
        end = &w->next;
        if (++waitingCount > kMaxWaiting) {
            if (end == &waiting->next) end = &waiting;
            dropOldest();
        }
    }
}

Waiting* takeFor(uint32_t context) {
    for (Waiting** at = &waiting; *at; at = &(*at)->next) {
        Waiting* w = *at;
        if (w->event.context != context) continue;
        *at = w->next;
        --waitingCount;
        return w;
    }
    return nullptr;
}

} // namespace

void deliverDriverEvents(ThreadState& t) {
    Session* s = Session::current();
    Context* c = t.context;
    if (!c) return;
    {
        Guard guard(driverEventLock);
        collect(*s);
    }
    for (;;) {
        Waiting* w = nullptr;
        {
            Guard guard(driverEventLock);
            w = takeFor(c->id);
        }
        if (!w) return;
        deliver(*c, *w);
        std::free(w);
    }
}

void forgetDriverEvents() {
    Guard guard(driverEventLock);
    waiting = nullptr; // not freed, because a thread of the parent may have been changing the list
    waitingCount = 0;
}

void listen(Context& c, GLDEBUGPROC callback, const void* user) {
    if (!c.debug) {
        void* memory = callback ? std::calloc(1, sizeof(DebugListener)) : nullptr;
        if (memory) c.debug = new (memory) DebugListener;
    }
    if (!c.debug) return gReal.glDebugMessageCallback(reinterpret_cast<void*>(callback), user);
    {
        Guard guard(c.debug->lock);
        c.debug->callback = callback;
        c.debug->user = user;
    }
    gReal.glDebugMessageCallback(callback ? reinterpret_cast<void*>(&onLocalMessage) : nullptr,
                                 callback ? c.debug : nullptr);
}

void forget(DebugListener& listener) {
    Guard guard(listener.lock);
    listener.callback = nullptr;
    listener.user = nullptr;
    for (DebugListener::Delivered& delivered : listener.delivered) delivered = {};
}

GLDEBUGPROC listener(const Context& c) { return c.debug ? c.debug->callback : nullptr; }
const void* listenersUser(const Context& c) { return c.debug ? c.debug->user : nullptr; }

} // namespace mural
