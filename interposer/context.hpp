// What the interposer knows of the program's contexts, share groups and drawables. The program's own
// context (of the vendor's driver) knows everything else and is asked.
#pragma once

#include <GL/gl.h>
#include <atomic>
#include <cstdint>

#include "interposer/local_pixels.hpp"
#include "interposer/lock.hpp"
#include "interposer/owed_reads.hpp"
#include "interposer/query_answers.hpp"
#include "interposer/thread_state.hpp"
#include "interposer/vertex_arrays.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

struct Window;
struct MappedBuffer; // interposer/mapped_buffers.cpp
struct DebugListener; // interposer/news.cpp

// One bit per object name. Names beyond are taken as false.
class NameBits {
public:
    void set(GLuint name, bool on) {
        if (!known(name)) return;
        const uint64_t bit = uint64_t{1} << name % 64;
        bits_[name / 64] = on ? bits_[name / 64] | bit : bits_[name / 64] & ~bit;
    }
    [[nodiscard]] bool get(GLuint name) const { return known(name) && (bits_[name / 64] >> name % 64 & 1); }

    [[nodiscard]] static bool known(GLuint name) { return name < kNames; }

private:
    static constexpr GLuint kNames = 16384;
    uint64_t bits_[kNames / 64] = {};
};

// Contexts that share objects. When more than one thread has one of them current, every record takes
// the lock, and the writer before is published first: so the stream keeps the order of the calls.
struct ShareGroup {
    Lock lock;
    ThreadState* lastWriter = nullptr;
    int threads = 0; // that have a context of the group current
    int unsettledThreads = 0; // ThreadState::mayBeWriting
    bool inherited = false; // the parent's of a forked child: its objects are in the parent's stream
    MappedBuffer* maps = nullptr; // mappings of buffers that are not unmapped yet
    std::atomic<int> lastingMaps{0}; // persistent ones
    Lock mapsLock;                // of the list; records are written under it
    std::atomic<ThreadState*> mapsHolder{nullptr};
    bool listsMoveRaster = false;   // some display list moves the raster position by glBitmap
    NameBits listMovesRaster;       // this list does, or calls others, which may
    NameBits listCompiled, listAsks; // holds conditional rendering, or calls a list that does or may
    NameBits listOpens, listCloses;  // leaves a primitive open that it has begun; ends one that it has not
    bool listsChange = false;        // a list was compiled again: what calls it may ask now
    static constexpr int kConditions = 64;
    GLuint listConditions[kConditions] = {}; // queries that conditional rendering in display lists asks
    int listConditionCount = 0;
    NameBits listCounts;             // queries that display lists begin
    bool allDrawn = false;           // by every node (copies::drawAll)
    bool nodesWriteBuffers = false; // transform feedback or shaders have written into buffers
    NameBits nodesWrite;            // this buffer was bound where they do
    OwedReads owedReads;
};

// Context::openPrimitive outside of glBegin and glEnd.
constexpr uint32_t kNoPrimitive = UINT32_MAX;
constexpr int64_t kNoRestart = -1;

struct Context {
    bool called = false;             // by a GL command that came through us
    std::byte* quietSince = nullptr; // where the stream was when the last of our own records was written
    int emptyFrames = 0;             // shown before the first such command
    NameBits queryIsAny;      // ANY_SAMPLES_PASSED and its kin
    NameBits queryIsTimestamp;
    NameBits queryBegun;
    GLuint queryBuffer = 0;    // bound to GL_QUERY_BUFFER
    GLuint pinnedBuffer = 0;   // bound to GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD
    QueryAnswers answers;
    uint32_t swaps = 0;        // while it was current
    uint32_t listsUnflushed = 0; // called without drawing since the program's own driver was flushed
    uint32_t id = 0;
    ShareGroup* group = nullptr;
    wire::Api api = wire::Api::Desktop;
    bool announced = false;    // the nodes know it
    bool core = false;
    [[nodiscard]] bool compatible() const { return api == wire::Api::Desktop && !core; }
    bool destroyed = false;    // by the program, while still current
    bool freeDue = false;      // the nodes have to be told
    int version = 0;           // 10 * major + minor, of the local context
    wire::WindowConfig config{};
    uint32_t flags = 0;
    uint32_t profileMask = 0;
    void* native = nullptr;    // GLXContext or EGLContext
    void* display = nullptr;   // Display* or EGLDisplay

