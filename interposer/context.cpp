#include "interposer/context.hpp"

#include <cstdlib>
#include <cstring>
#include <linux/membarrier.h>
#include <new>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "encoders.hpp"
#include "interposer/default_samples.hpp"
#include "interposer/drawn_elsewhere.hpp"
#include "interposer/draw_opcodes.hpp"
#include "interposer/known_objects.hpp"
#include "interposer/log.hpp"
#include "interposer/news.hpp"
#include "interposer/own_records.hpp"
#include "interposer/real_gl.hpp"
#include "interposer/session.hpp"
#include "interposer/texture_from.hpp"
#include "interposer/verify.hpp"
#include "interposer/window_size.hpp"
#include "interposer/windows/gone_windows.hpp"
#include "interposer/windows/introduction.hpp"
#include "streamcodec/context_flags.hpp"

namespace mural {

namespace {

Lock announceLock; // taken before the tables' own

// After this, every other thread either sees its limit gone at its next record, or had begun that
// record before: so what it has completed may be published for it.
void stopFastPath(ThreadState& other) {
    other.shared = true;
    __atomic_store_n(&other.limit, nullptr, __ATOMIC_SEQ_CST);
}

void registerBarrier() {
    static bool once = false;
    if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
        syscall(SYS_membarrier, MEMBARRIER_CMD_REGISTER_PRIVATE_EXPEDITED, 0, 0);
}

// The thread gives up its context: what it encoded is made visible first.
void leaveContext(ThreadState& t) {
    Context* old = t.context;
    if (!old) return;
    Session* s = Session::current();
    Guard guard(old->group->lock);
    if (s && s->alive()) s->publish(t, false);
    --old->group->threads;
    if (old->group->lastWriter == &t) old->group->lastWriter = nullptr;
    t.shared = false;
    t.context = nullptr;
    if (old->destroyed) known::hold(*old, nullptr, nullptr);
}

// Threads of one share group order all their records from the moment that there are two of them.
void enterGroup(ThreadState& t, Context& c) {
    ShareGroup& group = *c.group;
    Guard guard(group.lock);
    ++group.threads;
    t.context = &c;
    t.shared = group.threads > 1;
    if (!t.shared) return;
    registerBarrier();
    for (ThreadState* other = firstThread(); other; other = other->next) {
        if (other != &t && other->context && other->context->group == &group) stopFastPath(*other);
    }
    syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED, 0, 0);
    Session* s = Session::current();
    for (ThreadState* other = firstThread(); s && other; other = other->next) {
        if (other != &t && other->context && other->context->group == &group) s->publish(*other, false);
    }
}

void announce(ThreadState& t, Context& c) {
    if (c.announced) return;
    Guard guard(announceLock); // two threads must not both be the first of a group
    const Context* sharer = known::sharerOf(c);
    const records::ContextInfo info{c.id, sharer ? sharer->id : 0, static_cast<uint32_t>(c.api),
                                    static_cast<uint32_t>(c.version / 10), static_cast<uint32_t>(c.version % 10),
                                    c.profileMask, c.flags | (c.losesOnReset ? wire::kLosesOnReset : 0) | (c.keepsUnflushed ? wire::kKeepsUnflushed : 0), c.config};
    records::createContext(t, info);
    c.announced = true;
}

// EGL's configurations do not tell how many buffers a drawable has, and drivers differ. A framebuffer object would hide
// the drawable's own.
void learnBuffers(const Context& c, Window& w) {
    if (w.announced || c.api != wire::Api::Desktop) return;
    GLint framebuffer = 0;
    GLboolean two = w.config.doubleBuffer;
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer == 0) gReal.glGetBooleanv(GL_DOUBLEBUFFER, &two);
    w.config.doubleBuffer = two != 0;
}

