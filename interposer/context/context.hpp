// The interposer's own state of the program's contexts, share groups and drawables. It queries all other state from the
// program's own context, which the vendor's driver holds.
#pragma once

#include <GL/gl.h>
#include <atomic>
#include <cstdint>

#include "interposer/diagnostics/back_buffer_probe.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/readback/pending_reads.hpp"
#include "interposer/readback/query_results.hpp"
#include "interposer/context/thread_state.hpp"
#include "interposer/memory/vertex_arrays.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

struct Window;
struct MappedBuffer;  // interposer/memory/mapped_buffers.cpp
struct DebugListener; // interposer/diagnostics/driver_events.cpp

// One bit per object name. Names above the limit count as false.
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

// Contexts that share objects. If several threads have contexts of the group current, every record takes the lock, and
// the previous writer's records are published first. The stream thus keeps the order of the calls.
struct ShareGroup {
    Lock lock;
    ThreadState* lastWriter = nullptr;
    int threads = 0;                    // number of threads with a current context of the group
    int unsettledThreads = 0;           // number of threads with ThreadState::mayBeWriting
    bool inherited = false;             // it belongs to a forked child's parent, whose stream has its objects
    MappedBuffer* maps = nullptr;       // active mappings of buffers
    std::atomic<int> persistentMaps{0}; // number of persistent mappings
    Lock mapsLock;                      // guards the list; records are written under it
    std::atomic<ThreadState*> mapsOwner{nullptr};
    bool listsMoveRaster = false;           // a display list moves the raster position by glBitmap
    NameBits listMovesRaster;               // this list does, or calls lists that may
    NameBits listCompiled, listConditional; // contains conditional rendering, or calls a list that may
    NameBits listOpens, listCloses;         // ends with an unmatched glBegin; contains an unmatched glEnd
    bool listsChange = false;               // a list was recompiled: its callers may now contain conditional rendering
    static constexpr int kConditions = 64;
    GLuint listConditions[kConditions] = {}; // query conditions of conditional rendering in display lists
    int listConditionCount = 0;
    NameBits listCounts;            // queries that display lists begin
    bool allDrawn = false;          // every node draws the whole window (copies::drawAll)
    bool nodesWriteBuffers = false; // transform feedback or shaders have written into buffers
    NameBits nodesWrite;            // this buffer was bound for such writes
    PendingReads pendingReads;
};

// Value of Context::openPrimitive outside of glBegin and glEnd.
constexpr uint32_t kNoPrimitive = UINT32_MAX;
constexpr int64_t kNoRestart = -1;

struct Context {
    bool called = false;             // a captured GL command has used the context
    std::byte* quietSince = nullptr; // stream position after the last control record
    int emptyFrames = 0;             // frames shown before the first captured command
    NameBits queryIsAny;             // ANY_SAMPLES_PASSED and its variants
    NameBits queryIsTimestamp;
    NameBits queryBegun;
    GLuint queryBuffer = 0;  // bound to GL_QUERY_BUFFER
    GLuint pinnedBuffer = 0; // bound to GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD
    QueryResults answers;
    uint32_t swaps = 0;          // swaps while it was current
    uint32_t listsUnflushed = 0; // lists called without drawing since the last flush of the program's own driver
    uint32_t id = 0;
    ShareGroup* group = nullptr;
    wire::Api api = wire::Api::Desktop;
    bool announced = false; // the nodes have it
    bool core = false;
    [[nodiscard]] bool compatible() const { return api == wire::Api::Desktop && !core; }
    bool destroyed = false; // the program destroyed it while it was current
    bool freeDue = false;   // the nodes must receive its destruction
    int version = 0;        // 10 * major + minor, of the local context
    wire::WindowConfig config{};
    uint32_t flags = 0;
    uint32_t profileMask = 0;
    void* native = nullptr;  // GLXContext or EGLContext
    void* display = nullptr; // Display* or EGLDisplay

