#include "interposer/context/context.hpp"

#include <cstdlib>
#include <cstring>
#include <new>
#include <sys/auxv.h>

#include "encoders.hpp"
#include "interposer/context/default_samples.hpp"
#include "interposer/diagnostics/bypass_detector.hpp"
#include "interposer/encode/draw_opcodes.hpp"
#include "interposer/process/forked_child.hpp"
#include "interposer/encode/group_order.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "interposer/readback/drawable_textures.hpp"
#include "interposer/diagnostics/verify.hpp"
#include "interposer/context/window_size.hpp"
#include "interposer/x11/gone_windows.hpp"
#include "interposer/x11/introduction.hpp"
#include "interposer/x11/own_puts.hpp"
#include "streamcodec/wire/context_flags.hpp"
#include "streamcodec/wire/record.hpp"

namespace mural {

namespace {

Lock announceLock; // locked before the tables' own lock

// Releases the thread's context. Publishes the thread's records first.
void leaveContext(ThreadState& t) {
    Context* old = t.context;
    if (!old) return;
    Guard guard(old->group->lock);
    group_order::leave(t, Session::current());
    if (old->destroyed) known::retain(*old, nullptr, nullptr);
}

void announce(ThreadState& t, Context& c) {
    if (c.announced) return;
    Guard guard(announceLock); // two threads must not both be the first of a group
    const Context* sharer = known::sharerOf(c);
    const records::ContextInfo info{c.id,
                                    sharer ? sharer->id : 0,
                                    static_cast<uint32_t>(c.api),
                                    static_cast<uint32_t>(c.version / 10),
                                    static_cast<uint32_t>(c.version % 10),
                                    c.profileMask,
                                    c.flags | (c.losesOnReset ? wire::kLosesOnReset : 0) |
                                        (c.keepsUnflushed ? wire::kKeepsUnflushed : 0),
                                    c.config};
    records::createContext(t, info);
    c.announced = true;
}

// EGL's configurations do not report how many buffers a drawable has, and drivers differ. A bound framebuffer object
// would hide the drawable's own buffers.
void readBufferFormats(const Context& c, Window& w) {
    if (w.announced || c.api != wire::Api::Desktop) return;
    GLint framebuffer = 0;
    GLboolean two = w.config.doubleBuffer;
    if (gReal.glBindFramebuffer) gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer == 0) gReal.glGetBooleanv(GL_DOUBLEBUFFER, &two);
    w.config.doubleBuffer = two != 0;
}

// Mesa stores the read buffer per drawable. Other drivers and the nodes store it per context. The nodes therefore
// receive it when the context reads from another drawable.
void sendReadBuffer(ThreadState& t, const Context& c, const Window& read, uint32_t before) {
    if (!read.config.doubleBuffer || c.api != wire::Api::Desktop || c.compilingList) return;
    GLint framebuffer = 0, buffer = 0;
    if (gReal.glBindFramebuffer)
        gReal.glGetIntegerv(c.version >= 30 ? GL_READ_FRAMEBUFFER_BINDING : GL_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer != 0) return;
    gReal.glGetIntegerv(GL_READ_BUFFER, &buffer);
    const GLint assumed = before || !c.config.doubleBuffer ? GL_NONE : GL_BACK; // the nodes' state
    if (buffer != assumed) encode_glReadBuffer(t, static_cast<GLenum>(buffer));
}

void announce(ThreadState& t, Window& w) {
    if (w.announced) return;
    w.announced = true;
    records::window(t, w.id, w.config);
}

// Core contexts have no indices in client memory, but Mesa accepts them. Programs that are loaded above 4 GiB have no
// memory below, so smaller values are certainly offsets.
uintptr_t lowestIndices(const Context& c) {
    if (!c.core) return 0;
    if (!c.isMesa) return UINTPTR_MAX;
    constexpr uintptr_t kHigh = uintptr_t{1} << 32, kFirstPage = 4096;
    return getauxval(AT_PHDR) >= kHigh ? kHigh : kFirstPage;
}

// OpenGL ES 3.0 §2.15.2: a draw that overruns the buffers is an error. Geometry or tessellation shaders lift this rule.
bool feedbackCounts(const Context& c) {
    if (c.api != wire::Api::Es2 || (c.version != 30 && c.version != 31)) return false;
    const auto* extensions = reinterpret_cast<const char*>(gReal.glGetString(GL_EXTENSIONS));
    return extensions && !std::strstr(extensions, "_geometry_shader") &&
           !std::strstr(extensions, "_tessellation_shader");
}

// True for Mesa's software drivers: their GLX swaps only in threads with a current context, no matter which
// (drisw_swap_buffers).
bool swapsNeedContext = false;

// Queries the actual version and profile from the driver. Requires that the context is current.
void readVersion(Context& c) {
    const auto* text = reinterpret_cast<const char*>(gReal.glGetString(GL_VERSION));
    if (!text) return;
    c.isMesa = std::strstr(text, "Mesa");
    const auto* renderer = reinterpret_cast<const char*>(gReal.glGetString(GL_RENDERER));
    for (const char* software : {"llvmpipe", "softpipe", "swrast"})
        if (renderer && std::strstr(renderer, software)) __atomic_store_n(&swapsNeedContext, true, __ATOMIC_RELAXED);
    if (const char* es = std::strstr(text, "OpenGL ES")) {
        const char* digits = std::strpbrk(es, "0123456789");
        c.api = digits && *digits == '1' ? wire::Api::Es1 : wire::Api::Es2;
        text = digits ? digits : "2.0";
    }
    // Mesa sizes its buffers only at the first binding and after a swap. If the loader reports resizes, as GLX and EGL
    // on X11 do, glViewport changes nothing.
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

// Sends the nodes the destruction of objects that the program has destroyed. A thread without a context leaves this to
// the next thread with one.
void freeDestroyed(ThreadState& t) {
    if (!t.context) return;
    while (const uint32_t id = known::nextDueContext()) records::destroyContext(t, id);
    while (const uint32_t id = known::nextDueWindow()) records::destroyWindow(t, id);
}

} // namespace

void refreshDrawLocally(ThreadState& t) {
    t.drawLocally = swapLocally() || !t.context || t.context->compilingList || t.context->drawsPixmap ||
                    t.context->renderMode != GL_RENDER || t.context->drawsFeedback;
    t.vertexLocally = t.drawLocally || !t.context->compatible();
}

PrimitivePause::PrimitivePause(const ThreadState& t)
    : mode_(t.context && !t.drawLocally ? t.context->openPrimitive : kNoPrimitive) {
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
    if (!known::isCurrent(c)) known::retain(c, nullptr, nullptr);
    c.destroyed = true;
    c.freeDue = c.announced;
}

void end(Window& w) {
    releaseDrawn(w);
    w.freeDue = w.freeDue || w.announced;
    w.drawable = 0; // excludes it from lookups; its number is not reused
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
        if (w->native && w->server == server && (w->native & ~mask) == firstNative)
            any = known::nativeEnds(server, w->native) || any;
    if (any) freeDestroyed(*tThread);
}

void threadLeaves(ThreadState& t) {
    if (!t.context) return;
    records::makeCurrent(t, 0, 0, 0);
    leaveContext(t);
}

namespace {

// Identifies one use of a chunk by one thread.
uint64_t chunkUse(const ThreadState& t) { return uint64_t{t.stream} << 32 | t.chunksTaken; }

void noteFlush(const ThreadState& t, Window& w) {
    w.lastFlush = t.cursor;
    w.lastFlushChunk = chunkUse(t);
}

// Returns whether the thread has drawn since the window was shown by a flush. Records of earlier chunks count as draws.
bool drewSinceFlush(const ThreadState& t, const Window& w) {
    if (!w.lastFlush || w.lastFlushChunk != chunkUse(t)) return true;
    for (const std::byte* p = w.lastFlush; p < t.cursor;) {
        const record::Header header = record::readHeader(p, static_cast<size_t>(t.cursor - p));
        if (!header || drawsIntoWindow(header.opcode)) return true;
        p += header.sizeBytes;
    }
    return false;
}

// Returns whether the driver keeps a front buffer separate from the X window's content. That buffer is black until the
// program draws into it. Mesa's software drivers keep one.
bool hasOwnFront() {
    const auto* renderer = reinterpret_cast<const char*>(gReal.glGetString(GL_RENDERER));
    return renderer && (std::strncmp(renderer, "llvmpipe", 8) == 0 || std::strncmp(renderer, "softpipe", 8) == 0);
}

void readFrontBuffer(Window& w) {
    if (!w.announced && w.config.doubleBuffer && hasOwnFront()) w.config.doubleBuffer = wire::kOwnFront;
}

} // namespace

void becameCurrent(Context* context, Window* draw, Window* read) {
    ThreadState& t = ownThreadState();
    if (context && context->group->inherited) {
        inheritedUsed(draw);
        context = nullptr;
    }
    Session* s = context ? Session::get() : Session::current();
    if (!s) {
        t.context = nullptr;
        t.drawLocally = t.vertexLocally = true;
        return;
    }
    recordCalls(t);
    beforeDrawableSwitch(t);
    if (t.context && (t.context != context)) {
        records::makeCurrent(t, 0, 0, 0);
        leaveContext(t);
    }
    if (!context) {
        refreshDrawLocally(t);
        return;
    }
    const bool entered = !t.context;
    if (entered) group_order::enter(t, *context);
    t.limit = nullptr; // the first record takes the slow path, which finds or takes a chunk
    if (context->firstCurrent) {
        context->firstCurrent = false;
        loadOwnNeeds();
        readVersion(*context);
    }
    context->drawsPixmap = draw && draw->isPixmap;
    if (draw) draw->inherited = false;
    const uint32_t drawWindow = draw ? draw->id : 0, readWindow = read ? read->id : 0;
    const bool bound = entered || context->drawWindow != drawWindow || context->readWindow != readWindow;
    refreshDrawLocally(t);
    announce(t, *context);
    known::retain(*context, draw, read);
    const bool readIsNew = read && !read->announced;
    for (Window* w : {draw, read}) {
        if (!w) continue;
        if (w->nativeGone) checkForDestroyed(*w);
        introduceWindow(*w);
        if (!w->sizeKnown) updateWindowSize(t, *w);
        if (w == draw) readBufferFormats(*context, *w);
        readFrontBuffer(*w);
        announce(t, *w);
    }
    t.drawingAwaited = context->hasDefaultSamples;
    const uint32_t readBefore = context->readWindow;
    const bool readsOther = read && (readIsNew || read->id != readBefore);
    context->drawWindow = drawWindow;
    context->readWindow = readWindow;
    records::makeCurrent(t, context->id, context->drawWindow, context->readWindow);
    if (readsOther) sendReadBuffer(t, *context, *read, readBefore);
    freeDestroyed(t);
    refreshBoundTextures(t);
    s->publish(t, false);
    watchFromHere(t);
    if (bound && draw) backBufferBound(t, *draw);
    if (bound && draw && !draw->config.doubleBuffer) noteFlush(t, *draw); // nothing is drawn yet
}

void updateWindowSize(ThreadState& t, Window& w) {
    uint32_t width = 0, height = 0;
    w.sizeKnown = true;
    if (!queryWindowSize(w, width, height) || (width == w.config.width && height == w.config.height)) return;
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

bool isVerified(const Session& s, uint32_t frame) {
    const uint32_t every = s.welcome().verifyEvery;
    return every && frame % every == 0;
}

bool drawsToFront() {
    GLint framebuffer = 0, buffer = 0;
    gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer != 0) return true; // the window's draw buffer cannot be queried now
    gReal.glGetIntegerv(GL_DRAW_BUFFER, &buffer);
    return buffer != GL_BACK && buffer != GL_BACK_LEFT && buffer != GL_NONE;
}

// Shows the front buffer of a double-buffered window as a picture. The back buffer stays as it is.
void showFront(ThreadState& t, Window& w) {
    Session* s = Session::current();
    if (!s || !s->alive()) return;
    t.context->frontDue = drawsToFront();
    const uint32_t frame = s->nextFrame();
    if (isVerified(*s, frame)) countUncompared(capture::Uncompared::Front);
    const bool putsItself = s->welcome().displayApp && announceOwnPut(*s->header(), w, frame);
    records::frontPicture(t, w.id, frame);
    s->publish(t, false);
    if (putsItself) s->takePictures(frame);
    s->waitForCredit();
    refreshDrawLocally(t);
}

} // namespace

