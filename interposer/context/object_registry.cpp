#include "interposer/context/object_registry.hpp"

#include <cstdlib>
#include <new>

#include "interposer/context/lock.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/context/thread_state.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

Lock tableLock; // guards all variables below
Context** contexts = nullptr;
uint32_t contextCount = 0;
Window* windows = nullptr;
uint32_t lastContext = 0, lastWindow = 0;

template <class T> T* make() {
    void* memory = std::calloc(1, sizeof(T));
    return memory ? new (memory) T : nullptr;
}

bool isCurrentAnywhere(const Context& c) {
    for (const ThreadState* t = firstThread(); t; t = t->next)
        if (t->context == &c) return true;
    return false;
}

// Returns whether the program and the nodes have both released it, so its memory can be reused.
bool mayBecomeAnother(const Context& c) {
    return c.destroyed && !c.freeDue && !c.retained[0] && !c.retained[1] && !isCurrentAnywhere(c);
}
bool mayBecomeAnother(const Window& w) { return w.drawable == 0 && !w.freeDue && w.holders <= 0 && !w.boundGroup; }

bool isUsed(const ShareGroup* group) {
    for (uint32_t i = 0; i < contextCount; ++i)
        if (contexts[i]->group == group) return true;
    for (const Window* w = windows; w; w = w->next)
        if (w->boundGroup == group) return true;
    return false;
}

void emptyOut(Context& c) {
    ShareGroup* const group = c.group;
    DebugListener* const debug = c.debug; // a late thread of the driver may still call it
    if (debug) forget(*debug);
    std::free(c.extensionText);
    std::free(c.extensionNames);
    c.~Context();
    new (&c) Context;
    c.debug = debug;
    if (!group || isUsed(group)) return;
    forgetMaps(*group);
    forgetReads(*group);
    group->~ShareGroup();
    std::free(group);
}

// Returns an empty entry of the table.
Context* emptyContext() {
    for (uint32_t i = 0; i < contextCount; ++i) {
        if (!mayBecomeAnother(*contexts[i])) continue;
        emptyOut(*contexts[i]);
        return contexts[i];
    }
    auto** larger = static_cast<Context**>(std::realloc(contexts, (contextCount + 1) * sizeof(Context*)));
    if (larger) contexts = larger;
    auto* c = larger ? make<Context>() : nullptr;
    if (c) contexts[contextCount++] = c;
    return c;
}

Window* emptyWindow() {
    for (Window* w = windows; w; w = w->next) {
        if (!mayBecomeAnother(*w)) continue;
        Window* const next = w->next;
        w->~Window();
        (new (w) Window)->next = next;
        return w;
    }
    auto* w = make<Window>();
    if (!w) return nullptr;
    w->next = windows;
    return windows = w;
}

bool isBare(const Window& w) { return !w.isEgl && w.drawable == w.native; }

// GLX destroys its drawable of a plain X window with the last context that holds it. bareWindow() creates it again. GLX
// windows, pbuffers and EGL surfaces have functions that destroy them.
void release(Window* w) {
    if (!w || --w->holders > 0 || !isBare(*w)) return;
    w->sizeKnown = false;
    if (w->nativeGone) w->drawable = 0;
}

Window* findLocked(uintptr_t drawable, void* display) {
    for (Window* w = windows; w; w = w->next) {
        if (w->drawable == drawable && (w->display == display || !display)) return w;
    }
    return nullptr;
}

// `config` comes from a context or a configuration, so it has neither a size nor an X window.
void setConfig(Window& w, const wire::WindowConfig& config) {
    const wire::WindowConfig before = w.config;
    w.config = config;
    w.config.width = before.width;
    w.config.height = before.height;
    w.config.nativeLow = static_cast<uint32_t>(w.native);
    w.config.nativeHigh = before.nativeHigh;
}

Window* addLocked(uintptr_t drawable, void* display, bool isEgl, const wire::WindowConfig& config, uint64_t native) {
    Window* w = emptyWindow();
    if (!w) return nullptr;
    w->id = ++lastWindow;
    w->drawable = drawable;
    w->display = display;
    w->isEgl = isEgl;
    w->native = native;
    setConfig(*w, config);
    return w;
}

// The driver has destroyed its drawable and creates another one. The window on the nodes is kept, because the wall
// shows the same one.
void renew(Window& w, const wire::WindowConfig& config) {
    setConfig(w, config);
    w.announced = false;
    w.sizeKnown = false;
    w.drawnInPart = false;
    w.lastFlush = nullptr;
    w.pixels.known = false;
}

} // namespace

namespace known {

// Returns any context of the group that the nodes have. It need not be the one that the program named. That context may
// not have been current yet, so its version is unknown. It is announced at its first use, and shares with this one
// then. Only the first context of a group has no sharer.
const Context* sharerOf(const Context& c) {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        if (contexts[i]->group == c.group && contexts[i] != &c && nodesHave(*contexts[i])) return contexts[i];
    }
    return nullptr;
}

bool isCurrent(const Context& c) { return isCurrentAnywhere(c); }

Context* contextOf(void* display) {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        if (contexts[i]->display == display && !contexts[i]->destroyed) return contexts[i];
    }
    return nullptr;
}

void retain(Context& c, Window* draw, Window* read) {
    Guard guard(tableLock);
    Window* const before[2] = {c.retained[0], c.retained[1]};
    c.retained[0] = draw;
    c.retained[1] = read;
    for (Window* w : {draw, read})
        if (w) ++w->holders;
    for (Window* w : before) release(w);
}

