// Replays capture streams on this node's GL: all contexts of all programs, on one thread.
//
// The generated replay calls GL for most commands. Commands that tiling changes, or that name this node's objects
// differently, are written by hand (replay_*.cpp).
#pragma once

#include <array>
#include <atomic>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "common/base/picture_format.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "common/geometry/tile_grid.hpp"
#include "common/geometry/viewport.hpp"
#include "gl_functions.hpp"
#include "nodes/exchange/part_composition.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/frame_transfer/picture_read.hpp"
#include "nodes/replay/engine/colour_words.hpp"
#include "nodes/replay/engine/handle_table.hpp"
#include "nodes/replay/engine/name_table.hpp"
#include "nodes/replay/programs/program_sources.hpp"
#include "nodes/replay/readback/readback_choice.hpp"
#include "nodes/replay/engine/replay_dispatch.hpp"
#include "nodes/replay/engine/replay_setup.hpp"
#include "nodes/replay/features/projection_detection.hpp"
#include "nodes/replay/programs/program_rewriter.hpp"
#include "nodes/replay/programs/tiling.hpp"
#include "nodes/replay/features/clip_transform.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "nodes/session/readback.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/range_assignment.hpp"
#include "streamcodec/wire/args.hpp"
#include "streamcodec/wire/client_arrays.hpp"
#include "streamcodec/sizes/pixel_format.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

class AsyncReadback;

class Replay : private BlobQueue {
public:
    Replay(std::unique_ptr<gl::Platform> platform, ReplayConfig config, ReplayOutputs outputs);
    ~Replay() override;

    // Replays the payload of one packet. Returns false if the stream is broken beyond this packet; the log has the
    // reason.
    bool packet(uint32_t stream, std::span<const std::byte> payload);
    void clientGone(uint32_t client);
    // Ends the skipping of frames: each window is drawn from its next frame on.
    void drawAgain();
    // Time-multiplex: returns the state of all windows that determines their turns.
    [[nodiscard]] std::vector<wire::WindowTurn> turns() const;
    // Sets the turns that another node reported for this position of the stream.
    void takeTurns(std::span<const wire::WindowTurn> turns);
    // Called if no node has the turns. The node of the first turn keeps frames in progress, and all nodes restart their
    // counts.
    void beginTurns();
    // Sort-last: handles the return of a node; `itself`: this node has returned. All nodes of the picture call it at
    // the same position of the stream. `returned` is called between the last composition without the returned node and
    // the first one with it.
    void resetShares(bool itself, std::function<void()> returned);
    // Announces new shares. Each window adopts them with the first shared draw of its next frame.
    void moveShares(const RangeAssignment& shares);
    // Requires ReplayConfig::areas. Applies new areas to each window at its next full clear
    // (features/dynamic_tiles.cpp).
    void moveAreas(ViewportAssignment areas);
    // Returns the payload of a Turns message: the areas that divide this node's windows.
    [[nodiscard]] std::vector<std::byte> memberAreas() const;
    // Sets the areas from such a payload of another node. Returns false if malformed.
    bool takeMemberAreas(std::span<const std::byte> bytes);
    // Called if no node has the areas. Divides all windows by the latest ones.
    void beginAreas();
    // Reports whether the next shown frames depend on skipped draws.
    [[nodiscard]] wire::FrameValidity validity() const;
    [[nodiscard]] const ReplayCounts& counts() const { return counts_; }

