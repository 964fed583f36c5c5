// Spans of time of one frame: the activities and waits of each thread (docs/reference/statistics.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mural::wire {

// The activity of a thread, or the thing that it waits for.
enum class SpanKind : uint32_t {
    Capture,    // program: records its GL calls
    Encode,     // head: filter and delta coding
    Send,       // head: writes packets to the nodes' connections
    Receive,    // reads the payload of a packet, or of a picture
    Decode,     // node: delta-coded batches; head: encoded pictures
    Replay,     // node: executes the commands
    Readback,   // node: copies a picture, or begins to copy it, from the GL to memory
    Compose,    // node: composites parts of a picture
    Compress,   // node: scales and encodes a picture
    Transfer,   // node: writes a picture to the head's connection
    Assemble,   // head: assembles pictures from their parts
    Present,    // node: draws and shows its wall windows
    Output,     // head: shows and saves pictures
    WaitSpace,  // program: space in its ring
    WaitCredit, // program: the nodes' earlier frames
    WaitReply,  // program: a round trip
    WaitWindow, // program: its own window shows the picture
    WaitProgram,
    WaitPackets,
    WaitPart,     // node: part of a picture, or decision, of another node
    WaitBarrier,  // node: swap barrier
    WaitReadback, // node, thread of pictures: the GL completes a picture
    WaitQueue,    // node: room in the queue of pictures
    WaitFrame,    // node, thread of pictures: the next picture
    WaitNode,     // head: a node's message
    WaitOutput,   // head: room in the queue of the output
    WaitPicture,  // head, thread of the output: the next picture
};

inline constexpr std::array<std::string_view, 27> kSpanKindNames = {"capture",
                                                                    "encode",
                                                                    "send",
                                                                    "receive",
                                                                    "decode",
                                                                    "replay",
                                                                    "readback",
                                                                    "compose",
                                                                    "compress",
                                                                    "transfer",
                                                                    "assemble",
                                                                    "present",
                                                                    "output",
                                                                    "wait: space",
                                                                    "wait: credit",
                                                                    "wait: reply",
                                                                    "wait: window",
                                                                    "wait: program",
                                                                    "wait: packets",
                                                                    "wait: exchange part",
                                                                    "wait: swap barrier",
                                                                    "wait: readback",
                                                                    "wait: picture queue",
                                                                    "wait: frame",
                                                                    "wait: node",
                                                                    "wait: output",
                                                                    "wait: picture"};
inline constexpr uint32_t kSpanKinds = kSpanKindNames.size();
static_assert(kSpanKinds == static_cast<uint32_t>(SpanKind::WaitPicture) + 1);

inline std::string_view nameOf(SpanKind kind) { return kSpanKindNames[static_cast<size_t>(kind)]; }
inline bool isWait(SpanKind kind) { return kind >= SpanKind::WaitSpace; }

// The threads of a node that record spans.
enum class SpanThread : uint32_t { Replay = 0, Pictures = 1 };
constexpr uint32_t kSpanThreads = 2;

constexpr size_t kMaxFrameSpans = 512; // of one message

// Returns whether differences of such times fit into 64 bits.
inline bool isSensibleTime(int64_t ns) { return ns > -(int64_t{1} << 61) && ns < int64_t{1} << 61; }

// Message FrameSpans: this header, then FrameSpan*, by thread and time. The spans of a thread do not overlap.
struct FrameSpansHeader {
    uint32_t client;
    uint32_t window;
    uint32_t frame;
    uint32_t reserved; // 0
    int64_t sentNs;    // monotonic clock of the node
};
static_assert(sizeof(FrameSpansHeader) == 24);

struct FrameSpan {
    uint32_t kind;   // SpanKind
    uint32_t thread; // SpanThread
    int64_t beginNs; // monotonic clock of the node
    int64_t endNs;
};
static_assert(sizeof(FrameSpan) == 24);

// Message ClockReply, and its HeadCommand ClockProbe, which contains sentNs only.
struct ClockReplyMessage {
    int64_t sentNs;    // of the ClockProbe; clock of the head
    int64_t arrivedNs; // clock of the node
    int64_t leftNs;
};
static_assert(sizeof(ClockReplyMessage) == 24);

} // namespace mural::wire
