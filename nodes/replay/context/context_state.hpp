// State of a program's context on this node: state that tiling changes, and names of this node that differ
// from the program's.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/geometry/pixel_viewport.hpp"
#include "gl_functions.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/replay/context/share_group.hpp"
#include "nodes/replay/context/window_state.hpp"
#include "nodes/replay/engine/name_table.hpp"
#include "nodes/replay/features/projection_detection.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::replay {

struct ContextCulling;

struct Scissor {
    bool enabled = false;
    PixelViewport box;
};

inline constexpr int kViewports = 16;
// The program's masks. Alpha of a window that hides its own is never written.
struct ColorMasks {
    std::array<std::array<GLboolean, 4>, 8> buffers;
    bool differ = false; // indexed commands were used
    ColorMasks() { buffers.fill({GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE}); }
};

// The state that glPushAttrib saved.
struct SavedAttributes {
    GLbitfield mask;
    std::array<Scissor, kViewports> scissors;
    GLuint listBase;
    std::array<std::array<GLfloat, 4>, kViewports> viewports;
    GLenum drawBuffer0, readBuffer0;
    GLuint program;
    ColorMasks colorMasks;
};

struct PixelUnpack {
    std::array<GLint, 8> values{}; // in the order of kUnpackNames; alignment is initialised to 4
    bool tight = false;            // the driver currently has tight packing set
};

// The client state that glPushClientAttrib saved.
struct SavedClientState {
    GLbitfield mask;
    PixelUnpack unpack;
    std::array<GLint, 8> pack;
    GLuint arrayBuffer, packBuffer, unpackBuffer;
};

// A piece of a query. Fragments that every node draws count once; the others are summed over the tiles.
struct QueryPiece {
    GLuint nodeName;
    bool whole;
};

struct QueryInfo {
    GLenum target = 0;
    std::vector<QueryPiece> pieces; // the first is the program's own query
    bool skipped = false;           // a frame was skipped while it counted
    bool passed = true;             // result for the whole picture, reported by the program's side
};

// Window pixels for the next copy, collected from all nodes (lean tiling and multisampled windows).
struct Gathered {
    PixelViewport box; // empty: none
    GLuint framebuffer = 0, color = 0, depthStencil = 0;
    std::vector<uint32_t> depth; // kept until the stencil arrives
};

struct Prefetch { // a query whose result is answered at the next swap
    uint32_t request;
    GLuint query;
};

// Messages of the driver, which may arrive on the driver's own threads.
struct DebugInbox {
    struct Message {
        uint32_t source, type, id, severity;
        std::string text;
    };
    std::mutex mutex;
    std::vector<Message> messages;
    std::atomic<bool> any{false};
};

struct ContextState {
    DebugInbox debug;                              // outlives the context
    bool debugs = false;                           // the program requested a debug context
    bool listens = false;                          // the driver sends its messages to `debug`
    bool lost = false;                             // the driver has reset it
    bool pendingCommands = false;                  // not flushed when the program releases it
    uint32_t errorsReported = 0;                   // number of errors that the program's own GL has reported to it
    std::unordered_map<GLuint, QueryInfo> queries; // by the program's name
    std::vector<Prefetch> prefetches;
    std::map<GLenum, GLuint> counting; // active fragment queries: target to the program's query
    bool countsWhole = false;          // value of isReplicatedDraw() at the start of the last piece
    bool countedWhole = false;         // an active query requires the whole picture on every node
    bool conditional = false, isConditionTrue = false;
    GLuint condition = 0; // this node's name of the deciding query, and its mode
    GLenum conditionMode = 0;
    GLuint queryBuffer = 0;    // this node's name of the buffer for results
    GLuint nothingCounted = 0; // a query whose result is 0
    uint32_t client = 0, id = 0;
    bool destroyed = false; // freed when no stream has it current
    std::unique_ptr<gl::Context> context;
    gl::ContextConfig contextConfig; // configuration of its creation
    std::shared_ptr<ShareGroup> shared;
    NameTable own[static_cast<int>(Kind::Count)];
    wire::Api api = wire::Api::Desktop;
    int version = 0;
    bool core = false;
    Window* draw = nullptr;
    Window* read = nullptr;
    bool everCurrent = false;
    GLuint drawFramebuffer = 0, readFramebuffer = 0;          // the program's names
    GLuint arrayBuffer = 0, packBuffer = 0, unpackBuffer = 0; // this node's names
    GLuint program = 0;                                       // the program's name
    std::array<Scissor, kViewports> scissors;
    bool scissorsDiffer = false; // indexed commands were used
    std::array<std::array<GLfloat, 4>, kViewports> viewports{};
    bool viewportsDiffer = false;
    ColorMasks colorMasks;
    GLenum drawBuffer0 = 0, readBuffer0 = 0; // of the default framebuffer, as the program named them
    PixelUnpack unpack;
    std::array<GLint, 8> pack{};
    bool gathersBitmaps = false; // the driver may have batched some (features/bitmap_flush.cpp)
    bool packsBlocks = false;    // the program has set pack parameters of compressed blocks
    GLuint listBase = 0;
    GLuint compiling = 0; // name of the list, 0: none
    GLenum compileMode = 0;
    bool compilesPrimitive = false; // between glBegin and glEnd
    DisplayList building;
    std::vector<SavedAttributes> attributes;
    std::vector<SavedClientState> clientAttributes;
    std::vector<std::vector<std::byte>> arrayMemory; // spans of client arrays
    GLuint fillFramebuffer = 0;
    Gathered gathered;
    GLfloat cullMargin = 16;      // in pixels; only grows, because lists and stacks may restore wide lines
    bool lineStippled = false;    // at any time so far: a dropped piece of a strip would shift the pattern
    bool clippingCounted = false; // a query counts primitives before or after clipping
    bool arbPositions = false;    // an ARB program reads the window's offset
    bool pipelineBound = false;
    std::set<GLenum> openQueries; // active queries of other counts than samples
    bool feedsBack = false;       // transform feedback may be active
    // The current draw target, as determined at the last draw (features/stereo_scenes.cpp).
    bool attachmentsKnown = false, depthAttached = false, sceneSized = false, depthTested = false;
    // Fixed function for another eye: GL's projection differs from the program's (features/stereo_view.cpp).
    bool projectionShifted = false;
    // Sort-last: whether draws may be shared, valid until state changes (features/sort_last.cpp).
    bool rangeKnown = false, mayShare = false;
    bool writesMemory = false;   // storage or images were bound; vertex shaders may write to them
    bool rangeFeedsBack = false; // transform feedback is active
    int activeQueries = 0;
    bool inPrimitive = false;
    std::shared_ptr<ContextCulling> culling; // null: nothing examined yet
    bool projectionKnown = false;            // fixedProjection is current, for shaders that may read it
    ProjectionDetector fixedProjection;
    std::array<GLfloat, 16> onProjection{}, shiftedProjection{};
};

} // namespace mural::replay