Context* idleContextOf(const Window& w) {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        Context* const c = contexts[i];
        if (!c->destroyed && c->announced && c->retained[0] == &w && (c->retained[1] == &w || !c->retained[1]) &&
            !isCurrent(*c))
            return c;
    }
    return nullptr;
}

namespace {

// Returns whether this is the group's last context on the nodes, while contexts that are not announced yet need its
// objects.
bool holdsObjects(const Context& c) {
    bool awaited = false;
    for (uint32_t i = 0; i < contextCount; ++i) {
        const Context& other = *contexts[i];
        if (&other == &c || other.group != c.group) continue;
        if (nodesHave(other)) return false;
        awaited = awaited || (!other.announced && !other.destroyed);
    }
    return awaited;
}

} // namespace

uint32_t nextDueContext() {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        if (contexts[i]->freeDue && !holdsObjects(*contexts[i])) {
            contexts[i]->freeDue = false;
            return contexts[i]->id;
        }
    }
    return 0;
}

// Limit for X windows without contexts: their end is not reported to GLX, and programs may bind them again.
constexpr int kIdleWindows = 16;

uint32_t nextDueWindow() {
    Guard guard(tableLock);
    Window* oldest = nullptr;
    int idle = 0;
    for (Window* w = windows; w; w = w->next) {
        if (w->freeDue) {
            w->freeDue = false;
            return w->id;
        }
        if (!w->announced || w->holders > 0 || !isBare(*w) || w->drawable == 0) continue;
        if (!oldest || w->id < oldest->id) oldest = w;
        ++idle;
    }
    if (idle <= kIdleWindows) return 0;
    oldest->announced = false; // announced again at its next binding
    return oldest->id;
}

Lock& tables() { return tableLock; }

void inherit() {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        Context& c = *contexts[i];
        if (!c.group) continue;
        c.group->inherited = c.group->inherited || c.announced || !c.firstCurrent;
        c.announced = c.freeDue = false;
        c.group->threads = c.group->unsettledThreads = 0;
        c.group->lastWriter = nullptr;
        c.group->mapsOwner.store(nullptr, std::memory_order_relaxed);
    }
    for (Window* w = windows; w; w = w->next) {
        w->inherited = w->inherited || w->announced;
        w->announced = w->freeDue = w->sizeKnown = false;
        w->lastFlush = nullptr;
        if (w->boundGroup && w->boundGroup->inherited) w->boundGroup = nullptr;
    }
}

// GLX and EGL drawables persist while contexts hold them, as in the driver.
bool nativeEnds(uint64_t server, uint64_t native) {
    bool any = false;
    Guard guard(tableLock);
    for (Window* w = windows; w; w = w->next) {
        if (native == 0 || w->native != native || w->server != server || w->config.isPbuffer || w->nativeGone) continue;
        any = true;
        w->freeDue = w->freeDue || w->announced;
        w->announced = false;
        w->nativeGone = true;
        if (isBare(*w) && w->holders <= 0) w->drawable = 0;
    }
    return any;
}

uint32_t drawablesOf(uint64_t server, uint64_t native, uint32_t* ids, uint32_t maximum) {
    uint32_t count = 0;
    Guard guard(tableLock);
    for (const Window* w = windows; w && count < maximum; w = w->next) {
        if (w->drawable && w->native == native && w->server == server) ids[count++] = w->id;
    }
    return count;
}

bool hasWindow(uint64_t native) {
    Guard guard(tableLock);
    for (const Window* w = windows; w; w = w->next)
        if (w->drawable && w->native == native && native != 0) return true;
    return false;
}

Window* bareWindow(uintptr_t drawable, void* display, const wire::WindowConfig& config) {
    Guard guard(tableLock);
    Window* w = findLocked(drawable, display);
    if (!w) return addLocked(drawable, display, false, config, drawable);
    if (w->holders <= 0 && isBare(*w)) renew(*w, config);
    return w;
}

} // namespace known

Context* addContext(void* native, void* display, Context* shareWith, wire::Api api, const wire::WindowConfig& config) {
    // Connects now: a sandbox that forbids connections may begin before the context is made current.
    if (!shareWith || !shareWith->group->inherited) Session::get();
    Guard guard(tableLock);
    Context* c = emptyContext();
    if (!c) return nullptr;
    c->native = native;
    c->display = display;
    c->api = api;
    c->config = config;
    c->id = ++lastContext;
    c->group = shareWith ? shareWith->group : make<ShareGroup>();
    c->destroyed = !c->group; // excludes it from lookups
    return c->group ? c : nullptr;
}

Context* findContext(void* native) {
    Guard guard(tableLock);
    for (uint32_t i = contextCount; i-- > 0;) {
        if (contexts[i]->native == native && !contexts[i]->destroyed) return contexts[i];
    }
    return nullptr;
}

Window* addWindow(uintptr_t drawable, void* display, bool isEgl, const wire::WindowConfig& config, uint64_t native) {
    Guard guard(tableLock);
    return addLocked(drawable, display, isEgl, config, native);
}

Window* findWindow(uintptr_t drawable, void* display) {
    Guard guard(tableLock);
    return findLocked(drawable, display);
}

Window* findWindowById(uint32_t id) {
    Guard guard(tableLock);
    for (Window* w = windows; w; w = w->next) {
        if (w->id == id) return w;
    }
    return nullptr;
}

Window* nextWindow(const Window* before) {
    Guard guard(tableLock);
    return before ? before->next : windows;
}

} // namespace mural