    VertexArrayMirror arrays;
    GLenum stashedError = 0;   // an error that we met while asking, for the program's next glGetError
    DebugListener* debug = nullptr; // what the program hears, and has heard
    uint32_t errorsTold = 0;        // of the program's own GL; the nodes count along (wire::kOpErrorTold)
    bool outOfMemoryDue = false;    // told by a node, not by glGetError yet
    bool keepsUnflushed = false;    // KHR_context_flush_control: giving it up flushes nothing
    bool losesOnReset = false;      // the program has asked to be told when the context is lost
    GLenum resetStatus = 0;         // what a node's driver told, not by glGetGraphicsResetStatus yet
    bool compilingList = false;
    bool drawsList = false;    // and executes it at once
    GLuint compiledList = 0;   // its name
    bool listPrimitive = false; // it is between glBegin and glEnd, where lists take what makes vertices
    bool frontDue = false;     // the front buffer was drawn to since the last flush, or will be
    GLenum renderMode = GL_RENDER;
    bool drawsSelection = false; // selects or gives feedback in the program's own context
    bool feedbackCounts = false; // the driver counts vertices of transform feedback at the draw, for an error
    bool drawsFeedback = false;  // such feedback is active: the program's own context draws, too
    uint32_t openPrimitive = kNoPrimitive; // the mode of glBegin until glEnd
    int64_t restartElement = kNoRestart;   // glArrayElement of it starts the primitive anew; asked for at glBegin
    bool firstCurrent = true;
    uint32_t drawWindow = 0, readWindow = 0; // 0: none; both stay when the context is released
    Window* held[2] = {};      // what it was last bound to: a driver keeps these drawables alive
    bool hasDefaultSamples = false; // some framebuffer object has (interposer/default_samples.hpp)
    bool drawsPixmap = false;  // its drawable is an X pixmap
    bool isMesa = false;
    uintptr_t indicesInMemoryFrom = 0; // smaller pointers of indexed draws are offsets into a buffer in any case
    bool sizeAtViewport = false; // the driver looks at the window's size in glViewport too
    char* extensionText = nullptr; // filtered, both made at the first question
    const char** extensionNames = nullptr;
    int extensionCount = -1;
};

struct Window {
    uint32_t id = 0;
    uintptr_t drawable = 0;    // GLXDrawable or EGLSurface
    void* display = nullptr;
    bool isEgl = false;
    bool isPixmap = false;     // X requests read it, so the program's own GL draws into it, too
    bool announced = false;
    bool freeDue = false;      // the program has destroyed it, the nodes have to be told
    bool sizeKnown = false;    // the driver's buffers have a size until the next swap
    bool inherited = false;    // drawn by a context of the parent of this forked child: on its own
    int holders = 0;           // contexts that were last bound to it
    uint64_t native = 0;       // X window
    uint64_t server = 0;       // of that (interposer/windows/x_server.hpp), from its introduction on
    bool introduced = false;   // interposer/windows/introduction.hpp
    bool nativeGone = false;   // the X window was destroyed
    wire::WindowConfig config{};
    std::byte* lastFlush = nullptr; // where the stream was at the last flush of a single-buffered window
    LocalPixels pixels;
    GLuint boundTexture = 0;   // of boundGroup: shows what is drawn here (interposer/texture_from.hpp)
    ShareGroup* boundGroup = nullptr;
    bool boundAlpha = false;
    bool boundTextureDue = false; // it was drawn to since
    bool drawnInPart = false;  // the back buffer lacks what the program has drawn through us
    Window* next = nullptr;
};

// Sets drawLocally from policy, list compilation, render mode and whether the head lives.
void refreshDrawLocally(ThreadState& t);

// The id of a context that the nodes have and whose objects are c's; 0: they have none.
uint32_t announcedSharer(const Context& c);
// Registers a context that the driver has made. shareWith may be null.
Context* addContext(void* native, void* display, Context* shareWith, wire::Api api, const wire::WindowConfig& config);
Context* findContext(void* native);
void destroyContext(void* native);

Window* addWindow(uintptr_t drawable, void* display, bool isEgl, const wire::WindowConfig& config, uint64_t native);
Window* findWindow(uintptr_t drawable, void* display);
Window* findWindowById(uint32_t id);
Window* nextWindow(const Window* before); // null: the first. Those that are given up are among them
void destroyWindow(uintptr_t drawable, void* display);
// Ends a destroyed X window. The server may give its number to another window.
void nativeWindowEnds(uint64_t server, uint64_t native);
// Ends the windows that one connection has created: their numbers are firstNative plus bits of `mask`.
void nativeWindowsEnd(uint64_t server, uint64_t firstNative, uint64_t mask);
// Ends the drawables and contexts of a closed Display* or a terminated EGLDisplay. A current context lives until its
// release, as in EGL. With GLX the caller has released it.
void displayEnds(void* display, bool isEgl);