void flushedWindow(ThreadState& t) {
    if (!t.context) return;
    Window* w = findWindowById(t.context->drawWindow);
    // EGL shows a single-buffered surface at its swap.
    if (!w || t.cursor == w->lastFlush || !(w->config.doubleBuffer ? t.context->frontDue : !w->isEgl)) return;
    if (w->config.doubleBuffer)
        showFront(t, *w);
    else
        endFrame(w);
    noteFlush(t, *w);
}

void beforeMakeCurrent(const Context* next, const Window* draw, const Window* read) {
    ThreadState& t = *tThread;
    if (!t.context || t.context->keepsUnflushed) return;
    const uint32_t drawWindow = draw ? draw->id : 0, readWindow = read ? read->id : 0;
    if (t.context == next && t.context->drawWindow == drawWindow && t.context->readWindow == readWindow) return;
    const Window* const given = findWindowById(t.context->drawWindow);
    if (!given || given->config.isPbuffer || (given->config.doubleBuffer && !t.context->frontDue) ||
        !drewSinceFlush(t, *given))
        return;
    gReal.glFlush(); // so that the driver's front buffer, which lacks the draws, does not cover the picture
    flushedWindow(t);
}

namespace {

// GLX frees the buffers of a plain X window with the last context that was bound to it.
bool hasBuffers(const Window& w) { return w.announced && (w.isEgl || w.drawable != w.native || w.holders > 0); }

} // namespace