// The buffer that is read from: Mesa has one for each drawable, others one for each context, as the nodes do. So they are
// told when the context reads from another drawable.
void tellReadBuffer(ThreadState& t, const Context& c, const Window& read, uint32_t before) {
    if (!read.config.doubleBuffer || c.api != wire::Api::Desktop || c.compilingList) return;
    GLint framebuffer = 0, buffer = 0;
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(c.version >= 30 ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer != 0) return;
    gReal.glGetIntegerv(GL_READ_BUFFER, &buffer);
    const GLint assumed = before || !c.config.doubleBuffer ? GL_NONE : GL_BACK; // by the nodes
    if (buffer != assumed) encode_glReadBuffer(t, static_cast<GLenum>(buffer));
}

void announce(ThreadState& t, Window& w) {
    if (w.announced) return;
    w.announced = true;
    records::window(t, w.id, w.config);
}

// Core contexts have no indices in the program's memory, but Mesa takes them. Programs that are loaded high
// have no memory below 4 GiB, so that their offsets are known without a question.
uintptr_t lowestIndices(const Context& c) {
    if (!c.core) return 0;
    if (!c.isMesa) return UINTPTR_MAX;
    constexpr uintptr_t kHigh = uintptr_t{1} << 32, kFirstPage = 4096;
    return getauxval(AT_PHDR) >= kHigh ? kHigh : kFirstPage;
}

// OpenGL ES 3.0 §2.15.2: a draw that overruns the buffers is an error; not any more with geometry or tessellation shaders.
bool feedbackCounts(const Context& c) {
    if (c.api != wire::Api::Es2 || (c.version != 30 && c.version != 31)) return false;
    const auto* extensions = reinterpret_cast<const char*>(gReal.glGetString(GL_EXTENSIONS));
    return extensions && !std::strstr(extensions, "_geometry_shader") && !std::strstr(extensions, "_tessellation_shader");
}

// Version and profile that the driver really gave; needs the context to be current.
void learnVersion(Context& c) {
    const auto* text = reinterpret_cast<const char*>(gReal.glGetString(GL_VERSION));
    if (!text) return;
    c.isMesa = std::strstr(text, "Mesa");
    if (const char* es = std::strstr(text, "OpenGL ES")) {
        const char* digits = std::strpbrk(es, "0123456789");
        c.api = digits && *digits == '1' ? wire::Api::Es1 : wire::Api::Es2;
        text = digits ? digits : "2.0";
    }
    // Mesa gives its buffers a size at the first binding and after a swap only: where the loader tells it of resizes, as
    // those of GLX and EGL on X11 do, glViewport changes nothing.
    c.sizeAtViewport = !c.isMesa;
    c.version = (text[0] - '0') * 10 + (text[1] == '.' ? text[2] - '0' : 0);
    if (c.api == wire::Api::Desktop && c.version >= 32) {
        GLint mask = 0;
        gReal.glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &mask);
        c.profileMask = static_cast<uint32_t>(mask);
        c.core = mask & GL_CONTEXT_CORE_PROFILE_BIT;
        GLint flags = 0;
        gReal.glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
        c.flags = static_cast<uint32_t>(flags);
    }
    c.indicesInMemoryFrom = lowestIndices(c);
    c.feedbackCounts = feedbackCounts(c);
}

} // namespace

namespace {

// Tells the nodes what the program has given up; a thread without a context leaves it to the next that has one.
void freeDestroyed(ThreadState& t) {
    if (!t.context) return;
    while (const uint32_t id = known::nextDueContext()) records::destroyContext(t, id);
    while (const uint32_t id = known::nextDueWindow()) records::destroyWindow(t, id);
}

} // namespace

void refreshDrawLocally(ThreadState& t) {
    t.drawLocally = swapLocally() || !t.context || t.context->compilingList || t.context->drawsPixmap || t.context->renderMode != GL_RENDER || t.context->drawsFeedback;
    t.vertexLocally = t.drawLocally || !t.context->compatible();
}

PrimitivePause::PrimitivePause(const ThreadState& t) : mode_(t.context && !t.drawLocally ? t.context->openPrimitive : kNoPrimitive) {
    if (mode_ != kNoPrimitive) gReal.glEnd();
}

PrimitivePause::~PrimitivePause() {
    if (mode_ != kNoPrimitive) gReal.glBegin(mode_);
}

