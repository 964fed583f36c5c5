// Replays capture streams on this node's GL. One thread; all contexts of all programs.
//
// The generated replay calls GL for most commands; what the tiling changes, or what names this
// node's objects in another way, is written by hand (replay_*.cpp).
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

#include "common/picture_format.hpp"
#include "common/pixel_viewport.hpp"
#include "common/tile_grid.hpp"
#include "common/viewport.hpp"
#include "gl_functions.hpp"
#include "nodes/exchange/part_fold.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/pictures/picture_read.hpp"
#include "nodes/replay/colour_words.hpp"
#include "nodes/replay/handle_table.hpp"
#include "nodes/replay/name_table.hpp"
#include "nodes/replay/program_recipes.hpp"
#include "nodes/replay/readback_choice.hpp"
#include "nodes/replay/replay_dispatch.hpp"
#include "nodes/replay/seen_projection.hpp"
#include "nodes/replay/tiled_programs.hpp"
#include "nodes/replay/tiling.hpp"
#include "nodes/replay/view_move.hpp"
#include "nodes/session/areas.hpp"
#include "nodes/session/readback.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/shares.hpp"
#include "streamcodec/args.hpp"
#include "streamcodec/client_arrays.hpp"
#include "streamcodec/sizes/pixel_format.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

class LaterReads;

// What a stream may make the node hold or do at once; far above what programs need.
struct ReplayLimits {
    uint64_t blobBytes = uint64_t{4} << 30;    // waiting in one stream
    uint64_t answerBytes = uint64_t{2} << 30;  // one answer
    uint32_t listCommands = 1u << 24;          // run by one call of a display list: nesting multiplies
};

// What a node is told about its part of every picture.
struct ReplayConfig {
    int node = 0;
    TileGrid grid;
    TileRegion region;
    std::optional<Viewport> area; // instead of tiles
    std::optional<Areas> areas;   // instead of that: others follow, by moveAreas()
    RenderPass pass;
    bool answers = true;   // questions about pictures; false: nodes of another pass do
    double eyeBase = 0.05, focusDistance = 1; // in the program's units
    std::optional<ScreenView> screen;         // then the eye is in it
    bool skips = false;    // frames are not drawn until drawAgain()
    bool catchesUp = false; // whose turn it is, others know: until takeTurns() or beginTurns() all frames are drawn and none is its own;
                            // draws are not shared before shareAnew()
    bool cull = false;     // whole primitives outside of the region are dropped by rewritten shaders
    bool lean = false;     // framebuffers of the tile's size; false: of the picture's size (exact)
    bool rastersInBins = false; // the driver draws in software, so a region has to end on its bins (raster_bins.hpp)
    Readback readback = Readback::Direct; // of Frame::read
    bool deepPictures = false; // allows Bgr10A2 in Frame::format
    std::string plant;     // MURAL_PLANT: a fault on purpose, for tests of the tests
    ReplayLimits limits;
};

// What the replay hands out; called on the replay thread.
struct ReplayOutputs {
    // Part of an answer; `last` closes this node's part.
    std::function<void(const wire::AnswerHeader&, std::span<const std::byte>)> answer;
    // A frame of the window is complete. `pixels` reads the given rectangle (window coordinates),
    // rows bottom first, tightly packed; only valid during the call.
    struct Frame {
        uint32_t client, window, frame;
        wire::WindowConfig config;
        PixelViewport region; // this node's part of the picture
        PictureFormat format; // of `pixels` and `read`
        PixelViewport picture; // all of it: the window's size, or every nth pixel of it
        bool drawnWhole;      // nothing is cut to the part (Shared::allDrawn)
        bool keepsPicture;    // frames build on the one before: one node goes on drawing them
        bool sound;           // it does not depend on what was not drawn (ReplayConfig::skips)
        bool notSplit;        // nothing was shared between ranges, though there are several
        uint32_t areas;       // number of those by which the picture is divided
        uint32_t shares;      // number of those by which its draws were shared; 0: those of the start, or nothing was
        bool keepsAreas;      // other ones wait for a clear that does not come
        std::function<const std::byte*(const PixelViewport&)> pixels;
        // The same of `region`, once, to be taken by another thread, which may have to wait until it is drawn. Set where `pixels` is. Null: nothing to be had.
        std::function<std::unique_ptr<PictureRead>()> read;
    };
    std::function<void(const Frame&)> frameDone;
    // What is asked of a window depends on what was not drawn.
    std::function<void()> unsound;
    std::function<void(uint32_t client, uint32_t window)> windowGone; // the program has destroyed it
    std::function<void(const std::string&)> log;
    // Nodes that draw ranges of one picture (replay_range.cpp): puts together what all have drawn. Afterwards the collector's
    // part is the whole picture; returns the area of it that may have changed.
    std::function<PixelViewport(PicturePart&, const FoldRule&)> composeParts;
    // What this node's GL tells of a program's context.
    std::function<void(const wire::News&, const std::string& text)> news;
};

