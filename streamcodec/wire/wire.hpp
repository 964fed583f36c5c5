// The stream from the head to the render nodes, and the messages back. Little-endian, 4-byte aligned.
// Grammar and versions: docs/reference/wire-format.md.
//
//   stream  = Packet*; after a Setup with `economy`: batches of packets (streamcodec/delta/batch_head.hpp)
//   Packet  = PacketHeader payload[sizeBytes]
//   payload of a packet of a capture stream = Record*
//   Record  = u32 header (low 16 bits opcode, high 16 bits length in 4-byte words, header included;
//             0xffff: the next u32 is the length in words), arguments
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::wire {

constexpr uint32_t kMagic = 0x4d52534d; // "MSRM"
constexpr uint32_t kVersion = 4;      // of packets and records, also in traces
constexpr uint32_t kBatchVersion = 10; // of batches (streamcodec/delta/), head commands and messages, between head and nodes only

// Identifier of a capture stream: a client (a process of the program) and one of its threads.
// streamOf(0, 0) is the head's own stream, whose packets hold one HeadCommand each.
constexpr uint32_t streamOf(uint32_t client, uint32_t thread) { return client << 16 | thread; }
constexpr uint32_t clientOf(uint32_t stream) { return stream >> 16; }

struct PacketHeader {
    uint32_t sizeBytes; // of the payload
    uint32_t stream;
};
constexpr uint32_t kMaxPacketBytes = 1u << 20;
// Maximum size of a batch of delta-coded packets (streamcodec/delta/), without its head.
constexpr uint32_t kMaxBatchBytes = 4u << 20;

// First word of a packet of the head's own stream.
enum class HeadCommand : uint32_t {
    Setup = 1,        // json: tiles, regions, outputs, backend, rewriting mode (nodes/render/setup.hpp)
    ClientGone = 2,   // u32 client: frees its contexts and windows
    Finish = 3,       // the last packet: the node replies Bye and exits
    // json: {"pictures", "swaps"}: HOST:PORT of each node that composites pictures, or leads a swap barrier, by its number.
    Exchange = 4,
    // u32 view, u32 node, u32 first, u32 life, u32 absent*: the restarted node, which has received everything before,
    // is a member from here on. All members reply InView.
    //   first    1: no other member has phases; the phases restart
    //   life     incarnation of the node
    //   absent   nodes that are no members; the node's picture is composited without them
    Member = 5,
    // u32 number, u32 draws: to a node in resync, which replies Synchronized. draws = 1: it draws each window from its
    // next frame on.
    Synchronize = 6,
    ResetDictionary = 7,   // the dictionary is cleared: later batches refer to nothing earlier
    // u32 number: members with phases, or with areas that move, reply Turns for a node whose resync begins here.
    RequestPhase = 8,
    Turns = 9,        // contents of a member's Turns message: to a node in resync, after all packets before that RequestPhase
    JoinMulticast = 10,   // u32 node: joins the multicast group of its Setup; packets continue on its own connection
    // SwitchToMulticastCommand: the last packet, or batch, on the node's own connection. The group carries it too, and carries all
    // later ones alone.
    SwitchToMulticast = 11,
    // u32 number, u32 nodes, {f64 x, y, w, h} of each: the areas of the picture that nodes draw, from the next full clear
    // of each window on.
    ViewportAssignment = 12,
    // u32 number, u32 nodes, {f64 start, end} of each: the ranges of a frame's draws that nodes draw, from the next shared
    // draws of each window on.
    RangeAssignment = 13,
};
struct SwitchToMulticastCommand {
    uint32_t node;
    uint32_t skipLow, skipHigh; // bytes that the group carried between the join and this packet, or batch
};

// Node → head.
enum class NodeMessage : uint32_t {
    Ready = 1,          // json: host, pid, renderer, glVersion, extensions, threads
    Answer = 2,         // AnswerHeader + bytes
    FrameDone = 3,      // FrameDoneMessage
    Picture = 4,        // PictureHeader + rows, if the picture store is not shared memory
    Log = 5,            // text: one line for the user
    Bye = 6,            // json: totals (commands, GL errors, replay time)
    WindowGone = 7,     // WindowGoneMessage: the program has destroyed the window, or ended; after its last FrameDone
    Alive = 8,          // no contents: heartbeat every few seconds, also while the replay is busy
    DriverEvent = 9,           // News + text: a driver event
    InView = 10,        // u32 view, ClientFrame*: later messages were sent after this Member
    Synchronized = 11,  // SynchronizedMessage: the node has reached that Synchronize
    // u32 number of the RequestPhase, then the state of all windows there: WindowTurn*, or, of nodes whose areas move,
    // u32 windows, WindowAreas of each, Areas*: the latest first, then all that the windows refer to.
    Turns = 12,
    PackedPicture = 13, // PictureHeader + the rows as encoded by PicturePacker
};

struct MessageHeader {
    uint32_t type; // NodeMessage
    uint32_t sizeBytes;
};

// Part of the reply to request `requestId` (kOpRequest…).
struct AnswerHeader {
    uint32_t client;
    uint32_t requestId;
    uint32_t kind;       // AnswerKind
    uint32_t groupBytes; // bytes per pixel (rectangles)
    int32_t x, y, w, h;  // the part of the requested rectangle that follows (rectangles)
    uint32_t first;      // 1: the bytes are the complete reply: the whole rectangle, or data that is equal on all nodes
    uint32_t last;       // 1: the last part from this node for this request
};
enum class AnswerKind : uint32_t {
    Rectangle = 1, // disjoint parts of a picture, each from the node that drew it
    Bytes = 2,     // equal on all nodes: the bytes of the first living node count
    Sum = 3,       // u64 values, added over nodes
};

// Header of each reply in the client's reply ring (head → program). The bytes follow immediately, and the next header
// follows them without padding. Rectangles: rows of w * groupBytes bytes, tightly packed, lowest row first; pixels that
// no node sent are 0.
struct ReplyHeader {
    uint32_t requestId;
    uint32_t kind;       // AnswerKind
    uint64_t sizeBytes;  // of the following bytes
    int32_t x, y, w, h;  // the union of the parts (rectangles)
    uint32_t groupBytes; // bytes per pixel (rectangles)
    uint32_t failed;     // 1: no node replied; sizeBytes is 0
};
static_assert(sizeof(ReplyHeader) == 40);

// Kinds of driver events.
enum class DriverEventKind : uint32_t {
    DebugMessage = 1, // the arguments of glDebugMessageCallback
    OutOfMemory = 2,  // GL_OUT_OF_MEMORY; `type`: number of kOpErrorTold before it
    ContextLost = 3,  // `type`: result of glGetGraphicsResetStatus
};

// A driver event: from node to head, and from there into the program's shared memory (capture::DriverEventSlot).
struct DriverEvent {
    uint32_t client;
    uint32_t context;
    uint32_t kind; // DriverEventKind
    uint32_t source, type, id, severity;
    uint32_t textBytes; // length of the text that follows, without a terminator
};
static_assert(sizeof(DriverEvent) == 32);

// Completion of a frame. A node sends the Picture of a frame, if any, before its FrameDone.
struct FrameDoneMessage {
    uint32_t client;
    uint32_t window;
    uint32_t frame;    // number of the frame of this client, from 1
    uint32_t width;    // of the window, pixels
    uint32_t height;
    uint32_t flags;    // kDrawnWhole, kKeepsPicture, kNotSplit, kKeepsAreas
    uint32_t areas;    // number of the Areas that divide its picture; 0: those of Setup
    uint32_t shares;   // number of the Shares that divide its draws; 0: those of Setup
    uint64_t busyNs;   // work since the previous frame, without waits and sending; CPU time where nodes share cores
    uint64_t replayNs; // CPU time of the replay thread since the previous frame
    uint64_t readbackNs;
    uint64_t calls;    // records of this client since its start, up to this frame
};

// Flags of FrameDoneMessage.
//
// Every node draws everything, because fragment shaders write to memory, or after kOpDrawAll.
constexpr uint32_t kDrawnWhole = 1;
// Frames depend on the previous frame: of nodes with phases, one draws all of them.
constexpr uint32_t kKeepsPicture = 2;
// No draw of the frame was divided between the nodes that draw ranges.
constexpr uint32_t kNotSplit = 4;
// The window has not been cleared completely since Areas were announced long ago.
constexpr uint32_t kKeepsAreas = 8;

// Progress of a program when a node became a member.
struct ClientFrame {
    uint32_t client;
    uint32_t frame; // the last frame before
};

// State of a window in time-multiplex: the node whose turn it is, and the progress of the current frame
// (nodes/replay/features/time_multiplex.cpp).
struct WindowTurn {
    uint32_t client;
    uint32_t window;
    int64_t frames; // number of frames begun
    int64_t turn;
    int64_t kept;      // consecutive frames that depend on their predecessor
    uint32_t cleared;  // buffers cleared completely in this frame
    uint32_t state;    // kTurn…
};
static_assert(sizeof(WindowTurn) == 40);
constexpr uint32_t kTurnOver = 1, kTurnUndecided = 2, kTurnFresh = 4, kTurnForGood = 8;

// Numbers of the Areas that divide a window (nodes/replay/features/dynamic_tiles.cpp).
struct WindowAreas {
    uint32_t client;
    uint32_t window;
    uint32_t areas, wanted, front;
    uint32_t drawn; // buffers of which each node holds only its own part
    uint32_t fixed; // 1: the areas no longer change
};
static_assert(sizeof(WindowAreas) == 28);

struct SynchronizedMessage {
    uint32_t number; // of the Synchronize
    uint32_t sound;  // Soundness
};
// Soundness of the frames of a node that has not drawn everything before.
enum class FrameValidity : uint32_t {
    Open = 0, // no frame of some window has been drawn yet
    Sound = 1,
    Unsound = 2, // frames depend on pixels that were not drawn
};

struct WindowGoneMessage {
    uint32_t client;
    uint32_t window; // kAllWindows: the program has ended, and the node has freed its objects
};
constexpr uint32_t kAllWindows = 0;

struct PictureHeader {
    uint32_t client;
    uint32_t window;
    uint32_t frame;
    int32_t x, y, w, h; // lower left origin, rows bottom first, tightly packed
    uint32_t windowWidth, windowHeight;
    uint32_t nativeLow, nativeHigh; // X window id of WindowConfig; 0: none
    uint32_t format; // PictureFormat (common/base/picture_format.hpp)
};
static_assert(sizeof(PictureHeader) == 48);

// Mural's own opcodes in capture streams, below kFirstGlOpcode. GL commands have the opcodes of
// streamcodec/api/opcodes.lock.
enum Op : uint16_t {
    kOpInvalid = 0,
    kOpBlobBegin = 1,      // u64 sizeBytes: a value too large for a record; queued until its command uses it
    kOpBlobData = 2,       // u32 count, bytes
    kOpCreateContext = 3,  // u32 context, u32 shareContext (0 none), u32 api, u32 versionMajor, minor, u32 profile, u32 flags, u32 surfaceConfig index
    kOpDestroyContext = 4, // u32 context
    kOpMakeCurrent = 5,    // u32 context (0 none), u32 drawWindow, u32 readWindow
    kOpWindow = 6,         // u32 window, WindowConfig: created or resized
    kOpDestroyWindow = 7,  // u32 window
    kOpSwap = 8,           // u32 window, u32 frame
    kOpClientArrays = 9,   // client memory of the following draw (streamcodec/wire/client_arrays.hpp)
    kOpRequestPixels = 10, // u32 request, i32 x y w h, u32 format, u32 type, u32 groupBytes
    kOpRequestTexImage = 11,
    kOpRequestBuffer = 12,
    kOpRequestQuery = 13,
    kOpFillWindow = 14,    // i32 x y w h, u32 planes, bytes: pixels of other tiles; precedes a copy
    kOpProgramLayout = 15, // after a link: u32 program, locations by name
    kOpBufferBytes = 16,   // u32 buffer, u64 offset, bytes: written through a mapping
    kOpFinish = 17,        // u32 request: replied to when all earlier commands are complete
    kOpFrontPicture = 18,  // u32 window, u32 frame: like Swap, for single-buffered windows and front-buffer drawing
    kOpBeginConditional = 19, // u32 draws: glBeginConditionalRender with the known result; 0: nothing is drawn
    kOpQueryKnown = 20,    // u32 query, u32 passed: for conditional rendering in the next called display list
    kOpDrawAll = 21,       // from here on every node draws all of every window
    kOpCreateImage = 22,   // u64 image, u32 context, u32 target, u32 name, i32 level, i32 layer: eglCreateImage of a GL object
    kOpDestroyImage = 23,  // u64 image
    kOpRequestProgram = 24, // u32 request, u32 program: reads the recipe of its linked state
    kOpProgramRecipe = 25,  // u32 program, a reply to kOpRequestProgram: for glProgramBinary; empty: the binary was refused
    kOpErrorTold = 26,      // glGetError has returned an error of the program's own GL
    kOpLastOwn = 63,
};
constexpr uint16_t kFirstGlOpcode = 64;

// Flags in groupBytes of kOpRequestPixels.
//
// The program's pixel transfer (scale, bias, maps) is not applied.
constexpr uint32_t kPlainTransfer = 0x80000000;
// The samples of each pixel are resolved, as in a copy of the window.
constexpr uint32_t kResolved = 0x40000000;
// Flags in planes of kOpFillWindow.
//
// For the next copy only. A window with samples keeps its own.
constexpr uint32_t kForCopy = 0x80000000;
// Colours are words of GL_UNSIGNED_INT_2_10_10_10_REV, or four floats. Default: four bytes.
constexpr uint32_t kTenBits = 0x40000000;
constexpr uint32_t kFloats = 0x20000000;

// Frame number in kOpSwap and kOpFrontPicture of an unseen frame: it is drawn and counted, but no picture is sent and no
// credit is returned.
constexpr uint32_t kUnseenFrame = 0;

// Properties of the program's drawable; the surfaces of the nodes have the same.
struct WindowConfig {
    uint32_t width, height; // pixels
    uint8_t red, green, blue, alpha;
    uint8_t depth, stencil, samples, doubleBuffer;
    uint8_t accum, stereo, srgb, isPbuffer;
    uint32_t nativeLow, nativeHigh; // X window id; 0: none
};
static_assert(sizeof(WindowConfig) == 28);
// In doubleBuffer: the front buffer begins black, and swaps do not change it.
constexpr uint8_t kOwnFront = 2;

// In the flags of kOpCreateContext: the program requests notification of a context loss.
constexpr uint32_t kLosesOnReset = 0x80000000;

enum class Api : uint32_t { Desktop = 0, Es1 = 1, Es2 = 2 }; // Es2: ES 2 and later

} // namespace mural::wire