bool swapLocally() {
    Session* s = Session::current();
    // With --verify the program's own GL must draw the picture to compare with.
    return !s || !s->alive() || s->welcome().localRendering == capture::kLocalRenderingOn ||
           s->welcome().verifyEvery > 0;
}

bool swapsItself(Window* w) {
    // the driver does the swap or reports the error
    if (!w || w->inherited || w->nativeGone || !hasBuffers(*w)) return true;
    if (w->drawnInPart) {
        w->drawnInPart = false; // the next picture is complete
        return false;
    }
    return swapLocally() || w->isPixmap;
}

namespace {

// Drivers queue the draws of a list even if they are discarded (llvmpipe up to 36 MiB). Without local swaps only a
// flush releases them.
void flushLists(Context& c) {
    constexpr uint32_t kMaxLists = 32;                                       // about 60 KiB each
    if (c.listsUnflushed < kMaxLists || swapLocally() || c.frontDue) return; // a flush would show the front buffer
    c.listsUnflushed = 0;
    gReal.glFlush();
}

} // namespace

namespace {

// Flushes no context of this thread. Other threads have published their draws into the window with their own flush.
void endFrameWithoutContext(Session& s, Window& w) {
    if (!w.isEgl && __atomic_load_n(&swapsNeedContext, __ATOMIC_RELAXED)) return;
    ThreadState& t = ownThreadState();
    const uint32_t frame = s.nextFrame();
    if (isVerified(s, frame)) countUncompared(capture::Uncompared::NoContext);
    records::swap(t, w.id, frame);
    s.publish(t, false, false);
    s.waitForCredit();
    w.sizeKnown = false;
}

} // namespace