    // ---- interface of the generated code
    GlFunctions gl{};
    GLuint name(Kind kind, GLuint app);
    const GLuint* names(Kind kind, const GLuint* app, int64_t count);
    void make(Kind kind, int64_t count, const GLuint* app, const std::function<void(GLuint*)>& call);
    void bindName(Kind kind, GLuint app, GLuint nodeName);
    void forget(Kind kind, const GLuint* app, int64_t count);
    GLint uniformLocation(GLint location);
    GLint uniformLocation(GLuint program, GLint location);
    void clientStatePushed(GLbitfield mask);
    void clientStateDefault(GLbitfield mask);
    // Sets the unpack state for the location of the image. Returns false for an offset while no buffer is bound.
    bool unpackFor(const Data& data);
    // Returns false if the data is absent, or is an offset while no buffer is bound at `binding`: GL would read invalid
    // memory.
    bool readable(const Data& data, GLenum binding);
    bool indicesFit(const Data& indices);
    bool lacking(uint16_t opcode);
    // Runs `call` with only the program's own scissor.
    void withoutTile(const std::function<void()>& call);
    // Runs a copy from the read framebuffer. `call` receives the position to read from.
    void copyLevel(GLint x, GLint y, GLsizei w, GLsizei h, const std::function<void(GLint, GLint)>& call);
    template <class T> T windowX(T x) const { return moved(x, origin().x); }
    template <class T> T windowY(T y) const { return moved(y, origin().y); }
    // v: `count` values, 2 to 4, in the layout of the record (doubles at multiples of 4 bytes).
    template <class T> std::array<T, 4> windowPosition(const T* v, int count) const {
        std::array<T, 4> position{};
        std::memcpy(position.data(), v, static_cast<size_t>(count) * sizeof(T));
        position[0] = windowX(position[0]);
        position[1] = windowY(position[1]);
        return position;
    }
    // Coordinates may be any number, so the difference wraps around instead of being undefined.
    template <class T> static T moved(T value, int32_t by) {
        if constexpr (std::is_integral_v<T>)
            return static_cast<T>(int64_t{value} - by);
        else
            return static_cast<T>(value - static_cast<T>(by));
    }

#include "replay_custom.inc"

private:
    struct ContextState;
    // State of a window's frame in sort-last rendering.
    struct RangeFrame {
        enum class Phase : uint8_t {
            Fresh, // nothing is drawn
            Split, // each node has drawn its range
            Whole  // composited: the collector draws the rest
        } phase = Phase::Fresh;
        GLbitfield cleared = 0; // buffers that were cleared whole since the frame began
        uint64_t cost = 0;      // of all draws so far, in vertices
        uint64_t lastTotal = 0; // cost of the previous frame; 0: unknown
        uint64_t serial = 0;    // number of compositions of this window
        GLenum function = 0;    // depth function of all shared draws
        bool muted = false;     // another node draws the current commands
        bool wasSplit = false;
        Range share;          // this node's part of lastTotal
        uint32_t shares = 0;  // number of the Shares with that part
        uint32_t drawnBy = 0; // number of the Shares of the previous frame
        // number of returned nodes of its picture when the frame began; the composition of the frame includes these
        // nodes
        uint64_t returns = 0;
        CompositeRule rule; // how the nodes' pictures are composited
    };
    // This node's part of a window, where it may change (features/dynamic_tiles.cpp).
    struct MovingPart {
        std::shared_ptr<const ViewportAssignment> areas;  // the current ones
        std::shared_ptr<const ViewportAssignment> wanted; // the ones to apply at the next full clear
        GLbitfield drawn = 0; // buffers with only this node's part; all other buffers are complete on all nodes
        bool fixed = false;   // the areas never change again
        int64_t waits = 0;    // frames since other areas were announced
        std::shared_ptr<const ViewportAssignment> front; // of the front, where it has its own surface
    };
    struct Window {
        bool destroyed = false;         // freed when no stream has it current
        bool lean = false;              // the framebuffer has the region's size
        bool widens = true;             // to the window's size on demand; false after a failure
        wire::WindowConfig config{};    // with the channel bits of `surface`
        uint8_t wishedRed = 0;          // red bits of the program's window; equal on all nodes
        ContextState* drawer = nullptr; // the context that was last current with it for drawing; null: destroyed
        bool isFlat = false; // the program's window has no depth and no stencil buffer; this node's surface may
        std::unique_ptr<gl::Surface> surface;
        // the front buffer, created on first use where surfaces have one colour buffer
        std::unique_ptr<gl::Surface> front;
        bool frontStale = false;             // its colours must be copied from `surface`
        gl::Surface* deep = nullptr;         // the surface with the valid depth and stencil; null: `surface`
        std::unique_ptr<gl::Context> filler; // draws depth and stencil if the program's context cannot
        PixelViewport whole;                 // 0, 0, width, height
        PixelViewport part;                  // this node's, by the areas or the grid
        PixelViewport region;                // `part` as it is drawn; empty while another node has the turn
        // pixels inside the scissor: the region, or the driver's bins that contain it (raster_bins.hpp)
        PixelViewport drawn;
        int64_t frames = 0; // number of frames begun, and below of turns begun (features/time_multiplex.cpp)
        int64_t turn = 0;
        bool turnOver = false;       // the frame is complete; the next drawing command begins another
        bool undecided = false;      // the frame has only cleared, and may begin the next node's turn
        bool fresh = false;          // the frame has begun the next node's turn
        int64_t dependentFrames = 0; // consecutive frames that built on their predecessor
        GLbitfield cleared = 0;      // buffers that were cleared whole since the frame began
        bool plain = true;           // drawn without the kernel of this pass; its pixels are selected at the end
        bool copied = true;          // pixels were read or copied, or selected texture levels: the next frame is plain
        int levelChecks = 0;    // draws of this frame that were checked for texture levels (features/whole_windows.cpp)
        bool requested = false; // pixels or bytes were requested in this frame
        // draws the whole window: a copy must find this pass's own pixels, and other tiles deliver another pass's
        bool drawsAll = true;
        bool filled = true; // the frame had copies: the next one draws the whole window
        RangeFrame range;
        MovingPart moving;
        bool keepsPicture = false; // one node has the turn permanently
        bool sceneElsewhere =
            false; // this frame draws its scene into a framebuffer object (features/stereo_scenes.cpp)
        bool sceneWasElsewhere = false; // the previous frame drew its scene into a framebuffer object
        bool begun = false;             // something was drawn since the last swap
        ReadbackChoice readback;
        bool skipped = false;             // its frames are not drawn (features/frame_skip.cpp)
        GLbitfield stale = 0;             // buffers with wrong content after skipped frames
        bool frontStaled = false;         // the front buffer is stale as well
        bool invalid = false;             // this frame depends on stale buffers
        std::vector<int16_t> accumulated; // values of `drawn`, rows bottom first; empty: none yet
    };
    struct ProgramInfo {
        std::unordered_map<GLint, GLint> locations; // from the program's to this node's, only where they differ
    };
    struct ListItem {
        GLuint native = 0;
        uint32_t vertices = 0;                     // approximate number that the native list draws
        bool plain = true;                         // changes no state that decides whether draws may be shared
        std::vector<std::byte> record;             // a command that the node executes itself; empty: native
        std::vector<std::vector<std::byte>> blobs; // blobs of the record
    };
    struct List {
        std::vector<ListItem> items;
    };
    struct DealtHandle {         // names of this node
        GLuint texture, sampler; // sampler: the program's, or 0
        GLuint made;             // an equal sampler that was created to obtain the handle, or 0
    };
    struct Shared { // state that contexts share
        NameTable tables[static_cast<int>(Kind::Count)];
        std::unordered_map<uint64_t, GLsync> syncs;
        std::unordered_map<GLuint, ProgramInfo> programs; // by the program's name
        std::unordered_map<GLuint, List> lists;
        NameTable framebuffersOfAll;
        // by this node's shader name: contains a module that reads gl_FragCoord
        std::unordered_map<GLuint, bool> placedModules;
        bool listsContainBitmaps = false;              // at least one list contains a bitmap
        bool texturesHaveLevels = false;               // at least one texture has (features/whole_windows.cpp)
        bool testsDepth = false, testsStencil = false; // some command or list has enabled the test
        // every node draws everything: the program's side requested it, or a module reads gl_FragCoord
        bool allDrawn = false;
        ProgramRewriter tiled;
        ProgramSourcesStore recipes;
        HandleTable handles;
        std::unordered_map<uint64_t, DealtHandle> dealt;            // by the program's texture handle
        bool handlesFreed = false;                                  // some texture with a handle was deleted
        std::unordered_map<GLuint, ProjectionDetector> projections; // by the program's name (features/stereo_view.cpp)
        // by this node's program name: numbers primitives, so draws are not cut into pieces
        std::unordered_map<GLuint, bool> primitiveIds;
        // by the program's name, after its first use (features/draw_skipping.cpp)
        std::unordered_map<GLuint, bool> memoryWriters;
        ProjectionDetector projection;        // the last one found in any buffer
        std::shared_ptr<AsyncReadback> later; // null: unavailable, or not requested yet
        bool asyncTried = false;              // creation was tried once
    };
    struct Scissor {
        bool enabled = false;
        PixelViewport box;
    };
    static constexpr int kViewports = 16;
    // The program's masks. Alpha of a window that hides its own is never written.
    struct ColorMasks {
        std::array<std::array<GLboolean, 4>, 8> buffers;
        bool differ = false; // indexed commands were used
        ColorMasks() { buffers.fill({GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE}); }
    };
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
    struct ClientState {
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
        std::shared_ptr<Shared> shared;
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
        List building;
        std::vector<SavedAttributes> attributes;
        std::vector<ClientState> clientAttributes;
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
        bool projectionKnown = false; // fixedProjection is current, for shaders that may read it
        ProjectionDetector fixedProjection;
        std::array<GLfloat, 16> onProjection{}, shiftedProjection{};
    };
    struct Stream {
        ContextState* context = nullptr;
        Window* draw = nullptr;
        Window* read = nullptr;
        std::deque<std::vector<std::byte>> blobs;
        uint64_t blobMissing = 0; // bytes of the last blob that have not arrived
        uint64_t blobBytes = 0;   // size of all blobs when complete
    };
    struct Client {
        std::map<uint32_t, std::unique_ptr<ContextState>> contexts;
        std::map<uint32_t, std::unique_ptr<Window>> windows;
        std::map<uint32_t, Stream> streams;
        std::unordered_map<uint64_t, std::unique_ptr<gl::Image>> images; // by the program's handle
        bool anyDestroyed = false;
    };

