// Messages from a render node to the head.
#pragma once

#include <cstdint>

namespace mural::wire {

// Node → head.
enum class NodeMessage : uint32_t {
    Ready = 1,     // json: host, pid, renderer, glVersion, maxPixels, extensions, placement, addresses of its listeners
    ReplyPart = 2, // ReplyPartHeader + bytes
    FrameDone = 3, // FrameDoneMessage
    Picture = 4,   // PictureHeader + rows of 4 bytes per pixel; with a codec PackedPicture instead
    Log = 5,       // text: one line for the user
    Goodbye = 6,   // json: totals (commands, GL errors, replay time)
    WindowGone = 7,    // WindowGoneMessage: the program has destroyed the window, or ended; after its last FrameDone
    Alive = 8,         // no contents: heartbeat every few seconds, also while the replay is busy
    DriverEvent = 9,   // DriverEvent + text: a driver event
    ViewReached = 10,  // u32 view, ClientFrame*: later messages were sent after this Activate
    Synchronized = 11, // SynchronizedMessage: the node has reached that Synchronize
    // u32 number of the RequestPhase, then the state of all windows of the node.
    // - Node with phases: WindowTurn*.
    // - Node with moving areas: u32 windows, WindowAreas of each, ViewportAssignment*. The latest assignment is first,
    //   and the assignments of the windows follow.
    Turns = 12,
    PackedPicture = 13, // PictureHeader + the rows as encoded by PicturePacker
    // FrameSpansHeader + FrameSpan*, directly before the frame's FrameDone; only while statistics are on
    FrameSpans = 14,
    ClockReply = 15, // ClockReplyMessage: the reply to ClockProbe
    ObjectRequest =
        16,           // u32 client, then a message about distributed objects to the program (objects/wire/messages.hpp)
    OutputProof = 17, // OutputProofMessage: the reply to ProveOutput
    PreviewTile = 18, // PreviewTileHeader + JPEG: the reply to WantPreview
    WindowInput = 19, // an input event of its wall windows (nodes/input/input_event_bytes.hpp)
};

struct MessageHeader {
    uint32_t type; // NodeMessage
    uint32_t sizeBytes;
};

// Completion of a frame. A node sends the Picture of a frame, if any, before its FrameDone.
struct FrameDoneMessage {
    uint32_t client;
    uint32_t window;
    uint32_t frame; // number of the frame of this client, from 1
    uint32_t width; // of the window, pixels
    uint32_t height;
    uint32_t flags;    // kDrawnWhole, kKeepsPicture, kNotSplit, kKeepsAreas, kDrawnUnzoomed
    uint32_t areas;    // number of the ViewportAssignment that divides its picture; 0: of Setup
    uint32_t shares;   // number of the RangeAssignment that divides its draws; 0: of Setup
    uint64_t busyNs;   // work since the previous frame, without waits and sending; CPU time where nodes share cores
    uint64_t replayNs; // CPU time of the replay thread since the previous frame
    uint64_t readbackNs;
    uint64_t calls; // records of this client since its start, up to this frame
};

// Flags of FrameDoneMessage.
//
// Every node draws everything, because fragment shaders write to memory, or after kOpDrawAll.
constexpr uint32_t kDrawnWhole = 1;
// Frames depend on the previous frame: of nodes with phases, one draws all of them.
constexpr uint32_t kKeepsPicture = 2;
// No draw of the frame was divided between the nodes that draw ranges.
constexpr uint32_t kNotSplit = 4;
// The window has not been cleared completely since a ViewportAssignment was announced long ago.
constexpr uint32_t kKeepsAreas = 8;
// The zoom of the node did not apply to the frame, because the program reads or copies pixels of the window.
constexpr uint32_t kDrawnUnzoomed = 16;

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
    int64_t dependentFrames; // consecutive frames that depend on their predecessor
    uint32_t cleared;        // buffers cleared completely in this frame
    uint32_t state;          // kTurn…
};
static_assert(sizeof(WindowTurn) == 40);
constexpr uint32_t kTurnOver = 1, kTurnUndecided = 2, kTurnFresh = 4, kTurnForGood = 8;

// Numbers of the viewport assignments that divide a window (nodes/replay/features/dynamic_tiles.cpp).
struct WindowAreas {
    uint32_t client;
    uint32_t window;
    uint32_t areas, wanted, front;
    uint32_t drawn; // buffers that are divided: each node has its own part only
    uint32_t state; // kAreas…
};
static_assert(sizeof(WindowAreas) == 28);
// The areas no longer change. This frame, or the next one, is drawn without kernel and zoom.
constexpr uint32_t kAreasFixed = 1, kAreasPlain = 2, kAreasPlainNext = 4;

struct SynchronizedMessage {
    uint32_t number;   // of the Synchronize
    uint32_t validity; // FrameValidity
};
// FrameValidity of the frames of a node that has not drawn everything before.
enum class FrameValidity : uint32_t {
    Open = 0, // no frame of some window has been drawn yet
    Valid = 1,
    Invalid = 2, // frames depend on pixels that were not drawn
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
    uint32_t format;                // PictureFormat (common/base/picture_format.hpp)
};
static_assert(sizeof(PictureHeader) == 48);

} // namespace mural::wire
