// Replays capture streams on this node's GL: all contexts of all programs, on one thread.
//
// The generated replay calls GL for most commands. Commands that tiling changes, or that name this node's objects
// differently, are written by hand: in this folder, context, features, programs and readback.
#pragma once

#include <array>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "common/base/picture_format.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "gl_functions.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/frame_transfer/picture_read.hpp"
#include "nodes/replay/context/context_state.hpp"
#include "nodes/replay/context/share_group.hpp"
#include "nodes/replay/context/window_state.hpp"
#include "nodes/replay/engine/client_state.hpp"
#include "nodes/replay/engine/colour_words.hpp"
#include "nodes/replay/engine/handle_table.hpp"
#include "nodes/replay/engine/name_table.hpp"
#include "nodes/replay/programs/program_sources.hpp"
#include "nodes/replay/engine/replay_dispatch.hpp"
#include "nodes/player/stream_player.hpp"
#include "nodes/replay/features/projection_detection.hpp"
#include "nodes/replay/programs/tiling.hpp"
#include "nodes/replay/features/clip_transform.hpp"
#include "nodes/replay/features/culling.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "nodes/session/render_pass.hpp"
#include "nodes/session/range_assignment.hpp"
#include "streamcodec/wire/args.hpp"
#include "streamcodec/wire/client_arrays.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

class AsyncReadback;

class Replay : public StreamPlayer, private BlobQueue {
public:
    Replay(std::unique_ptr<gl::Platform> platform, PlayerConfig config, PlayerOutputs outputs);
    ~Replay() override;

    bool packet(uint32_t stream, std::span<const std::byte> payload) override;
    void clientGone(uint32_t client) override;
    void drawAgain() override;
    [[nodiscard]] std::vector<wire::WindowTurn> turns() const override;
    void takeTurns(std::span<const wire::WindowTurn> turns) override;
    void beginTurns() override;
    void resetShares(bool itself, std::function<void()> returned) override;
    void moveShares(const RangeAssignment& shares) override;
    void moveAreas(ViewportAssignment areas) override; // at a window's next full clear (features/dynamic_tiles.cpp)
    [[nodiscard]] std::vector<std::byte> memberAreas() const override;
    bool takeMemberAreas(std::span<const std::byte> bytes) override;
    void beginAreas() override;
    [[nodiscard]] wire::FrameValidity validity() const override;
    [[nodiscard]] const PlayerCounts& counts() const override { return counts_; }

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
    using Client = replay::Client;
    using ContextState = replay::ContextState;
    using DisplayList = replay::DisplayList;
    using DisplayListItem = replay::DisplayListItem;
    using QueryInfo = replay::QueryInfo;
    using RangeFrame = replay::RangeFrame;
    using ShareGroup = replay::ShareGroup;
    using Stream = replay::Stream;
    using Window = replay::Window;

    std::span<const std::byte> takeBlob(bool& found) override;

    // engine/replay.cpp
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
    void deleteNativeLists(const DisplayList& list);
    void runItem(const DisplayListItem& item);
    GLuint generate(Kind kind);
    bool splitsLists(uint16_t opcode, std::span<const std::byte> arguments) const;
    void onPrimitive(uint16_t opcode, std::span<const std::byte> arguments);
    bool compileSplitting(uint16_t opcode, std::span<const std::byte> bytes, std::span<const std::byte> arguments);
    // engine/control_records.cpp
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
    [[nodiscard]] bool readsLater(const Window& w, const PixelViewport& region, bool front);
    std::unique_ptr<PictureRead> readAtOnce(const PlayerOutputs::Frame& f, const PixelViewport& r);
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
    void addHandle(HandleTable::Of of, uint64_t appHandle, uint64_t nodeHandle);
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
    void sendDriverEvent(wire::DriverEventKind kind, const replay::DebugInbox::Message& message);
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
    [[nodiscard]] const ViewportAssignment* areasOf(const Window& w, bool front) const {
        return (front && w.front ? w.moving.front : w.moving.areas).get();
    }
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
        return hasKernel() || config_.movesZoom || !config_.pass.zoom.none() || !config_.pass.shown.none();
    }
    // True if frames after reads and copies may differ from others: on this node, or on members of its session.
    [[nodiscard]] bool tracksCopies() const { return drawsOtherPixels() || config_.anyMovesZoom; }
    [[nodiscard]] RenderPass passOf(const Window& w, bool front = false) const;
    // True if the pixels that other tiles deliver for copies belong to another pass: the answering one.
    [[nodiscard]] bool copiesOthers() const { return !config_.answers && !drawsOtherPixels() && !takesRanges(); }
    [[nodiscard]] bool interleaves(const Window* w) const { return drawsOtherPixels() && w && !w->plain; }
    [[nodiscard]] PixelViewport partDrawn(const Window& w, bool front = false) const;
    [[nodiscard]] bool movesPicture() const { return config_.pass.samples > 1 || drawsOtherPixels(); }
    const std::byte* readScaled(Window& w, const PixelViewport& r, bool front);
    [[nodiscard]] PixelViewport surfaceOf(const Window& w, bool lean) const;
    const std::byte* readEveryNth(Window& w, const PixelViewport& r, bool front);
    const std::byte* readRepeated(const PixelViewport& part, bool front, GLenum format, GLenum type, size_t group);
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
    bool onRangeList(const DisplayListItem& item);
    void recordPrimitiveIds(GLuint nodeName);
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
    // features/culling.cpp, culling_boxes.cpp, culling_audit.cpp
#include "nodes/replay/features/culling_members.inc"
    std::unique_ptr<replay::Culling> culling_; // null: off
    // context/front_buffer.cpp
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
    void gatherDepthStencil(replay::Gathered& g, GLbitfield plane, const void* pixels);
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
    void arrayPointer(uint64_t pointer, const std::function<void(const void*)>& call); // engine/object_commands.cpp

    std::unique_ptr<gl::Platform> platform_;
    PlayerConfig config_;
    PlayerOutputs out_;
    PlayerCounts counts_;
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
    uint32_t sharesNumber_ = 0; // number of the RangeAssignment with that part
    Range plantedShare_;        // for a planted fault
    bool knowsCosts_ = true;    // has the costs of earlier frames, as the other nodes of its picture have
    // callbacks of returned nodes of its picture that no composition includes yet
    std::deque<std::function<void()>> returns_;
    uint64_t returnsTaken_ = 0; // number of returns before those
    [[nodiscard]] uint64_t returnsSeen() const { return returnsTaken_ + returns_.size(); }
    std::shared_ptr<const ViewportAssignment> areas_; // the latest; null: areas never change
    bool knowsAreas_ = true;
    bool showedInvalid_ = false; // a frame was drawn from its beginning, and still depended on skipped ones
    std::unique_ptr<GlFunctions>
        ineffectiveDraws_;               // functions without effect, for skipped draws; null: not created yet
    std::unique_ptr<ContextState> none_; // context of streams without one
};

} // namespace mural