    std::span<const std::byte> takeBlob(bool& found) override;

    // replay.cpp
    bool record(std::span<const std::byte> bytes);
    bool execute(uint16_t opcode, std::span<const std::byte> arguments, BlobQueue& blobs);
    void compileSplit(std::span<const std::byte> bytes);
    void nextNativeList(const std::function<void()>& between);
    void offsetObjectNames();
    bool planted(uint16_t opcode);
    bool makeStreamCurrent(uint32_t stream);
    bool bindStream(Stream& s);
    void loadFunctions();
    NameTable& table(Kind kind);
    void runList(GLuint list);
    void runItem(const ListItem& item);
    GLuint generate(Kind kind);
    bool splitsLists(uint16_t opcode, std::span<const std::byte> arguments) const;
    void onPrimitive(uint16_t opcode, std::span<const std::byte> arguments);
    bool compileSplitting(uint16_t opcode, std::span<const std::byte> bytes, std::span<const std::byte> arguments);
    // control_records.cpp
    bool own(uint16_t opcode, Args& in);
    [[nodiscard]] gl::SurfaceConfig surfaceConfig(const wire::WindowConfig& c, int width, int height) const;
    bool onBlobBegin(Args& in);
    bool onCreateContext(Args& in);
    bool onMakeCurrent(Args& in);
    bool onWindow(Args& in);
    void takeBitsOfSurface(Window& w);
    bool onClientArrays(Args& in);
    bool onProgramLayout(Args& in);
    bool onBufferBytes(Args& in);
    bool onlyCopiesWrite(GLenum target);
    void copyIntoBuffer(GLenum target, uint64_t offset, std::span<const std::byte> bytes);
    bool onFillWindow(Args& in);
    void setArrayPointer(const client_arrays::ArrayRecord& a, const std::byte* first);
    // context/swaps.cpp
    void waitUntilDrawn();
    [[nodiscard]] ContextState* contextFor(const Client& client, const Window& w) const;
    [[nodiscard]] bool mustBindForSwap(const Window& w, uint32_t frame, bool front) const;
    bool onSwap(Args& in, bool front);
    void swapUnbound(Window& w, ContextState& drawer, uint32_t id, uint32_t frame, bool front);
    void showWindow(Window* window, uint32_t id, uint32_t frame, bool front);
    // readback/query_replies.cpp
    bool onRequestPixels(Args& in);
    bool onRequestTexImage(Args& in);
    void readTexels(bool byName, GLuint which, GLint level, GLenum format, GLenum type);
    void readBlocks(bool byName, GLuint which, GLint level);
    bool onRequestBuffer(Args& in);
    void readBuffer(GLuint nodeName, uint64_t offset);
    void answerBytes(uint32_t request, wire::ReplyKind kind, std::span<const std::byte> bytes);
    enum class Beyond : uint8_t { Black, Nothing }; // pixels outside the framebuffer: returned as black, or impossible
    [[nodiscard]] bool isAnswering();
    const std::byte* readRegion(const PixelViewport& r, GLenum format, GLenum type, size_t bytes,
                                Beyond beyond = Beyond::Black);
    const std::byte* readShown(Window& w, const PixelViewport& r, bool front);
    [[nodiscard]] bool resolves(const Window& w) const;
    const std::byte* readResolved(const PixelViewport& r, GLenum format, const ColourWords& words);
    [[nodiscard]] PictureFormat pictureFormatOf(const ContextState& reader, const Window& w) const; // of readShown()
    void packTightly(bool tight);
    void withPlainTransfer(const std::function<void()>& call);
    void withoutReadClamp(const std::function<void()>& call);
    void fillColor(const PixelViewport& r, const void* rgba, const ColourWords& words = kByteWords);
    // readback/frame_readback.cpp
    [[nodiscard]] bool hasFences(const ContextState& c) const;
    std::shared_ptr<AsyncReadback> laterReads();
    [[nodiscard]] bool readsLater(const Window& w, const PixelViewport& region);
    std::unique_ptr<PictureRead> readAtOnce(const ReplayOutputs::Frame& f, const PixelViewport& r);
    std::unique_ptr<PictureRead> readLater(Window& w, const PixelViewport& r, bool front);
    AsyncReadback* into_ = nullptr; // destination of readRegion(); null: pixels_
    std::shared_ptr<PictureMemory> memory_ = std::make_shared<PictureMemory>();
    // readback/window_fill.cpp
    const GLfloat* depthAsFloats(const Window& w, const PixelViewport& r, const void* pixels);
    std::vector<GLfloat> depths_;
    gl::Context* fillerOf(Window& w);
    void fillByOtherContext(const PixelViewport& r, GLbitfield plane, const void* pixels,
                            GLenum colourType = GL_UNSIGNED_BYTE);
    // context/egl_images.cpp
    bool onCreateImage(Args& in);
    bool onDestroyImage(Args& in);
    void withImage(uint64_t image, const std::function<void(GLeglImageOES)>& call);
    // context/bindless_handles.cpp
    void dealtHandle(HandleTable::Of of, uint64_t appHandle, uint64_t nodeHandle);
    void requestTextureHandle(GLuint texture, GLuint sampler, uint64_t appHandle);
    uint64_t equalHandle(GLuint texture, GLuint sampler, uint64_t wanted, GLuint& made);
    void handlesGone(Kind kind, GLuint nodeName);
    GLuint samplerLike(GLuint texture, GLuint sampler);
    void settleDriver();
    void flushIfRequested(Window& w);
    [[nodiscard]] HandleTable::Of handlesOfUniform(GLuint program, GLint location) const;
    [[nodiscard]] std::vector<GLuint64> handleValues(GLuint program, GLint location, const GLuint64* values,
                                                     GLsizei count) const;
    // context/sparse_pages.cpp
    struct PageBox {
        GLint level, x, y, z;
        GLsizei width, height, depth;
    };
    void commitPages(GLenum target, GLuint texture, const PageBox& box, bool commits,
                     const std::function<void(const PageBox&)>& call);
    [[nodiscard]] bool isError();
    bool enlargeToPages(GLenum target, GLuint texture, PageBox& box);
    void commitBuffer(uint64_t offset, uint64_t sizeBytes, bool commits, const std::function<uint64_t()>& bufferBytes,
                      const std::function<void(uint64_t, uint64_t)>& call);
    bool pagesReported_ = false;
    // context/driver_messages.cpp
    void listenToDriver();
    static void APIENTRY onDriverMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                         const GLchar* text, const void* inbox);
    void sendDriverMessages();
    void sendDriverEvent(wire::DriverEventKind kind, const DebugInbox::Message& message);
    bool takeErrors();
    bool errorReported();
    void reportDriverProblems();
    bool executeAllocating(ReplayFunction function, Args& in);
    // context/release.cpp
    bool onDestroyContext(Args& in);
    bool onDestroyWindow(Args& in);
    void unbindPlatform();
    void freeDestroyed(Client& client);
    // readback/query_objects.cpp
    void withQueriesSuspended(const std::function<void()>& call);
    void beginPiece(GLenum target, GLuint query);
    bool onRequestQuery(Args& in);
    void answerQuery(uint32_t request, GLuint query);
    void sendPrefetched();
    bool onBeginConditional(Args& in);
    bool onQueryKnown(Args& in);
    bool onDrawAll(Args& in);
    void beginConditional(bool draws);
    void queryDriver(GLuint nodeName, GLenum mode);
    [[nodiscard]] bool isReplicatedDraw() const;
    void splitQueries();
    void dropPieces(QueryInfo& query);
    uint64_t queryResult(GLuint nodeName);
    uint64_t readQuery(GLuint nodeName);
    // features/dynamic_tiles.cpp
    [[nodiscard]] bool moves() const { return areas_ != nullptr; }
    [[nodiscard]] bool isLearningAreas(const Window& w) const { return moves() && !knowsAreas_ && !w.skipped; }
    [[nodiscard]] PixelViewport partOf(const Window& w, const ViewportAssignment* areas) const;
    void onArea(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] GLbitfield clearedBy(uint16_t opcode, std::span<const std::byte> arguments) const;
    [[nodiscard]] GLbitfield drawnBy(uint16_t opcode) const;
    void onNativeList();
    void onTests(GLenum cap);
    void takeAreas(Window& w);
    void redivide(Window& w);
    void areasChanged();
    [[nodiscard]] bool drawsOldFront() const;
    [[nodiscard]] PixelViewport regionOf(const Window& w, bool front) const;
    [[nodiscard]] bool readsFront() const;
    // context/line_widening.cpp
    void onModules(GLuint nodeName);
    [[nodiscard]] bool alone() const { // this node's part is the whole picture
        if (config_.area || moves()) return !moves() && config_.area->full() && !takesTurns();
        return config_.region.columns == config_.grid.columns && config_.region.rows == config_.grid.rows &&
               !takesTurns();
    }
    [[nodiscard]] bool allDrawn() const { return c_->shared && c_->shared->allDrawn; }
    void widenToWindow(Window& w);
    void copyTile(const Window& w, gl::Surface& from);
    // features/time_multiplex.cpp
    [[nodiscard]] bool takesTurns() const { return config_.pass.period > 1; }
    [[nodiscard]] bool isLearningTurns(const Window& w) const;
    void turnsChanged();
    void placePart(Window& w);
    [[nodiscard]] bool drawsWholeBins(const Window& w) const;
    void partChanged(Window& w);
    void onTurn(uint16_t opcode, std::span<const std::byte> arguments);
    void onTurnOfList();
    void beginTurn(Window& w);
    void decideTurn(Window& w, bool builds);
    void keepTurn(Window& w);
    [[nodiscard]] bool hasTurn(int64_t turn) const;
    [[nodiscard]] bool keepsTurn(const Window& w) const;
    [[nodiscard]] GLbitfield clearsOf(uint16_t opcode, std::span<const std::byte> arguments) const;
    void turnDrawn(Window& w, bool shownInFront);
    [[nodiscard]] GLbitfield clearsWhole(GLbitfield mask) const;
    [[nodiscard]] GLbitfield needsCleared() const;
    // features/frame_skip.cpp
    [[nodiscard]] bool maySkip() const;
    void onSkipped(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] bool isValid(const Window& w, bool front) const;
    [[nodiscard]] bool mayRead(const Window& w, bool deep) const;
    // features/pixel_compound.cpp
    [[nodiscard]] bool hasKernel() const { return config_.pass.kernelWidth * config_.pass.kernelHeight > 1; }
    // True if the pass does not draw exactly the pixels of this node's part of the window.
    [[nodiscard]] bool drawsOtherPixels() const {
        return hasKernel() || !config_.pass.zoom.none() || !config_.pass.shown.none();
    }
    // True if the pixels that other tiles deliver for copies belong to another pass: the answering one.
    [[nodiscard]] bool copiesOthers() const { return !config_.answers && !drawsOtherPixels() && !takesRanges(); }
    [[nodiscard]] bool interleaves(const Window* w) const { return drawsOtherPixels() && w && !w->plain; }
    [[nodiscard]] PixelViewport partDrawn(const Window& w) const;
    [[nodiscard]] bool movesPicture() const { return config_.pass.samples > 1 || drawsOtherPixels(); }
    const std::byte* readScaled(Window& w, const PixelViewport& r, bool front);
    [[nodiscard]] PixelViewport surfaceOf(const Window& w, bool lean) const;
    const std::byte* readEveryNth(Window& w, const PixelViewport& r, bool front);
    const std::byte* readRepeated(const PixelViewport& part, GLenum format, GLenum type, size_t group);
    [[nodiscard]] bool movesByShaders() const;
    [[nodiscard]] bool movesView() const { return config_.pass.eye != Eye::Cyclop || config_.screen; }
    [[nodiscard]] double eyeOffset() const { return (config_.pass.eye == Eye::Left ? -0.5 : 0.5) * config_.eyeBase; }
    [[nodiscard]] RenderPass passOfDraws() const;
    void applyMovedViewports();
    std::array<GLfloat, 20> moveOf(GLuint program) const;
    // features/whole_windows.cpp
    void onWholeWindow(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] bool choosesOwnLevels() const;
    // features/stereo_scenes.cpp
    [[nodiscard]] bool isSeen() const;
    [[nodiscard]] bool drawsScene() const;
    bool hasDepthAttached();
    void onScene();
    // features/draw_skipping.cpp
    bool mayWriteMemory(GLuint program);
    bool shouldSkipDraw(uint16_t opcode);
    [[nodiscard]] bool stipplesLines() const;
    void swapDrawEntryPoints();
    // features/stereo_view.cpp
    void onEye(uint16_t opcode, std::span<const std::byte> arguments);
    void onEyeAfter(uint16_t opcode);
    void onProjections(std::span<const std::byte> bytes);
    void onFixedProjection();
    [[nodiscard]] ProjectionDetector projectionOf(GLuint program) const;
    [[nodiscard]] ClipTransform viewMove(const ProjectionDetector& seen) const;
    void onMatrices(GLuint program, const Data& values, GLsizei count, bool transposed, bool doubles);
    [[nodiscard]] bool hasFixedMatrices() const;
    [[nodiscard]] bool drawsFixed() const;
    void shiftProjection();
    void unshiftProjection();
    // features/sort_last.cpp
    [[nodiscard]] bool takesRanges() const { return config_.pass.ranges > 1; }
    [[nodiscard]] bool collects() const { return config_.pass.range == 0; }
    std::span<const std::byte> onRange(uint16_t opcode, std::span<const std::byte> arguments);
    std::span<const std::byte> onRangeDraw(Window& w, uint16_t opcode, std::span<const std::byte> arguments);
    void onRangeState(uint16_t opcode, std::span<const std::byte> arguments);
    void onCompiled(uint16_t opcode, std::span<const std::byte> arguments);
    bool onRangeList(const ListItem& item);
    void notePrimitiveIds(GLuint nodeName);
    [[nodiscard]] bool mayShare();
    bool shares(Window& w, uint64_t cost, uint64_t& first, uint64_t& last);
    void beginSplit(Window& w);
    void drawRest(Window& w);
    void mute(Window& w, bool muted);
    void composeRanges(Window& w);
    void composeBound();
    void rangeDrawn(Window& w);
    int depthBitsOfWindow();
    void readPart(Window& w, const PixelViewport& box, PicturePart& part);
    void writePart(const PicturePart& part, const PixelViewport& area);
    std::vector<std::byte> sliced_; // arguments of a draw, reduced to this node's piece
    // front_buffer.cpp
    [[nodiscard]] bool hasTwoSurfaces(const Window* w) const;
    gl::Surface* surfaceOf(Window* w, GLenum buffer);
    bool bindSurfaces(gl::PendingCommands pendingCommands = gl::PendingCommands::Flushed);
    void drawBufferOfWindow(GLenum buffer);
    void readBufferOfWindow(GLenum buffer);
    void buffersChanged(GLenum drawnBefore);
    void backToFront(Window& w);
    void beginFront(Window& w);
    void clearToBlack(gl::Surface& current);
    void showBack(Window& w);
    void copySurface(gl::Surface& from, gl::Surface& to, GLbitfield planes);
    void depthForReading();
    void dropFront(Window& w);
    // features/bitmap_flush.cpp
    void onBitmaps(uint16_t opcode);
    static bool leavesBitmaps(uint16_t opcode);
    void settleBitmaps();
    // context/color_masks.cpp
    [[nodiscard]] bool hidesAlpha() const;
    void applyColorMasks();
    void makeOpaque();
    bool alphaHides_ = false;  // some window hides its alpha
    std::string reportedBits_; // last logged difference between a window here and the program's
    // features/accumulation_buffer.cpp
    // x, y, z, width and height, in window coordinates.
    void drawTexture(const std::array<GLfloat, 5>& rectangle);
    bool accumulatesHere();
    void forAccumulatedRows(const std::function<void(int16_t*, const PixelViewport&)>& call);
    [[nodiscard]] PixelViewport accumulatedBox() const;
    void accumulateColours(GLfloat value, bool add);
    void returnAccumulated(GLfloat value);
    bool accumulationReported_ = false;
    // programs/program_binaries.cpp
    bool onRequestProgram(Args& in);
    bool onProgramRecipe(Args& in);
    void linkFrom(GLuint nodeName, ProgramSources recipe);
    // programs/programs.cpp
    void compileShader(GLuint nodeName);
    void linkProgram(GLuint nodeName);
    [[nodiscard]] ShaderRewrites rewrites() const;
    [[nodiscard]] bool esContext() const { return c_->api != wire::Api::Desktop; }
    void applyTileValues();
    void widen(GLfloat pixels);
    // readback/copy_gather.cpp
    void gatherForCopy(const PixelViewport& r, GLbitfield plane, const void* pixels, const ColourWords& words);
    void gatherDepthStencil(Gathered& g, GLbitfield plane, const void* pixels);
    void forgetGathered();
    void fromWindow(const PixelViewport& source, const std::function<void(GLint, GLint)>& call);
    // context/tile_clipping.cpp
    [[nodiscard]] PixelViewport origin() const; // of this node's framebuffer in the window (lean)
    [[nodiscard]] bool drawsLean() const { return c_->draw ? c_->draw->lean : config_.lean; }
    [[nodiscard]] bool readsLean() const { return c_->read && c_->read->lean; }
    void applyScissors();
    bool tileOff_ = false; // withoutTile() is running
    void applyScissor(int index, bool all);
    void applyViewports();
    void restoreWindowState();
    [[nodiscard]] bool drawsWindow() const { return c_->drawFramebuffer == 0; }
    // context/framebuffers.cpp
    [[nodiscard]] GLenum bufferOfEye(GLenum buffer, const Window* w) const;
    [[nodiscard]] GLenum readBufferOfEye(GLenum buffer, const Window* w) const;
    void drawBuffers(bool ofWindow, GLsizei n, const Data& bufs, const std::function<void(const GLenum*)>& call);
    [[nodiscard]] static GLenum onlyBuffer(const gl::Surface& surface);
    [[nodiscard]] GLenum windowBuffer(GLenum buffer, const Window* w) const;
    void bindFramebuffer(GLenum target, GLuint framebuffer, void (*bind)(GLenum, GLuint));
    void deleteFramebuffers(GLsizei n, const Data& framebuffers, void (*remove)(GLsizei, const GLuint*));
    // context/pixel_store.cpp
    void setUnpack(bool tight);
    void pixelStore(GLenum pname, GLint value);
    void arrayPointer(uint64_t pointer, const std::function<void(const void*)>& call); // object_commands.cpp

    std::unique_ptr<gl::Platform> platform_;
    ReplayConfig config_;
    ReplayOutputs out_;
    ReplayCounts counts_;
    std::map<uint32_t, Client> clients_;
    bool loaded_ = false;
    // The current stream and its context.
    uint32_t stream_ = 0;
    Stream* s_ = nullptr;
    ContextState* c_ = nullptr;
    ContextState* bound_ = nullptr; // the context that is current on the platform
    Window* boundDraw_ = nullptr;
    Window* boundRead_ = nullptr;
    gl::Surface* drawSurface_ = nullptr; // of boundDraw_ and boundRead_, while bound_ is set
    gl::Surface* readSurface_ = nullptr;
    std::vector<std::vector<std::byte>> taken_; // blobs of the record being replayed
    std::vector<std::vector<GLuint>> scratch_;  // translated names of the record being replayed
    size_t scratchUsed_ = 0;
    std::vector<std::byte> pixels_;
    std::vector<bool> lackingReported_;
    int listDepth_ = 0;         // nested display lists in execution
    uint32_t listCommands_ = 0; // executed since the outermost list began
    bool hasSkipped_ = false;   // began by skipping frames
    bool skips_ = false;        // still skips frames
    bool knowsTurns_ = true;
    Range share_;               // this node's part of a frame's draws
    uint32_t sharesNumber_ = 0; // number of the Shares with that part
    Range plantedShare_;        // for a planted fault
    bool knowsCosts_ = true;    // has the costs of earlier frames, as the other nodes of its picture have
    // callbacks of returned nodes of its picture that no composition includes yet
    std::deque<std::function<void()>> returns_;
    uint64_t returnsTaken_ = 0; // number of returns before those
    [[nodiscard]] uint64_t returnsSeen() const { return returnsTaken_ + returns_.size(); }
    std::shared_ptr<const ViewportAssignment>
        areas_; // current for new windows, wanted by the others; null: areas never change
    bool knowsAreas_ = true;
    bool showedInvalid_ = false;           // a frame was drawn from its beginning, and still depended on skipped ones
    std::unique_ptr<GlFunctions> leftOut_; // functions without effect, for skipped draws; null: not created yet
    std::unique_ptr<ContextState> none_;   // context of streams without one
};

} // namespace mural
