#include "interposer/known_objects.hpp"

#include <cstdlib>
#include <new>

#include "interposer/lock.hpp"
#include "interposer/mapped_buffers.hpp"
#include "interposer/news.hpp"
#include "interposer/session.hpp"
#include "interposer/thread_state.hpp"

namespace mural {

namespace {

Lock tableLock; // of all that follows
Context** contexts = nullptr;
uint32_t contextCount = 0;
Window* windows = nullptr;
uint32_t lastContext = 0, lastWindow = 0;

template <class T> T* make() {
    void* memory = std::calloc(1, sizeof(T));
    return memory ? new (memory) T : nullptr;
}

bool isCurrent(const Context& c) {
    for (const ThreadState* t = firstThread(); t; t = t->next)
        if (t->context == &c) return true;
    return false;
}

// The program and the nodes have given it up.
bool mayBecomeAnother(const Context& c) { return c.destroyed && !c.freeDue && !c.held[0] && !c.held[1] && !isCurrent(c); }
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
    DebugListener* const debug = c.debug; // a driver's late thread may still call it
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

// In the table, with nothing in it.
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

// A drawable that no context holds any more is given up by GLX when it is a plain X window: it starts
// anew, with a new size, when it is bound again. GLX windows, pbuffers and EGL surfaces stay.
void release(Window* w) {
    if (!w || --w->holders > 0 || w->isEgl || w->drawable != w->native) return;
    w->sizeKnown = false;
}

} // namespace

namespace known {

// Any context of the group that the nodes have serves as the one to share with. It need not be the one
// that the program named: that may not have been current yet, so its version is not known; it is told
// when it is, and shares then with this one. Only with the first of a group is there none.
const Context* sharerOf(const Context& c) {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        if (contexts[i]->group == c.group && contexts[i] != &c && nodesHave(*contexts[i])) return contexts[i];
    }
    return nullptr;
}

void hold(Context& c, Window* draw, Window* read) {
    Guard guard(tableLock);
    Window* const before[2] = {c.held[0], c.held[1]};
    c.held[0] = draw;
    c.held[1] = read;
    for (Window* w : {draw, read})
        if (w) ++w->holders;
    for (Window* w : before) release(w);
}

Context* idleHolderOf(const Window& w) {
    Guard guard(tableLock);
    for (uint32_t i = 0; i < contextCount; ++i) {
        Context* const c = contexts[i];
        if (!c->destroyed && c->announced && c->held[0] == &w && (c->held[1] == &w || !c->held[1]) && !isCurrent(*c)) return c;
    }
    return nullptr;
}

namespace {

// The last of a group that the nodes have holds the objects for those that they have not been told of yet.
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

// X windows go without a word to GLX. Some that no context holds are kept: programs go to and fro.
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
        if (!w->announced || w->holders > 0 || w->isEgl || w->drawable != w->native || w->drawable == 0) continue;
        if (!oldest || w->id < oldest->id) oldest = w;
        ++idle;
    }
    if (idle <= kIdleWindows) return 0;
    oldest->announced = false; // told anew when it is bound again
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
        c.group->mapsHolder.store(nullptr, std::memory_order_relaxed);
    }
    for (Window* w = windows; w; w = w->next) {
        w->inherited = w->inherited || w->announced;
        w->announced = w->freeDue = w->sizeKnown = false;
        w->lastFlush = nullptr;
        if (w->boundGroup && w->boundGroup->inherited) w->boundGroup = nullptr;
    }
}

bool nativeEnds(uint64_t native) {
    bool any = false;
    Guard guard(tableLock);
    for (Window* w = windows; w; w = w->next) {
        if (native == 0 || w->native != native || w->config.isPbuffer) continue;
        any = true;
        w->freeDue = w->freeDue || w->announced;
        w->announced = false; // GLX windows and surfaces on it may still be bound
        if (w->drawable == w->native) w->drawable = 0;
    }
    return any;
}

} // namespace known

Context* addContext(void* native, Context* shareWith, wire::Api api, const wire::WindowConfig& config) {
    // A sandbox may begin before the context is made current, and forbid to connect.
    if (!shareWith || !shareWith->group->inherited) Session::get();
    Guard guard(tableLock);
    Context* c = emptyContext();
    if (!c) return nullptr;
    c->native = native;
    c->api = api;
    c->config = config;
    c->id = ++lastContext;
    c->group = shareWith ? shareWith->group : make<ShareGroup>();
    c->destroyed = !c->group; // then it is never found
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
    Window* w = emptyWindow();
    if (!w) return nullptr;
    w->id = ++lastWindow;
    w->drawable = drawable;
    w->display = display;
    w->isEgl = isEgl;
    w->native = native;
    w->config = config;
    w->config.nativeLow = static_cast<uint32_t>(native);
    w->config.nativeHigh = static_cast<uint32_t>(native >> 32);
    return w;
}

Window* findWindow(uintptr_t drawable, void* display) {
    Guard guard(tableLock);
    for (Window* w = windows; w; w = w->next) {
        if (w->drawable == drawable && (w->display == display || !display)) return w;
    }
    return nullptr;
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