void endFrame(Window* w) {
    ThreadState& t = *tThread;
    Session* s = Session::current();
    if (w && w->inherited) inheritedUsed(w);
    if (s && hasWindowRequests()) takeGoneWindows();
    // A single-buffered window is shown by flushes of a context that has the window current.
    const bool shows = w && !w->inherited && !w->nativeGone && hasBuffers(*w) &&
                       (w->config.doubleBuffer || (t.context && t.context->drawWindow == w->id));
    if (!s || !s->alive() || !shows) {
        refreshDrawLocally(t);
        return;
    }
    if (!t.context) return endFrameWithoutContext(*s, *w);
    if (bypassesCapture(t, *w)) {
        s->die(nullptr);
        refreshDrawLocally(t);
        return;
    }
    beforeDraw(t, *t.context);
    const uint32_t frame = s->nextFrame();
    if (isVerified(*s, frame)) verifyFrame(t, *w);
    const bool putsItself = s->welcome().displayApp && announceOwnPut(*s->header(), *w, frame);
    records::swap(t, w->id, frame);
    if (w->config.doubleBuffer) noteFlush(t, *w); // drivers flush the front at a swap
    ++t.context->swaps;
    flushLists(*t.context);
    s->publish(t, false, false); // waitForCredit wakes the head if necessary
    watchFromHere(t);
    if (putsItself) s->takePictures(frame);
    s->waitForCredit();
    takeDriverEvents(t);
    w->sizeKnown = false;
    t.drawingAwaited = true;
    t.limit = nullptr;
    refreshDrawLocally(t);
    s->countFrameCpu(t);
}

} // namespace mural