    VertexArrayMirror arrays;
    GLenum stashedError = 0;        // an error raised by our own queries, for the program's next glGetError
    DebugListener* debug = nullptr; // the program's debug callback and the messages that it has received
    // number of errors that the program has received; the nodes keep the same count (wire::kOpErrorReported)
    uint32_t errorsReported = 0;
    bool outOfMemoryDue = false; // reported by a node, not yet by glGetError
    bool keepsUnflushed = false; // KHR_context_flush_control: releasing it flushes nothing
    bool losesOnReset = false;   // the program has requested reset notification
    GLenum resetStatus = 0;      // reported by a node's driver, not yet by glGetGraphicsResetStatus
    bool compilingList = false;
    bool drawsList = false;     // the list is also executed at once
    GLuint compiledList = 0;    // name of the list
    bool listPrimitive = false; // the list is between glBegin and glEnd, where it accepts vertex commands only
    bool frontDue = false;      // the front buffer was drawn into since the last flush, or will be
    GLenum renderMode = GL_RENDER;
    bool drawsSelection = false;           // selection or feedback runs in the program's own context
    bool feedbackCounts = false;           // at draws, the driver checks transform feedback for overruns
    bool drawsFeedback = false;            // such feedback is active: the program's own context draws as well
    uint32_t openPrimitive = kNoPrimitive; // mode of the open glBegin
    int64_t restartElement = kNoRestart;   // glArrayElement of this index restarts the primitive; queried at glBegin
    bool firstCurrent = true;
    uint32_t drawWindow = 0, readWindow = 0; // 0: none; both persist when the context is released
    Window* retained[2] = {};                // the last bound drawables, which a driver keeps alive
    bool hasDefaultSamples = false; // a framebuffer object has its own number (interposer/context/default_samples.hpp)
    bool drawsPixmap = false;       // its drawable is an X pixmap
    bool isMesa = false;
    uintptr_t indicesInMemoryFrom = 0; // smaller pointers of indexed draws are always offsets into a buffer
    bool sizeAtViewport = false;       // the driver also checks the window's size in glViewport
    char* extensionText = nullptr;     // filtered; both are made at the first query
    const char** extensionNames = nullptr;
    int extensionCount = -1;
};

struct Window {
    uint32_t id = 0;
    uintptr_t drawable = 0; // GLXDrawable or EGLSurface
    void* display = nullptr;
    bool isEgl = false;
    bool isPixmap = false; // X requests read it, so the program's own GL draws into it as well
    bool announced = false;
    bool freeDue = false;    // the program has destroyed it; the nodes must receive its destruction
    bool sizeKnown = false;  // the driver's buffers keep their size until the next swap
    bool inherited = false;  // a context of this forked child's parent draws into it, outside the wall
    int holders = 0;         // number of contexts that were last bound to it
    uint64_t native = 0;     // X window
    uint64_t server = 0;     // X server of `native` (interposer/x11/x_server.hpp), from its introduction on
    bool introduced = false; // interposer/x11/introduction.hpp
    bool nativeGone = false; // the X window was destroyed
    wire::WindowConfig config{};
    std::byte* lastFlush = nullptr; // stream position at the last flush that showed the window
    uint64_t lastFlushChunk = 0;    // chunkUse() at that time
    BackBufferProbe pixels;
    GLuint boundTexture =
        0; // texture of boundGroup that shows this picture (interposer/readback/drawable_textures.hpp)
    ShareGroup* boundGroup = nullptr;
    bool boundAlpha = false;
    bool boundTextureDue = false; // the window was drawn into since the last update
    bool drawnInPart = false;     // the local back buffer lacks captured draws
    Window* next = nullptr;
};

// Sets drawLocally from --local-rendering, list compilation, the render mode and the state of the head.
void refreshDrawLocally(ThreadState& t);

// Returns the id of a context that the nodes have and that shares c's objects. 0: none.
uint32_t announcedSharer(const Context& c);
// Registers a context that the driver has created. shareWith may be null.
Context* addContext(void* native, void* display, Context* shareWith, wire::Api api, const wire::WindowConfig& config);
Context* findContext(void* native);
void destroyContext(void* native);

Window* addWindow(uintptr_t drawable, void* display, bool isEgl, const wire::WindowConfig& config, uint64_t native);
Window* findWindow(uintptr_t drawable, void* display);
Window* findWindowById(uint32_t id);
Window* nextWindow(const Window* before); // null: the first. Includes destroyed windows
void destroyWindow(uintptr_t drawable, void* display);
// Handles the destruction of an X window. The server may give its number to another window.
void nativeWindowEnds(uint64_t server, uint64_t native);
// Handles the end of all windows that one connection has created. Their numbers are firstNative plus bits of `mask`.
void nativeWindowsEnd(uint64_t server, uint64_t firstNative, uint64_t mask);
// Handles a closed Display* or a terminated EGLDisplay: ends its drawables and contexts. A current context lives until
// its release, as in EGL. With GLX the caller has released it.
void displayEnds(void* display, bool isEgl);