uint32_t announcedSharer(const Context& c) {
    if (known::nodesHave(c)) return c.id;
    const Context* sharer = known::sharerOf(c);
    return sharer ? sharer->id : 0;
}

namespace {

void end(Context& c) {
    if (!known::isCurrent(c)) known::hold(c, nullptr, nullptr);
    c.destroyed = true;
    c.freeDue = c.announced;
}

void end(Window& w) {
    releaseDrawn(w);
    w.freeDue = w.freeDue || w.announced;
    w.drawable = 0; // never found again; its number is not used again
}

} // namespace

void destroyContext(void* native) {
    Context* c = findContext(native);
    if (!c) return;
    end(*c);
    freeDestroyed(*tThread);
}

void destroyWindow(uintptr_t drawable, void* display) {
    Window* w = findWindow(drawable, display);
    if (!w) return;
    end(*w);
    freeDestroyed(*tThread);
}

void displayEnds(void* display, bool isEgl) {
    for (Window* w = nextWindow(nullptr); w; w = nextWindow(w))
        if (w->drawable && w->display == display && w->isEgl == isEgl) end(*w);
    while (Context* c = known::contextOf(display)) end(*c);
    freeDestroyed(*tThread);
}

void nativeWindowEnds(uint64_t server, uint64_t native) {
    if (known::nativeEnds(server, native)) freeDestroyed(*tThread);
}

void nativeWindowsEnd(uint64_t server, uint64_t firstNative, uint64_t mask) {
    bool any = false;
    for (Window* w = nextWindow(nullptr); w; w = nextWindow(w))
        if (w->native && w->server == server && (w->native & ~mask) == firstNative) any = known::nativeEnds(server, w->native) || any;
    if (any) freeDestroyed(*tThread);
}

void threadLeaves(ThreadState& t) {
    if (!t.context) return;
    records::makeCurrent(t, 0, 0, 0);
    leaveContext(t);
}

void becameCurrent(Context* context, Window* draw, Window* read) {
    ThreadState& t = ownThreadState();
    Session* s = Session::get();
    if (!s) {
        t.context = nullptr;
        t.drawLocally = true;
        return;
    }
    noteCalls(t);
    leavesDrawn(t);
    if (t.context && (t.context != context)) {
        records::makeCurrent(t, 0, 0, 0);
        leaveContext(t);
    }
    if (!context) {
        refreshDrawLocally(t);
        return;
    }
    const bool entered = !t.context;
    if (entered) enterGroup(t, *context);
    t.limit = nullptr; // the first record takes the slow path, which finds or takes a chunk
    if (context->firstCurrent) {
        context->firstCurrent = false;
        loadOwnNeeds();
        learnVersion(*context);
    }
    context->drawsPixmap = draw && draw->isPixmap;
    const uint32_t drawWindow = draw ? draw->id : 0, readWindow = read ? read->id : 0;
    const bool bound = entered || context->drawWindow != drawWindow || context->readWindow != readWindow;
    refreshDrawLocally(t);
    announce(t, *context);
    known::hold(*context, draw, read);
    const bool readIsNew = read && !read->announced;
    for (Window* w : {draw, read}) {
        if (!w) continue;
        if (w->nativeGone) lookForGone(*w);
        introduceWindow(*w);
        if (!w->sizeKnown) updateWindowSize(t, *w);
        if (w == draw) learnBuffers(*context, *w);
        announce(t, *w);
    }
    t.drawingAwaited = context->hasDefaultSamples;
    const uint32_t readBefore = context->readWindow;
    const bool readsOther = read && (readIsNew || read->id != readBefore);
    context->drawWindow = drawWindow;
    context->readWindow = readWindow;
    records::makeCurrent(t, context->id, context->drawWindow, context->readWindow);
    if (readsOther) tellReadBuffer(t, *context, *read, readBefore);
    freeDestroyed(t);
    refreshBoundTextures(t);
    s->publish(t, false);
    watchFromHere(t);
    if (bound && draw) localPixelsBound(t, *draw);
}