struct ReplayCounts {
    uint64_t commands = 0, malformed = 0, lacking = 0, glErrors = 0, frames = 0, bytes = 0;
};

class Replay : private BlobQueue {
public:
    Replay(std::unique_ptr<gl::Platform> platform, ReplayConfig config, ReplayOutputs outputs);
    ~Replay() override;

    // The payload of one packet. False: the stream is broken beyond this packet (the reason is logged).
    bool packet(uint32_t stream, std::span<const std::byte> payload);
    void clientGone(uint32_t client);
    // Windows are drawn from their next frames on.
    void drawAgain();
    // Of nodes that take turns: what decides whose it is, of all windows.
    [[nodiscard]] std::vector<wire::WindowTurn> turns() const;
    // It is as another node has said of this place of the stream.
    void takeTurns(std::span<const wire::WindowTurn> turns);
    // Nobody knows: the frames in hand stay with those whose turn is first, and all nodes count anew.
    void beginTurns();
    // Of nodes that draw ranges of one picture, at one place of the stream for all of them: a node has come back, `itself`: this one. `returned`
    // is called behind the last picture that is put together without it, when there is a first with it.
    void shareAnew(bool itself, std::function<void()> returned);
    // From the next draws of each window on that are the first to be shared in their frame.
    void moveShares(const Shares& shares);
    // From the next full clear of each window on its part is the one of these areas (replay_areas.cpp). Where the config has areas.
    void moveAreas(Areas areas);
    // The payload of a Turns message, by which areas windows are divided here…
    [[nodiscard]] std::vector<std::byte> tellAreas() const;
    // …and were where another node has told it. False: it is none.
    bool takeToldAreas(std::span<const std::byte> bytes);
    // Nobody knows: windows are divided by the latest.
    void beginAreas();
    // Whether what is shown next depends on what was not drawn before that.
    [[nodiscard]] wire::Soundness soundness() const;
    [[nodiscard]] const ReplayCounts& counts() const { return counts_; }