// Call after the driver has made `context` current with these drawables (null: none). Writes this into the stream.
void becameCurrent(Context* context, Window* draw, Window* read);
// Releases the current context of an ending thread for other threads.
void threadLeaves(ThreadState& t);
// Queries the window's size and announces a change. Called when Mesa sizes its buffers: at the window's first binding,
// and at the first draw after a swap.
void updateWindowSize(ThreadState& t, Window& w);
// Call before each record while t.drawingAwaited is set.
void beforeAwaitedDrawing(ThreadState& t, uint32_t opcode);
// Ends a frame: the program shows the window's back buffer. Requires neither a current window nor a current context.
void endFrame(Window* w);
// Call before the driver makes `next` (null: none) current with these drawables. The release of a context flushes it,
// and a flush shows the front buffer.
void beforeMakeCurrent(const Context* next, const Window* draw, const Window* read);
// Ends a frame if the program has drawn into a front buffer, which glFlush and glFinish show.
void flushedWindow(ThreadState& t);
// Returns whether the program's own GL draws and shows frames as well.
bool swapLocally();
// Returns whether the driver's own swap of this window must follow endFrame. Null: an unknown window.
bool swapsItself(Window* w);

// Sends the nodes the query results for conditional rendering in display lists (interposer/wrappers/queries.cpp).
void sendListConditions(ThreadState& t, const char* by);
inline bool listConditional(const ShareGroup& group, GLuint list) {
    return group.listsChange || !NameBits::known(list) || !group.listCompiled.get(list) ||
           group.listConditional.get(list);
}
inline void beforeList(ThreadState& t, GLuint list, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->listConditionCount > 0 && listConditional(*t.context->group, list)) [[unlikely]]
        sendListConditions(t, by);
}
inline void beforeLists(ThreadState& t, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->listConditionCount > 0) [[unlikely]]
        sendListConditions(t, by);
}

// Ends the local primitive for a moment, because the driver accepts few calls between glBegin and glEnd. The primitive
// has no vertices if the program's own context does not draw.
class PrimitivePause {
public:
    explicit PrimitivePause(const ThreadState& t);
    ~PrimitivePause();
    PrimitivePause(const PrimitivePause&) = delete;
    PrimitivePause& operator=(const PrimitivePause&) = delete;

private:
    uint32_t mode_;
};

// Sends the program's writes to persistent mappings. Called before anything that may read buffers.
void flushPersistentMaps(ThreadState& t);
inline void beforeDraw(ThreadState& t, Context& c) {
    if (c.group->persistentMaps.load(std::memory_order_relaxed) > 0) [[unlikely]]
        flushPersistentMaps(t);
}
inline void buffersRead(ThreadState& t) {
    if (t.context) beforeDraw(t, *t.context);
}

// Call before the program accesses the buffer's bytes. Completes deferred reads into the buffer first.
inline void settleReads(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION()) {
    if (t.context && t.context->group->pendingReads.count.load(std::memory_order_relaxed) > 0) [[unlikely]]
        settle(t, buffer, by);
}
// The same for the bound buffer. Deferred reads go into the pack buffer only.
inline void settleBound(ThreadState& t, GLenum target, const char* by = __builtin_FUNCTION()) {
    if (target == GL_PIXEL_PACK_BUFFER && t.context &&
        t.context->group->pendingReads.count.load(std::memory_order_relaxed) > 0) [[unlikely]]
        settle(t, boundPackBuffer(), by);
}
// Call before a use of the buffer other than reads into it and the program's own access. The nodes then need its bytes.
inline void bufferUsed(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION()) {
    if (buffer && t.context && t.context->group->pendingReads.onlyReadInto(buffer)) [[unlikely]]
        firstUse(t, buffer, by);
}
inline void boundUsed(ThreadState& t, GLenum target, const char* by = __builtin_FUNCTION()) {
    if (target == GL_PIXEL_PACK_BUFFER && t.context) bufferUsed(t, boundPackBuffer(), by);
}
inline void buffersUsed(ThreadState& t, GLsizei count, const GLuint* buffers, const char* by = __builtin_FUNCTION()) {
    for (GLsizei i = 0; buffers && i < count; ++i) bufferUsed(t, buffers[i], by);
}

} // namespace mural