void updateWindowSize(ThreadState& t, Window& w) {
    uint32_t width = 0, height = 0;
    w.sizeKnown = true;
    if (!askWindowSize(w, width, height) || (width == w.config.width && height == w.config.height)) return;
    w.config.width = width;
    w.config.height = height;
    w.pixels.known = false;
    if (w.announced) records::window(t, w.id, w.config);
}

void beforeAwaitedDrawing(ThreadState& t, uint32_t opcode) {
    if (!drawsIntoWindow(opcode)) return;
    t.drawingAwaited = t.context && t.context->hasDefaultSamples;
    if (t.drawingAwaited) fitDefaultSamples(t);
    Window* w = t.context ? findWindowById(t.context->drawWindow) : nullptr;
    if (w && !w->sizeKnown) updateWindowSize(t, *w);
}

namespace {

bool drawsToFront() {
    GLint framebuffer = 0, buffer = 0;
    gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer != 0) return true; // the window's draw buffer can't be asked for now
    gReal.glGetIntegerv(GL_DRAW_BUFFER, &buffer);
    return buffer != GL_BACK && buffer != GL_BACK_LEFT && buffer != GL_NONE;
}

// A window with two buffers goes on with its back buffer as it is: nothing but a picture of what is seen.
void showFront(ThreadState& t, Window& w) {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    t.context->frontDue = drawsToFront();
    records::frontPicture(t, w.id, s->nextFrame());
    s->publish(t, false);
    s->waitForCredit();
    refreshDrawLocally(t);
}

} // namespace

void flushedWindow(ThreadState& t) {
    if (!t.context) return;
    Window* w = findWindowById(t.context->drawWindow);
    // EGL shows a surface with one buffer when it is swapped.
    if (!w || t.cursor == w->lastFlush || !(w->config.doubleBuffer ? t.context->frontDue : !w->isEgl)) return;
    if (w->config.doubleBuffer) showFront(t, *w);
    else endFrame(w);
    w->lastFlush = t.cursor;
}

bool swapLocally() {
    Session* s = Session::current();
    // A verified run needs the program's own picture to compare with.
    return !s || !s->alive() || s->welcome().policy == capture::kPolicyFull || s->welcome().verifyEvery > 0;
}

bool swapsItself(Window* w) {
    if (!w || w->nativeGone) return true; // the driver knows it, or reports the error
    if (w->drawnInPart) {
        w->drawnInPart = false; // the next picture is whole
        return false;
    }
    return swapLocally() || w->isPixmap;
}

namespace {

// Drivers gather what a list draws even where it is discarded (llvmpipe up to 36 MiB), and nobody swaps to end that.
void flushLists(Context& c) {
    constexpr uint32_t kMostLists = 32; // some 60 KiB each
    if (c.listsUnflushed < kMostLists || swapLocally() || c.frontDue) return; // a flush would show what is in front
    c.listsUnflushed = 0;
    gReal.glFlush();
}

} // namespace

void endFrame(Window* w) {
    ThreadState& t = *tThread;
    Session* s = Session::current();
    if (s && windowsAsked()) takeGoneWindows();
    if (!s || !s->alive() || !w || w->nativeGone || !t.context) {
        refreshDrawLocally(t);
        return;
    }
    if (drawnElsewhere(t, *w)) {
        s->die(nullptr);
        refreshDrawLocally(t);
        return;
    }
    beforeDraw(t, *t.context);
    const uint32_t frame = s->nextFrame();
    const uint32_t every = s->welcome().verifyEvery;
    if (every && frame % every == 0) verifyFrame(t, *w);
    records::swap(t, w->id, frame);
    ++t.context->swaps;
    flushLists(*t.context);
    s->publish(t, false, false); // waitForCredit wakes the head when it has to
    watchFromHere(t);
    s->waitForCredit();
    takeNews(t);
    w->sizeKnown = false;
    t.drawingAwaited = true;
    t.limit = nullptr;
    refreshDrawLocally(t);
    s->countFrameCpu(t);
}

} // namespace mural