// The driver has made `context` current with these drawables (null: none): says so in the stream.
void becameCurrent(Context* context, Window* draw, Window* read);
// A thread ends with a context current: it is free for other threads.
void threadLeaves(ThreadState& t);
// Asks the window's size and announces a change. Done at the moments at which Mesa gives its buffers
// a size: when the window is bound first, and at the first drawing after a swap.
void updateWindowSize(ThreadState& t, Window& w);
// While t.drawingAwaited: before each record.
void beforeAwaitedDrawing(ThreadState& t, uint32_t opcode);
// The program shows the window's back buffer: a frame ends. The window need not be current, nor any context.
void endFrame(Window* w);
// Before the driver makes `next` (null: none) current with these drawables: giving up a context flushes it, and a flush shows
// what was drawn into a front buffer.
void beforeMakeCurrent(const Context* next, const Window* draw, const Window* read);
// glFlush or glFinish shows what was drawn into a front buffer: a frame, when something was drawn.
void flushedWindow(ThreadState& t);
// Whether frames are drawn and shown by the program's own GL, too.
bool swapLocally();
// Whether the driver's own swap of this window (null: one that we do not know) follows on endFrame.
bool swapsItself(Window* w);

// Tells the nodes the results that conditional rendering in display lists needs (commands/queries.cpp).
void tellListConditions(ThreadState& t, const char* by);
inline bool listAsks(const ShareGroup& group, GLuint list) {
    return group.listsChange || !NameBits::known(list) || !group.listCompiled.get(list) || group.listAsks.get(list);
}
inline void beforeList(ThreadState& t, GLuint list, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->listConditionCount > 0 && listAsks(*t.context->group, list)) [[unlikely]] tellListConditions(t, by);
}
inline void beforeLists(ThreadState& t, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->listConditionCount > 0) [[unlikely]] tellListConditions(t, by);
}

// The driver takes few calls between glBegin and glEnd. Where it draws nothing its primitive can be
// ended for a while: it has no vertices.
class PrimitivePause {
public:
    explicit PrimitivePause(const ThreadState& t);
    ~PrimitivePause();
    PrimitivePause(const PrimitivePause&) = delete;
    PrimitivePause& operator=(const PrimitivePause&) = delete;

private:
    uint32_t mode_;
};

// Ships what the program has changed in persistent mappings; called before anything that may read buffers.
void shipLastingMaps(ThreadState& t);
inline void beforeDraw(ThreadState& t, Context& c) {
    if (c.group->lastingMaps.load(std::memory_order_relaxed) > 0) [[unlikely]] shipLastingMaps(t);
}
inline void buffersRead(ThreadState& t) {
    if (t.context) beforeDraw(t, *t.context);
}

// Before the program looks at the buffer's bytes or changes some: what it has read into it comes first.
inline void settleReads(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->owedReads.count.load(std::memory_order_relaxed) > 0) [[unlikely]] settle(t, buffer, by);
}
// The same of the buffer that is bound there. Others than the pack buffer are owed nothing.
inline void settleBound(ThreadState& t, GLenum target, const char* by = __builtin_FUNCTION()) {
    if (target == GL_PIXEL_PACK_BUFFER && t.context && t.context->group->owedReads.count.load(std::memory_order_relaxed) > 0) [[unlikely]]
        settle(t, boundPackBuffer(), by);
}
// Before a buffer is used for anything but reads into it and the program's own access: the nodes need its bytes.
inline void bufferUsed(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION()) {
    if (buffer && t.context && t.context->group->owedReads.onlyReadInto(buffer)) [[unlikely]] firstUse(t, buffer, by);
}
inline void boundUsed(ThreadState& t, GLenum target, const char* by = __builtin_FUNCTION()) {
    if (target == GL_PIXEL_PACK_BUFFER && t.context) bufferUsed(t, boundPackBuffer(), by);
}
inline void buffersUsed(ThreadState& t, GLsizei count, const GLuint* buffers, const char* by = __builtin_FUNCTION()) {
    for (GLsizei i = 0; buffers && i < count; ++i) bufferUsed(t, buffers[i], by);
}

} // namespace mural
