// The stream from the head to the render nodes, and the messages back. Little-endian, 4-byte aligned.
// Grammar and versions: docs/reference/wire-format.md.
//
//   stream  = Packet*, or behind a Setup that says `economy` batches of packets (economy/batch_head.hpp)
//   Packet  = PacketHeader payload[sizeBytes]
//   payload of a packet of a capture stream = Record*
//   Record  = u32 header (low 16 bits opcode, high 16 bits length in 4-byte words, header included;
//             0xffff: the next u32 is the length in words), arguments
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural::wire {

constexpr uint32_t kMagic = 0x4d52534d; // "MSRM"
constexpr uint32_t kVersion = 4;      // of packets and records; recordings have these, too
constexpr uint32_t kBatchVersion = 10; // of batches (economy/), head commands and messages, which only head and nodes exchange

// Which capture stream a packet belongs to: client (app process) and thread of it.
// streamOf(0, 0) is the head's own stream: its payload is one HeadCommand.
constexpr uint32_t streamOf(uint32_t client, uint32_t thread) { return client << 16 | thread; }
constexpr uint32_t clientOf(uint32_t stream) { return stream >> 16; }

struct PacketHeader {
    uint32_t sizeBytes; // of the payload
    uint32_t stream;
};
constexpr uint32_t kMaxPacketBytes = 1u << 20;
// A batch of packets, in which what the node had before is not repeated (economy/): what may follow its head.
constexpr uint32_t kMaxBatchBytes = 4u << 20;

// First word of a packet of the head's own stream.
enum class HeadCommand : uint32_t {
    Setup = 1,      // json: tiles, regions, outputs, backend, rewriting mode (nodes/node/setup.hpp)
    ClientGone = 2, // u32 client: free its contexts
    Finish = 3,     // no more packets: answer Bye and exit
    Exchange = 4,   // json: {"pictures", "swaps"}: by the number of each node that puts pictures together, or leads a swap barrier, HOST:PORT
    Member = 5,     // u32 view, u32 node, u32 first, u32 life, u32 absent*: this node, which was given what came before, draws along from here on;
                    // all answer InView. first = 1: no other member is left that takes turns with it; whose turn it is begins anew. life: how often
                    // it was started again. absent: nodes that are no members; its picture is put together without these
    Synchronize = 6, // u32 number, u32 draws: to a node that catches up; it answers Synchronized, and if it draws, draws windows from their next frames on
    NewHistory = 7, // what was had before is forgotten: batches behind it refer to what comes from here on
    TellTurns = 8, // u32 number: members that take turns, or whose areas move, answer Turns, for a node that begins to catch up here
    Turns = 9,     // as the message has it: to a node that catches up, behind what it was given up to that TellTurns
    JoinGroup = 10, // u32 node: it joins the multicast group of its setup, beside the stream by which this comes
    ByGroup = 11,  // ByGroupCommand: its last packet, or batch, by its own connection. It comes by the group, too, and behind it is what follows
    Areas = 12,    // u32 number, u32 nodes, {f64 x, y, w, h} of each: what they draw of the picture from each window's next full clear on
    Shares = 13,   // u32 number, u32 nodes, {f64 start, end} of each: which part of a frame's draws they draw, from each window's next shared draws on
};
struct ByGroupCommand {
    uint32_t node;
    uint32_t skipLow, skipHigh; // bytes that have come to it by the group before this packet, or batch
};

// Node → head.
enum class NodeMessage : uint32_t {
    Ready = 1,     // json: host, pid, renderer, glVersion, extensions, threads
    Answer = 2,    // AnswerHeader + bytes
    FrameDone = 3, // FrameDoneMessage
    Picture = 4,   // PictureHeader + rows, when the picture store is not shared memory
    Log = 5,       // text: one line for the user
    Bye = 6,       // json: totals (commands, GL errors, replay time)
    WindowGone = 7, // WindowGoneMessage: the program has destroyed it, or has gone; after its last FrameDone
    Alive = 8,     // nothing: every few seconds, also while the replay is at work
    News = 9,      // News + text: what a node's GL tells of a program's context without being asked
    InView = 10,   // u32 view, ClientFrame*: what follows was sent after this Member
    Synchronized = 11, // SynchronizedMessage: it has come to that Synchronize
    Turns = 12,    // u32 number of the TellTurns; of all windows, where it came: WindowTurn*, or of nodes whose areas move
                   // u32 windows, WindowAreas of each, Areas*: the latest first, then all that these name
    PackedPicture = 13, // PictureHeader + what PicturePacker has made of the rows
};

struct MessageHeader {
    uint32_t type; // NodeMessage
    uint32_t sizeBytes;
};

// Part of the answer to Op::Request… of request `requestId`.
struct AnswerHeader {
    uint32_t client;
    uint32_t requestId;
    uint32_t kind;       // AnswerKind
    uint32_t groupBytes; // bytes per pixel (rectangles)
    int32_t x, y, w, h;  // the part of the asked rectangle that follows (rectangles)
    uint32_t first;      // 1: what follows is all that was asked: a whole rectangle; of what all nodes hold alike, this node speaks for all
    uint32_t last;       // 1: nothing more comes from this node for this request
};
enum class AnswerKind : uint32_t {
    Rectangle = 1, // disjoint parts of a picture, each from the node that drew it
    Bytes = 2,     // all nodes hold the same: the first living node's bytes count
    Sum = 3,       // u64 values, added over nodes
};

// In the reply ring of the client, before each answer (head → program). The bytes follow at once; the
// next header begins right after them (no padding). Rectangles: rows of w * groupBytes bytes, tightly
// packed, lowest row first; what no node sent is 0.
struct ReplyHeader {
    uint32_t requestId;
    uint32_t kind;       // AnswerKind
    uint64_t sizeBytes;  // of what follows
    int32_t x, y, w, h;  // the union of the parts (rectangles)
    uint32_t groupBytes; // bytes per pixel (rectangles)
    uint32_t failed;     // 1: no node answered; sizeBytes is 0 then
};
static_assert(sizeof(ReplyHeader) == 40);

enum class NewsKind : uint32_t {
    DebugMessage = 1, // as glDebugMessageCallback has it
    OutOfMemory = 2,  // GL_OUT_OF_MEMORY; how many kOpErrorTold came before stands in `type`
    ContextLost = 3,  // what glGetGraphicsResetStatus says stands in `type`
};

// Node → head, and from there into the program's shared memory (capture::NewsSlot).
struct News {
    uint32_t client;
    uint32_t context;
    uint32_t kind; // NewsKind
    uint32_t source, type, id, severity;
    uint32_t textBytes; // that follow, without an end
};
static_assert(sizeof(News) == 32);

// A node sends the Picture of a frame before its FrameDone: what has no Picture by then has none.
struct FrameDoneMessage {
    uint32_t client;
    uint32_t window;
    uint32_t frame;    // number of the frame of this client, from 1
    uint32_t width;    // of the window, pixels
    uint32_t height;
    uint32_t flags;    // kDrawnWhole, kKeepsPicture, kNotSplit, kKeepsAreas
    uint32_t areas;    // number of the Areas by which its picture is divided; 0: those of the start
    uint32_t shares;   // number of the Shares by which its draws were; 0: those of the start
    uint64_t busyNs;   // that the node was at work, on anything, since the frame before: without waits and sending; CPU time where nodes share cores
    uint64_t replayNs; // CPU time of the replay thread since the frame before
    uint64_t readbackNs;
    uint64_t calls;    // records of this client since its start, up to this frame
};

// Fragment shaders write to memory, or kOpDrawAll came: every node draws all.
constexpr uint32_t kDrawnWhole = 1;
// Frames build on the one before: of nodes that take turns one goes on drawing them.
constexpr uint32_t kKeepsPicture = 2;
// Nothing of the frame was shared between the nodes that draw ranges.
constexpr uint32_t kNotSplit = 4;
// Areas were announced long ago, and the window was never cleared whole since.
constexpr uint32_t kKeepsAreas = 8;

// How far a program was when a node became a member.
struct ClientFrame {
    uint32_t client;
    uint32_t frame; // the last one before
};

// Whose turn a window is, and what of the frame in hand decides that (nodes/replay/replay_turns.cpp).
struct WindowTurn {
    uint32_t client;
    uint32_t window;
    int64_t frames; // that have begun
    int64_t turn;
    int64_t kept;      // frames in a row that have built on the one before
    uint32_t cleared;  // buffers, in this frame, whole
    uint32_t state;    // kTurn…
};
static_assert(sizeof(WindowTurn) == 40);
constexpr uint32_t kTurnOver = 1, kTurnUndecided = 2, kTurnFresh = 4, kTurnForGood = 8;

// By which areas a window is divided (nodes/replay/replay_areas.cpp): their numbers.
struct WindowAreas {
    uint32_t client;
    uint32_t window;
    uint32_t areas, wanted, front;
    uint32_t drawn; // buffers of which each node has its part alone
    uint32_t fixed; // 1: they stay
};
static_assert(sizeof(WindowAreas) == 28);

struct SynchronizedMessage {
    uint32_t number; // of the Synchronize
    uint32_t sound;  // Soundness
};
// Of the frames of a node that has not drawn all that came before.
enum class Soundness : uint32_t {
    Open = 0, // no frame of some window has been drawn yet
    Sound = 1,
    Unsound = 2, // frames depend on what was not drawn
};

struct WindowGoneMessage {
    uint32_t client;
    uint32_t window; // kAllWindows: the program is gone, and the node has freed what was its own
};
constexpr uint32_t kAllWindows = 0;

struct PictureHeader {
    uint32_t client;
    uint32_t window;
    uint32_t frame;
    int32_t x, y, w, h; // lower left origin, rows bottom first, tightly packed
    uint32_t windowWidth, windowHeight;
    uint32_t nativeLow, nativeHigh; // WindowConfig's X window id, 0 when there is none
    uint32_t format; // PictureFormat (common/picture_format.hpp)
};
static_assert(sizeof(PictureHeader) == 48);

// Mural's own opcodes in capture streams: below kFirstGlOpcode; GL commands have theirs from
// streamcodec/registry/opcodes.lock.
enum Op : uint16_t {
    kOpInvalid = 0,
    kOpBlobBegin = 1,      // u64 sizeBytes: a value too large for a record; queued until a command takes it
    kOpBlobData = 2,       // bytes (length from the record; u32 count first)
    kOpCreateContext = 3,  // u32 context, u32 shareContext (0 none), u32 api, u32 versionMajor, minor, u32 profile, u32 flags, u32 surfaceConfig index
    kOpDestroyContext = 4, // u32 context
    kOpMakeCurrent = 5,    // u32 context (0 none), u32 drawWindow, u32 readWindow
    kOpWindow = 6,         // u32 window, WindowConfig: created or resized
    kOpDestroyWindow = 7,  // u32 window
    kOpSwap = 8,           // u32 window, u32 frame
    kOpClientArrays = 9,   // client memory of the following draw (streamcodec/client_arrays.hpp)
    kOpRequestPixels = 10, // u32 request, i32 x y w h, u32 format, u32 type, u32 groupBytes
    kOpRequestTexImage = 11,
    kOpRequestBuffer = 12,
    kOpRequestQuery = 13,
    kOpFillWindow = 14,    // i32 x y w h, u32 planes, bytes: pixels of other tiles, before a copy
    kOpProgramLayout = 15, // after a link: u32 program, locations by name
    kOpBufferBytes = 16,   // u32 buffer, u64 offset, bytes: written through a mapping
    kOpFinish = 17,        // u32 request: answer when all before is done
    kOpFrontPicture = 18,  // u32 window, u32 frame: like Swap for a single-buffered window or front drawing
    kOpBeginConditional = 19, // u32 draws: glBeginConditionalRender with the result known; 0: nothing is drawn
    kOpQueryKnown = 20,    // u32 query, u32 passed: for conditional rendering in the display list that is called next
    kOpDrawAll = 21,       // from now on every node draws all of every window
    kOpCreateImage = 22,   // u64 image, u32 context, u32 target, u32 name, i32 level, i32 layer: eglCreateImage of a GL object
    kOpDestroyImage = 23,  // u64 image
    kOpRequestProgram = 24, // u32 request, u32 program: what it was linked from
    kOpProgramRecipe = 25,  // u32 program, such an answer: glProgramBinary; nothing: the binary was refused
    kOpErrorTold = 26,      // glGetError has told an error of the program's own GL
    kOpLastOwn = 63,
};
constexpr uint16_t kFirstGlOpcode = 64;

// In groupBytes of kOpRequestPixels: without the program's pixel transfer (scale, bias, maps).
constexpr uint32_t kPlainTransfer = 0x80000000;
// There, too: each pixel's samples put together, as a copy of the window has them.
constexpr uint32_t kResolved = 0x40000000;
// In planes of kOpFillWindow: for the copy that is next. A window with samples stays as it is.
constexpr uint32_t kForCopy = 0x80000000;
// In planes of kOpFillWindow: colours are words of GL_UNSIGNED_INT_2_10_10_10_REV, or four floats. Default: four bytes.
constexpr uint32_t kTenBits = 0x40000000;
constexpr uint32_t kFloats = 0x20000000;

// In kOpSwap and kOpFrontPicture: drawn and counted as any other, but no picture is sent and no credit given.
constexpr uint32_t kUnseenFrame = 0;

// What the app's drawable looks like; the nodes make their surfaces alike.
struct WindowConfig {
    uint32_t width, height; // pixels
    uint8_t red, green, blue, alpha;
    uint8_t depth, stencil, samples, doubleBuffer;
    uint8_t accum, stereo, srgb, isPbuffer;
    uint32_t nativeLow, nativeHigh; // X window id, 0 when there is none
};
static_assert(sizeof(WindowConfig) == 28);
// In doubleBuffer: the front buffer begins black, and swaps do not change it.
constexpr uint8_t kOwnFront = 2;

// In CreateContext's flags: the program wants to be told when the context is lost.
constexpr uint32_t kLosesOnReset = 0x80000000;

enum class Api : uint32_t { Desktop = 0, Es1 = 1, Es2 = 2 }; // Es2: ES 2 and later

} // namespace mural::wire