    // ---- what the generated code uses
    GlFunctions gl{};
    GLuint name(Kind kind, GLuint app);
    const GLuint* names(Kind kind, const GLuint* app, int64_t count);
    void make(Kind kind, int64_t count, const GLuint* app, const std::function<void(GLuint*)>& call);
    void bindName(Kind kind, GLuint app, GLuint ours);
    void forget(Kind kind, const GLuint* app, int64_t count);
    GLint uniformLocation(GLint location);
    GLint uniformLocation(GLuint program, GLint location);
    // Sets the unpack state that fits where the image is. False: an offset, and no buffer bound.
    void clientStatePushed(GLbitfield mask);
    void clientStateDefault(GLbitfield mask);
    bool unpackFor(const Data& data);
    // False: nothing there, or an offset while no buffer is bound at `binding`: GL would read wild memory.
    bool readable(const Data& data, GLenum binding);
    bool indicesFit(const Data& indices);
    bool lacking(uint16_t opcode);
    // Runs `call` with the program's own scissor alone.
    void withoutTile(const std::function<void()>& call);
    // Runs a copy out of the read framebuffer; the call gets where to read.
    void copyLevel(GLint x, GLint y, GLsizei w, GLsizei h, const std::function<void(GLint, GLint)>& call);
    template <class T> T windowX(T x) const { return moved(x, origin().x); }
    template <class T> T windowY(T y) const { return moved(y, origin().y); }
    // v: `count` values, 2 to 4, as they lie in the record (doubles at multiples of 4 bytes).
    template <class T> std::array<T, 4> windowPosition(const T* v, int count) const {
        std::array<T, 4> position{};
        std::memcpy(position.data(), v, static_cast<size_t>(count) * sizeof(T));
        position[0] = windowX(position[0]);
        position[1] = windowY(position[1]);
        return position;
    }
    // Coordinates may be any number: the difference wraps around instead of being undefined.
    template <class T> static T moved(T value, int32_t by) {
        if constexpr (std::is_integral_v<T>) return static_cast<T>(int64_t{value} - by);
        else return static_cast<T>(value - static_cast<T>(by));
    }

#include "replay_custom.inc"

private:
    struct ContextState;
    // How far a frame of a window is that nodes share by ranges.
    struct RangeFrame {
        enum class Phase : uint8_t {
            Fresh, // nothing is drawn
            Split, // each node has drawn its range
            Whole  // put together: the collector draws the rest
        } phase = Phase::Fresh;
        GLbitfield cleared = 0; // whole buffers, since the frame began
        uint64_t cost = 0;      // of all draws so far, vertices…
        uint64_t lastTotal = 0; // …and in the frame before; 0: nothing is known
        uint64_t serial = 0;    // exchanges of this window
        GLenum function = 0;    // of all draws that were shared
        bool muted = false;     // another node draws this
        bool wasSplit = false;
        Range share;            // of lastTotal: this node's…
        uint32_t shares = 0;    // …by the Shares of this number
        uint32_t drawnBy = 0;   // and those of the frame before
        uint64_t returns = 0;   // of nodes of its picture, before the frame began: it is put together with these
        FoldRule rule;          // how the nodes' pictures are laid over each other
    };
    // Which part of a window this node draws, where that may change.
    struct MovingPart {
        std::shared_ptr<const Areas> areas;  // that are drawn
        std::shared_ptr<const Areas> wanted; // that shall be
        GLbitfield drawn = 0; // buffers of which this node has its part alone; the others are on all nodes as on a single machine
        bool fixed = false;   // for good
        int64_t waits = 0;    // frames since others were wanted
        std::shared_ptr<const Areas> front; // of the front, where that is a surface of its own
    };
    struct Window {
        bool destroyed = false; // freed when it is current nowhere
        bool lean = false;      // the framebuffer has the region's size
        bool widens = true;     // to the window's size, when that is needed; not when that has failed
        wire::WindowConfig config{}; // channel bits are those of `surface`
        uint8_t wishedRed = 0;       // red bits of the program's window; equal on all nodes
        ContextState* drawer = nullptr; // the context that was last current with it for drawing; null: destroyed
        bool isFlat = false;    // the program's window has neither depth nor stencil buffer, whatever this node's surface has
        std::unique_ptr<gl::Surface> surface;
        std::unique_ptr<gl::Surface> front;  // where surfaces have one colour buffer: the front, once it is used
        bool frontStale = false;             // its colours have to come from `surface`
        gl::Surface* deep = nullptr;         // the one of both whose depth and stencil count
        std::unique_ptr<gl::Context> filler; // draws depth and stencil where the program's context can't
        PixelViewport whole;  // 0, 0, width, height
        PixelViewport part;   // this node's, by the grid
        PixelViewport region; // the same, or nothing while it is another node's turn
        PixelViewport drawn;  // what the scissor lets through: the region, or the driver's bins that hold it (raster_bins.hpp)
        int64_t frames = 0;        // that have begun, and turns that have (replay_turns.cpp)
        int64_t turn = 0;
        bool turnOver = false;     // the frame is complete: the next command that draws begins another
        bool undecided = false;    // it has only cleared: the next node's turn may begin…
        bool fresh = false;        // …and has, with this frame
        int64_t kept = 0;          // frames in a row that have built on the one before
        GLbitfield cleared = 0;    // whole buffers, since the frame began
        bool plain = true;         // drawn without the kernel of this pass: its pixels are picked at the end…
        bool copied = true;        // …because the frame before read or copied pixels there, or chose levels of textures by them
        int askedOfLevels = 0;     // draws of this frame that were (replay_whole_windows.cpp)
        bool asked = false;        // for pixels, in this frame
        bool drawsAll = true;      // tiles or not: a copy shall find this pass's own pixels; those that are brought are another's
        bool filled = true;        // …because the frame before had copies
        RangeFrame range;
        MovingPart moving;
        bool keepsPicture = false; // the turn never ends
        bool sceneElsewhere = false;    // in this frame a scene is drawn into a framebuffer object (replay_scenes.cpp)
        bool sceneWasElsewhere = false; // …in the frame before
        bool begun = false;        // something was drawn since the last swap
        ReadbackChoice readback;
        bool skipped = false;      // its frames are not drawn (replay_catch_up.cpp), and so…
        GLbitfield stale = 0;      // …these buffers do not hold what they should…
        bool frontStaled = false;  // …nor does its front…
        bool unsound = false;      // …and this frame depends on that
        std::vector<int16_t> accumulated; // of `drawn`, rows bottom first; empty: nothing yet
    };
    struct ProgramInfo {
        std::unordered_map<GLint, GLint> locations; // the program's → ours, only where they differ
    };
    struct ListItem {
        GLuint native = 0;
        uint32_t vertices = 0; // that the native list draws, about
        bool plain = true;     // it changes nothing that decides whether draws may be shared
        std::vector<std::byte> record; // of a command that the node executes itself; empty: native
        std::vector<std::vector<std::byte>> blobs; // that the record takes
    };
    struct List {
        std::vector<ListItem> items;
    };
    struct DealtHandle { // our names
        GLuint texture, sampler; // sampler: the program's, or 0
        GLuint made;             // one like it, by which the handle was asked for, or 0
    };
    struct Shared { // what contexts share
        NameTable tables[static_cast<int>(Kind::Count)];
        std::unordered_map<uint64_t, GLsync> syncs;
        std::unordered_map<GLuint, ProgramInfo> programs; // by the program's name
        std::unordered_map<GLuint, List> lists;
        NameTable framebuffersOfAll;
        std::unordered_map<GLuint, bool> placedModules; // by our shader's name: it holds a module that reads gl_FragCoord
        bool listsHoldBitmaps = false; // one of them at least
        bool texturesHaveLevels = false; // some of them (replay_whole_windows.cpp)
        bool testsDepth = false, testsStencil = false; // some command or list has switched that on
        bool allDrawn = false; // by every node: the program's side has asked for it, or a module reads gl_FragCoord
        TiledPrograms tiled;
        ProgramRecipes recipes;
        HandleTable handles;
        std::unordered_map<uint64_t, DealtHandle> dealt; // by the program's handle of a texture
        bool handlesFreed = false; // some texture with a handle was deleted
        std::unordered_map<GLuint, SeenProjection> projections; // by the program's name (replay_eyes.cpp)
        std::unordered_map<GLuint, bool> primitiveIds;  // our programs that number primitives: not cut into pieces
        std::unordered_map<GLuint, bool> memoryWriters; // by the program's name, once it was used (replay_left_out.cpp)
        SeenProjection projection;                      // the last one in any buffer
        std::shared_ptr<LaterReads> later; // null: there are none, or…
        bool laterAsked = false;           // …it was not asked for them
    };
    struct Scissor {
        bool enabled = false;
        PixelViewport box;
    };
    static constexpr int kViewports = 16;
    // Of the program; alpha of a window that hides its own is never written.
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
        std::array<GLint, 8> values{}; // in the order of kUnpackNames; alignment is made 4
        bool tight = false;            // what GL has now
    };
    struct ClientState {
        GLbitfield mask;
        PixelUnpack unpack;
        std::array<GLint, 8> pack;
        GLuint arrayBuffer, packBuffer, unpackBuffer;
    };
    // A query is counted in pieces: what every node draws whole is counted once, the rest tile by tile.
    struct QueryPiece {
        GLuint ours;
        bool whole;
    };
    struct QueryInfo {
        GLenum target = 0;
        std::vector<QueryPiece> pieces; // the first is the program's own query
        bool skipped = false;           // a frame was not drawn while it counted
        bool passed = true;             // as the program has told: of the whole picture
    };
    // Pixels of the window that a copy will read, put together from all nodes (lean, and windows with samples).
    struct Gathered {
        PixelViewport box; // empty: nothing waits
        GLuint framebuffer = 0, color = 0, depthStencil = 0;
        std::vector<uint32_t> depth; // until the stencil has come
    };
    struct AskedAhead { // answered at the next swap
        uint32_t request;
        GLuint query;
    };
    // Messages of the driver, which may come from threads of its own.
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
        DebugInbox debug;    // outlives the context
        bool debugs = false;  // the program has asked for a debug context
        bool listens = false; // the driver's messages go there
        bool lost = false;    // the driver has reset it
        bool heldBack = false; // not flushed when the program gives it up
        uint32_t errorsTold = 0; // to the program, by its own GL
        std::unordered_map<GLuint, QueryInfo> queries; // by the program's name
        std::vector<AskedAhead> askedAhead;
        std::map<GLenum, GLuint> counting;             // fragments now: the program's query by its target
        bool countsWhole = false;                      // what drawsWhole() was when the last piece began
        bool countedWhole = false;                     // a query that only whole pictures answer is active
        bool conditional = false, conditionMet = false;
        GLuint condition = 0;                          // our name of the query that decides, and how
        GLenum conditionMode = 0;
        GLuint queryBuffer = 0;                        // our name: results would go there
        GLuint nothingCounted = 0;                     // a query whose result is 0
        uint32_t client = 0, id = 0;
        bool destroyed = false; // freed when it is current nowhere
        std::unique_ptr<gl::Context> context;
        gl::ContextConfig wish; // by which it was made
        std::shared_ptr<Shared> shared;
        NameTable own[static_cast<int>(Kind::Count)];
        wire::Api api = wire::Api::Desktop;
        int version = 0;
        bool core = false;
        Window* draw = nullptr;
        Window* read = nullptr;
        bool everCurrent = false;
        GLuint drawFramebuffer = 0, readFramebuffer = 0; // the program's names
        GLuint arrayBuffer = 0, packBuffer = 0, unpackBuffer = 0; // our names
        GLuint program = 0;                              // the program's name
        std::array<Scissor, kViewports> scissors;
        bool scissorsDiffer = false;                     // indexed commands were used
        std::array<std::array<GLfloat, 4>, kViewports> viewports{};
        bool viewportsDiffer = false;
        ColorMasks colorMasks;
        GLenum drawBuffer0 = 0, readBuffer0 = 0;         // of the default framebuffer, the program's names
        PixelUnpack unpack;
        std::array<GLint, 8> pack{};
        bool gathersBitmaps = false;                     // the driver may hold some back (replay_bitmaps.cpp)
        bool packsBlocks = false;                        // the program has said what compressed blocks are when packed
        GLuint listBase = 0;
        GLuint compiling = 0;                            // name of the list, 0: none
        GLenum compileMode = 0;
        bool compilesPrimitive = false;                  // between glBegin and glEnd
        List building;
        std::vector<SavedAttributes> attributes;
        std::vector<ClientState> clientAttributes;
        std::vector<std::vector<std::byte>> arrayMemory; // spans of client arrays
        GLuint fillFramebuffer = 0;
        Gathered gathered;
        GLfloat cullMargin = 16;   // pixels; only grows: lists and stacks may bring wide lines back
        bool lineStippled = false; // ever: a dropped piece of a strip would shift the pattern
        bool clippingCounted = false; // a query counts what clipping gets or gives
        bool arbPositions = false; // an ARB program reads the window's offset
        bool pipelineBound = false;
        std::set<GLenum> openQueries; // that count anything
        bool feedsBack = false;       // transform feedback may be active
        // Of what is drawn into now, as the last draw has found it (replay_scenes.cpp).
        bool attachmentsKnown = false, depthAttached = false, sceneSized = false, depthTested = false;
        // Fixed function, seen by another eye: GL's projection is not the program's (replay_eyes.cpp).
        bool projectionShifted = false;
        // Ranges: whether draws may be shared, as long as no state changes (replay_range.cpp).
        bool rangeKnown = false, mayShare = false;
        bool writesMemory = false; // storage or images were bound: vertex shaders may write there
        bool rangeFeedsBack = false; // transform feedback
        int activeQueries = 0;
        bool inPrimitive = false;
        bool projectionKnown = false; // as it is, for shaders that may read it
        SeenProjection fixedProjection;
        std::array<GLfloat, 16> ownProjection{}, shiftedProjection{};
    };
    struct Stream {
        ContextState* context = nullptr;
        Window* draw = nullptr;
        Window* read = nullptr;
        std::deque<std::vector<std::byte>> blobs;
        uint64_t blobMissing = 0; // bytes of the last blob that have not come
        uint64_t blobBytes = 0;   // of all blobs, when complete
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
    void spendNames();
    bool planted(uint16_t opcode);
    bool makeStreamCurrent(uint32_t stream);
    bool bindStream(Stream& s);
    void loadFunctions();
    NameTable& table(Kind kind);
    void runList(GLuint list);
    void runItem(const ListItem& item);
    GLuint generate(Kind kind);
    bool splitsLists(uint16_t opcode, std::span<const std::byte> arguments) const;
    void notePrimitive(uint16_t opcode, std::span<const std::byte> arguments);
    bool compileSplitting(uint16_t opcode, std::span<const std::byte> bytes, std::span<const std::byte> arguments);
    // replay_own.cpp
    bool own(uint16_t opcode, Args& in);
    [[nodiscard]] gl::SurfaceConfig surfaceConfig(const wire::WindowConfig& c, int width, int height) const;
    bool ownBlobBegin(Args& in);
    bool ownCreateContext(Args& in);
    bool ownMakeCurrent(Args& in);
    bool ownWindow(Args& in);
    void takeBitsOfSurface(Window& w);
    bool ownClientArrays(Args& in);
    bool ownProgramLayout(Args& in);
    bool ownBufferBytes(Args& in);
    bool onlyCopiesWrite(GLenum target);
    void copyIntoBuffer(GLenum target, uint64_t offset, std::span<const std::byte> bytes);
    bool ownFillWindow(Args& in);
    void setArrayPointer(const client_arrays::ArrayRecord& a, const std::byte* first);
    // replay_swaps.cpp
    void waitUntilDrawn();
    [[nodiscard]] ContextState* contextFor(const Client& client, const Window& w) const;
    [[nodiscard]] bool mustBindForSwap(const Window& w, uint32_t frame, bool front) const;
    bool ownSwap(Args& in, bool front);
    void swapUnbound(Window& w, ContextState& drawer, uint32_t id, uint32_t frame, bool front);
    void showWindow(Window* window, uint32_t id, uint32_t frame, bool front);
    // replay_reads.cpp
    bool ownRequestPixels(Args& in);
    bool ownRequestTexImage(Args& in);
    void readTexels(bool byName, GLuint which, GLint level, GLenum format, GLenum type);
    void readBlocks(bool byName, GLuint which, GLint level);
    bool ownRequestBuffer(Args& in);
    void readBuffer(GLuint ours, uint64_t offset);
    void answerBytes(uint32_t request, wire::AnswerKind kind, std::span<const std::byte> bytes);
    enum class Beyond : uint8_t { Black, Nothing }; // what may lie there that is read
    [[nodiscard]] bool isAnswering();
    const std::byte* readRegion(const PixelViewport& r, GLenum format, GLenum type, size_t bytes, Beyond beyond = Beyond::Black);
    const std::byte* readShown(Window& w, const PixelViewport& r, bool front);
    [[nodiscard]] bool resolves(const Window& w) const;
    const std::byte* readResolved(const PixelViewport& r, GLenum format, const ColourWords& words);
    [[nodiscard]] PictureFormat pictureFormatOf(const Window& w) const; // of readShown()
    void packTightly(bool tight);
    void withPlainTransfer(const std::function<void()>& call);
    void withoutReadClamp(const std::function<void()>& call);
    void fillColor(const PixelViewport& r, const void* rgba, const ColourWords& words = kByteWords);
    // replay_pictures.cpp
    [[nodiscard]] bool hasFences(const ContextState& c) const;
    std::shared_ptr<LaterReads> laterReads();
    [[nodiscard]] bool readsLater(const Window& w, const PixelViewport& region);
    std::unique_ptr<PictureRead> readAtOnce(const ReplayOutputs::Frame& f, const PixelViewport& r);
    std::unique_ptr<PictureRead> readLater(Window& w, const PixelViewport& r, bool front);
    LaterReads* into_ = nullptr; // readRegion goes there
    std::shared_ptr<PictureMemory> memory_ = std::make_shared<PictureMemory>();
    // replay_fill.cpp
    const GLfloat* depthAsFloats(const Window& w, const PixelViewport& r, const void* pixels);
    std::vector<GLfloat> depths_;
    gl::Context* fillerOf(Window& w);
    void fillByOtherContext(const PixelViewport& r, GLbitfield plane, const void* pixels, GLenum colourType = GL_UNSIGNED_BYTE);
    // replay_images.cpp
    bool ownCreateImage(Args& in);
    bool ownDestroyImage(Args& in);
    void withImage(uint64_t image, const std::function<void(GLeglImageOES)>& call);
    // replay_handles.cpp
    void dealtHandle(HandleTable::Of of, uint64_t theirs, uint64_t ours);
    void askTextureHandle(GLuint texture, GLuint sampler, uint64_t theirs);
    uint64_t equalHandle(GLuint texture, GLuint sampler, uint64_t wanted, GLuint& made);
    void handlesGone(Kind kind, GLuint ours);
    GLuint samplerLike(GLuint texture, GLuint sampler);
    void settleDriver();
    void flushIfAsked(Window& w);
    [[nodiscard]] HandleTable::Of handlesOfUniform(GLuint program, GLint location) const;
    [[nodiscard]] std::vector<GLuint64> handleValues(GLuint program, GLint location, const GLuint64* values, GLsizei count) const;
    // replay_sparse.cpp
    struct PageBox {
        GLint level, x, y, z;
        GLsizei width, height, depth;
    };
    void commitPages(GLenum target, GLuint texture, const PageBox& box, bool commits, const std::function<void(const PageBox&)>& call);
    [[nodiscard]] bool isError();
    bool enlargeToPages(GLenum target, GLuint texture, PageBox& box);
    void commitBuffer(uint64_t offset, uint64_t sizeBytes, bool commits, const std::function<uint64_t()>& bufferBytes, const std::function<void(uint64_t, uint64_t)>& call);
    bool saidPages_ = false;
    // replay_news.cpp
    void listenToDriver();
    static void APIENTRY hearDriver(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* text, const void* inbox);
    void tellMessages();
    void tell(wire::NewsKind kind, const DebugInbox::Message& message);
    bool takeErrors();
    bool errorTold();
    void tellTroubles();
    bool executeAllocating(ReplayFunction function, Args& in);
    // replay_release.cpp
    bool ownDestroyContext(Args& in);
    bool ownDestroyWindow(Args& in);
    void unbindPlatform();
    void freeDestroyed(Client& client);
    // replay_queries.cpp
    void aside(const std::function<void()>& call);
    void beginPiece(GLenum target, GLuint query);
    bool ownRequestQuery(Args& in);
    void answerQuery(uint32_t request, GLuint query);
    void answerAskedAhead();
    bool ownBeginConditional(Args& in);
    bool ownQueryKnown(Args& in);
    bool ownDrawAll(Args& in);
    void beginConditional(bool draws);
    void askDriver(GLuint ours, GLenum mode);
    [[nodiscard]] bool drawsWhole() const;
    void cutQueries();
    void dropPieces(QueryInfo& query);
    uint64_t queryResult(GLuint ours);
    uint64_t readQuery(GLuint ours);
    // replay_areas.cpp
    [[nodiscard]] bool moves() const { return areas_ != nullptr; }
    [[nodiscard]] bool learnsAreas(const Window& w) const { return moves() && !knowsAreas_ && !w.skipped; }
    [[nodiscard]] PixelViewport partOf(const Window& w, const Areas* areas) const;
    void noteArea(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] GLbitfield clearedBy(uint16_t opcode, std::span<const std::byte> arguments) const;
    [[nodiscard]] GLbitfield drawnBy(uint16_t opcode) const;
    void noteNativeList();
    void noteTests(GLenum cap);
    void takeAreas(Window& w);
    void divideAnew(Window& w);
    void areasChanged();
    [[nodiscard]] bool drawsOldFront() const;
    [[nodiscard]] PixelViewport regionOf(const Window& w, bool front) const;
    [[nodiscard]] bool readsFront() const;
    // replay_widening.cpp
    void noteModules(GLuint ours);
    [[nodiscard]] bool alone() const { // this node's part is the whole picture
        if (config_.area || moves()) return !moves() && config_.area->full() && !takesTurns();
        return config_.region.columns == config_.grid.columns && config_.region.rows == config_.grid.rows && !takesTurns();
    }
    [[nodiscard]] bool allDrawn() const { return c_->shared && c_->shared->allDrawn; }
    void widenToWindow(Window& w);
    void copyTile(const Window& w, gl::Surface& from);
    // replay_turns.cpp
    [[nodiscard]] bool takesTurns() const { return config_.pass.period > 1; }
    [[nodiscard]] bool learnsTurns(const Window& w) const;
    void turnsChanged();
    void placePart(Window& w);
    [[nodiscard]] bool drawsWholeBins(const Window& w) const;
    void partChanged(Window& w);
    void noteTurn(uint16_t opcode, std::span<const std::byte> arguments);
    void noteTurnOfList();
    void beginTurn(Window& w);
    void decideTurn(Window& w, bool builds);
    void keepTurn(Window& w);
    [[nodiscard]] bool hasTurn(int64_t turn) const;
    [[nodiscard]] bool keepsTurn(const Window& w) const;
    [[nodiscard]] GLbitfield clearsOf(uint16_t opcode, std::span<const std::byte> arguments) const;
    void turnDrawn(Window& w, bool shownInFront);
    [[nodiscard]] GLbitfield clearsWhole(GLbitfield mask) const;
    [[nodiscard]] GLbitfield needsCleared() const;
    // replay_catch_up.cpp
    [[nodiscard]] bool maySkip() const;
    void noteSkipped(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] bool isSound(const Window& w, bool front) const;
    [[nodiscard]] bool mayRead(const Window& w, bool deep) const;
    // replay_passes.cpp
    [[nodiscard]] bool hasKernel() const { return config_.pass.kernelWidth * config_.pass.kernelHeight > 1; }
    [[nodiscard]] bool drawsOtherPixels() const { return hasKernel() || !config_.pass.zoom.none() || !config_.pass.shown.none(); } // than its part of the window has
    // Pixels that are brought from other tiles, for copies, are those of the pass that answers.
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
    // replay_whole_windows.cpp
    void noteWholeWindow(uint16_t opcode, std::span<const std::byte> arguments);
    [[nodiscard]] bool choosesOwnLevels() const;
    // replay_scenes.cpp
    [[nodiscard]] bool isSeen() const;
    [[nodiscard]] bool drawsScene() const;
    bool hasDepthAttached();
    void noteScene();
    // replay_left_out.cpp
    bool mayWriteMemory(GLuint program);
    bool leavesOut(uint16_t opcode);
    [[nodiscard]] bool stipplesLines() const;
    void exchangeDraws();
    // replay_eyes.cpp
    void noteEye(uint16_t opcode, std::span<const std::byte> arguments);
    void noteEyeAfter(uint16_t opcode);
    void noteProjections(std::span<const std::byte> bytes);
    void noteFixedProjection();
    [[nodiscard]] SeenProjection projectionOf(GLuint program) const;
    [[nodiscard]] ViewMove viewMove(const SeenProjection& seen) const;
    void noteMatrices(GLuint program, const Data& values, GLsizei count, bool transposed, bool doubles);
    [[nodiscard]] bool hasFixedMatrices() const;
    [[nodiscard]] bool drawsFixed() const;
    void shiftProjection();
    void unshiftProjection();
    // replay_range.cpp
    [[nodiscard]] bool takesRanges() const { return config_.pass.ranges > 1; }
    [[nodiscard]] bool collects() const { return config_.pass.range == 0; }
    std::span<const std::byte> noteRange(uint16_t opcode, std::span<const std::byte> arguments);
    std::span<const std::byte> noteRangeDraw(Window& w, uint16_t opcode, std::span<const std::byte> arguments);
    void noteRangeState(uint16_t opcode, std::span<const std::byte> arguments);
    void noteCompiled(uint16_t opcode, std::span<const std::byte> arguments);
    bool noteRangeList(const ListItem& item);
    void notePrimitiveIds(GLuint ours);
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
    std::vector<std::byte> sliced_; // arguments of a draw of which this node draws a piece
    // replay_front.cpp
    [[nodiscard]] bool hasTwoSurfaces(const Window* w) const;
    gl::Surface* surfaceOf(Window* w, GLenum buffer);
    bool bindSurfaces(gl::HeldBack heldBack = gl::HeldBack::Flushed);
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
    // replay_bitmaps.cpp
    void noteBitmaps(uint16_t opcode);
    static bool leavesBitmaps(uint16_t opcode);
    void settleBitmaps();
    // replay_color_masks.cpp
    [[nodiscard]] bool hidesAlpha() const;
    void applyColorMasks();
    void makeOpaque();
    bool alphaHides_ = false; // in any window
    std::string toldBits_;    // what windows here have instead of what was asked for
    // replay_accum.cpp
    // x, y, z, width and height, in window coordinates.
    void drawTexture(const std::array<GLfloat, 5>& rectangle);
    bool accumulatesHere();
    void forAccumulatedRows(const std::function<void(int16_t*, const PixelViewport&)>& call);
    [[nodiscard]] PixelViewport accumulatedBox() const;
    void accumulateColours(GLfloat value, bool add);
    void returnAccumulated(GLfloat value);
    bool saidAccumulation_ = false;
    // replay_binaries.cpp
    bool ownRequestProgram(Args& in);
    bool ownProgramRecipe(Args& in);
    void linkFrom(GLuint ours, ProgramRecipe recipe);
    // replay_programs.cpp
    void compileShader(GLuint ours);
    void linkProgram(GLuint ours);
    [[nodiscard]] ShaderRewrites rewrites() const;
    [[nodiscard]] bool esContext() const { return c_->api != wire::Api::Desktop; }
    void applyTileValues();
    void widen(GLfloat pixels);
    // replay_copies.cpp
    void gatherForCopy(const PixelViewport& r, GLbitfield plane, const void* pixels, const ColourWords& words);
    void gatherDepthStencil(Gathered& g, GLbitfield plane, const void* pixels);
    void forgetGathered();
    void fromWindow(const PixelViewport& source, const std::function<void(GLint, GLint)>& call);
    // replay_tiling.cpp
    [[nodiscard]] PixelViewport origin() const; // of this node's framebuffer in the window (lean)
    [[nodiscard]] bool drawsLean() const { return c_->draw ? c_->draw->lean : config_.lean; }
    [[nodiscard]] bool readsLean() const { return c_->read && c_->read->lean; }
    void applyScissors();
    bool tileOff_ = false; // withoutTile is running
    void applyScissor(int index, bool all);
    void applyViewports();
    void restoreWindowState();
    [[nodiscard]] bool drawsWindow() const { return c_->drawFramebuffer == 0; }
    // replay_framebuffers.cpp
    [[nodiscard]] GLenum bufferOfEye(GLenum buffer, const Window* w) const;
    [[nodiscard]] GLenum readBufferOfEye(GLenum buffer, const Window* w) const;
    void drawBuffers(bool ofWindow, GLsizei n, const Data& bufs, const std::function<void(const GLenum*)>& call);
    [[nodiscard]] static GLenum onlyBuffer(const gl::Surface& surface);
    [[nodiscard]] GLenum windowBuffer(GLenum buffer, const Window* w) const;
    void bindFramebuffer(GLenum target, GLuint framebuffer, void (*bind)(GLenum, GLuint));
    void deleteFramebuffers(GLsizei n, const Data& framebuffers, void (*remove)(GLsizei, const GLuint*));
    // replay_pixel_store.cpp
    void setUnpack(bool tight);
    void pixelStore(GLenum pname, GLint value);
    void arrayPointer(uint64_t pointer, const std::function<void(const void*)>& call); // replay_objects.cpp

    std::unique_ptr<gl::Platform> platform_;
    ReplayConfig config_;
    ReplayOutputs out_;
    ReplayCounts counts_;
    std::map<uint32_t, Client> clients_;
    bool loaded_ = false;
    // what is current now
    uint32_t stream_ = 0;
    Stream* s_ = nullptr;
    ContextState* c_ = nullptr;
    ContextState* bound_ = nullptr; // what the platform has current
    Window* boundDraw_ = nullptr;
    Window* boundRead_ = nullptr;
    gl::Surface* drawSurface_ = nullptr; // of boundDraw_ and boundRead_, while bound_ is set
    gl::Surface* readSurface_ = nullptr;
    std::vector<std::vector<std::byte>> taken_; // blobs of the record being replayed
    std::vector<std::vector<GLuint>> scratch_;  // translated names of the record being replayed
    size_t scratchUsed_ = 0;
    std::vector<std::byte> pixels_;
    std::vector<bool> saidLacking_;
    int listDepth_ = 0;         // display lists that are being run
    uint32_t listCommands_ = 0; // run since the outermost one began
    bool hasSkipped_ = false; // frames, at the beginning…
    bool skips_ = false;      // …and does so still
    bool knowsTurns_ = true;
    Range share_;              // of a frame's draws: this node's…
    uint32_t sharesNumber_ = 0; // …by the Shares of this number
    Range plantedShare_;        // of a fault on purpose
    bool knowsCosts_ = true; // of the frames before, as the other nodes of its picture do
    std::deque<std::function<void()>> returns_; // of nodes of its picture, that no frame was put together with yet…
    uint64_t returnsTaken_ = 0;                 // …and how many came before those
    [[nodiscard]] uint64_t returnsTold() const { return returnsTaken_ + returns_.size(); }
    std::shared_ptr<const Areas> areas_; // of new windows, and wanted of the others; null: they do not move
    bool knowsAreas_ = true;
    bool showedUnsound_ = false; // a frame that was drawn from its beginning, and needed more than that
    std::unique_ptr<GlFunctions> leftOut_; // for draws that are left out; null: none was yet
    std::unique_ptr<ContextState> none_; // stands in where a stream has no context
};

} // namespace mural
