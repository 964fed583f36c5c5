// The memory that a captured program (the app) shares with the head. Encoded commands go to the head in chunks. Replies
// and credits come back. The memory holds plain data and atomics only, because it is mapped into foreign processes.
//
//   app thread → chunk (bump pointer)  → publication (chunk, range, stream) → head;
//   head       → freed chunk index     → app;
//   head       → reply ring (bytes)    → the app thread that sent the request;
//   head       → table of replies      → results of queries, requested when the query ends;
//   head       → event slots (a ring)   → the first app thread that checks; a full ring drops events;
//   head       → reply ring (pictures) → the app, which puts them into its own windows during a server grab.
//
// One lock in the app process guards the producer side of publications and the consumer side of freed chunks. Both
// rings therefore have one producer and one consumer.
//
// Initially the freed ring contains the index of every chunk. The app takes chunks only from that ring.
//
// Layout of the mapping: CaptureHeader | publications | freed | reply bytes | driver events | chunks.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace mural::capture {

constexpr uint32_t kMagic = 0x4d55524c; // "MURL"
constexpr uint32_t kVersion = 14;
constexpr uint32_t kChunkBytes = 256 * 1024;
constexpr uint32_t kDefaultChunks = 256; // 64 MiB
constexpr uint32_t kReplyBytes = 4 * 1024 * 1024;
constexpr int kMaxWindows = 256;
constexpr uint32_t kDriverEventSlots = 64; // a power of two
constexpr uint32_t kDriverEventTextBytes = 480;
// X displays of one program; their numbers are in WindowConfig::nativeHigh.
constexpr uint32_t kDisplays = 16;
constexpr uint32_t kDisplayNameBytes = 128; // including the terminating 0
constexpr uint32_t kNoDisplay = 0xffffffff; // the table is full, or the name is too long

// Bit in the ids of prefetch requests, whose replies no thread waits for yet. Each reply is in a table, at its id
// modulo the table's size, until a later reply replaces it.
constexpr uint32_t kPrefetched = 0x80000000;
constexpr uint32_t kPrefetchedReplies = 1024;
// Bit in the ids of deferred requests. Their replies arrive in the reply ring; the program reads them when it needs
// them, if ever.
constexpr uint32_t kDeferred = 0x40000000;
struct PrefetchedReply {
    std::atomic<uint32_t> request; // id of its request; 0: no reply yet. Stored last; futex
    std::atomic<uint64_t> value;
};

// A completed range of one chunk, ready to be read.
struct Publication {
    uint32_t chunk;
    uint32_t beginBytes;
    uint32_t endBytes;
    uint16_t stream;      // one per app thread; with the native API, the receivers (object_records.hpp)
    uint16_t lastOfChunk; // 1: the chunk is free once this range has been read
};
static_assert(sizeof(Publication) == 16);

// The reason why a thread of the program waits.
enum class Wait : uint32_t {
    Nothing = 0,
    Space = 1,  // space in the ring; the head reads no further, because the nodes accept no more
    Frames = 2, // credit; the nodes still draw earlier frames
    Reply = 3,  // the reply of the nodes to a request (a round trip)
    Window = 4, // the picture's arrival in the program's own window
};
constexpr uint32_t kWaits = 5;

// The reason why `--verify` could not compare a frame.
enum class Uncompared : uint32_t {
    NoContext = 0,   // the swapping thread has no context
    NotBindable = 1, // another window is current, and the thread's context cannot be bound to this one
    Front = 2,       // a flush showed the front buffer of a double-buffered window
    NoSize = 3,      // the driver does not report the window's size
    NoMemory = 4,
    NotReadable = 5, // the program's own GL cannot read its picture
    NoAnswer = 6,    // the nodes did not answer
};
constexpr uint32_t kUncomparedReasons = 7;

// Number of events of one kind, for one command. One lock of the program guards all counts of a kind. A name is
// complete before its count exceeds 0.
struct CommandCount {
    char command[56]; // zero-terminated
    std::atomic<uint64_t> count;
};
constexpr uint32_t kCommandCounts = 48; // the last entry counts all commands without an entry

// State of the head's reader of publications. A wake-up costs the program a system call. Frames faster than any display
// are therefore not announced: the reader naps and polls by itself.
enum class Reader : uint32_t {
    Reads = 0,
    Naps = 1,   // for at most kNapNs; woken only when a thread of the program waits
    Sleeps = 2, // until a wake-up
};
constexpr int64_t kNapNs = 100'000;

// A program may exceed the frames of CaptureHeader::latency while its oldest unfinished frame is younger than this.
// Latency 0 allows no such excess. Slower frames are not affected. A program that only shows frames sleeps occasionally
// instead of in each frame.
constexpr int64_t kAheadNs = 1'000'000;
constexpr uint32_t kAheadFrames = 64; // a power of two

// Flag of CaptureHeader::framesWanted: a thread of the program sleeps. The low bits hold the awaited number of done
// frames.
constexpr uint64_t kFramesWanted = uint64_t{1} << 32;

// An event that a node's GL reports about a context: wire::DriverEvent and its text.
struct DriverEventSlot {
    std::byte event[32];
    char text[kDriverEventTextBytes];
};
static_assert(sizeof(DriverEventSlot) == 512);

// A window into which the program puts pictures itself while it holds a grab of the X server. The server does not serve
// the head's connection then. The program writes the entry and stores `window` last.
struct OwnWindow {
    std::atomic<uint32_t> window; // X id; 0: a free slot
    std::atomic<uint32_t> frame;  // the latest frame that the program puts
    std::atomic<uint32_t> depth, bitsPerPixel, rowPadBits, redMask, greenMask, blueMask;
};
constexpr uint32_t kOwnWindows = 16;
// ReplyHeader.kind of a picture for an OwnWindow. requestId is the frame and x the window. The w * h pixels follow in
// the window's format, topmost row first.
constexpr uint32_t kPictureReply = 0xffffffff;

struct alignas(64) CaptureHeader {
    uint32_t magic;
    uint32_t version;
    uint32_t chunkCount;     // capacity of both index rings, a power of two
    uint32_t replyCapacity;  // bytes, a power of two
    uint64_t publicationsAt; // offsets in bytes from the start of the mapping
    uint64_t freedAt;
    uint64_t repliesAt;
    uint64_t driverEventsAt;
    uint64_t chunksAt;
    uint64_t totalBytes;

    alignas(64) std::atomic<uint32_t> publishedTail; // app writes; futex: the head sleeps on it
    alignas(64) std::atomic<uint32_t> publishedHead; // head writes
    alignas(64) std::atomic<uint32_t> reader;        // Reader; head writes
    alignas(64) std::atomic<uint32_t> freedTail;     // head writes; futex: the app sleeps on it
    alignas(64) std::atomic<uint32_t> freedHead;     // app writes
    alignas(64) std::atomic<uint32_t> replyTail;     // head writes, bytes; futex
    alignas(64) std::atomic<uint32_t> replyHead;     // app writes, bytes; futex: head may wait for room

    alignas(64) std::atomic<uint32_t> driverEventTail; // head writes
    alignas(64) std::atomic<uint32_t> driverEventHead; // app writes

    // Frames that the nodes have finished, over all windows: the credit of the frame latency. futex.
    alignas(64) std::atomic<uint32_t> framesDone;
    // Frames that the app may be ahead of the nodes. The head may change it at any time. The app reads it at each swap,
    // and again when a change wakes it (framesDone).
    std::atomic<uint32_t> latency;
    // kFramesWanted | frames. When that many frames are done, the head wakes the threads that sleep on framesDone, and
    // clears the word. A thread that waits for fewer frames may wake with a later one, because all these frames are
    // under way.
    std::atomic<uint64_t> framesWanted;
    std::atomic<uint32_t> framesSubmitted; // app writes
    // Frames of the app's own window that the screen shows (--display app). futex.
    std::atomic<uint32_t> framesShown;
    // 1: the app reads its windows through X, so the head draws no overlay over them any more. App writes.
    std::atomic<uint32_t> readsWindows;
    // 1: windows of the app may show an overlay. The app waits for 0 before it reads. futex.
    std::atomic<uint32_t> overlayShown;

    // The head's main loop increments it about every 50 ms. Limits of the app's waits count only time in which it
    // changes.
    alignas(64) std::atomic<uint32_t> headBeat;

    // The head sets it at an orderly end of the session. The app then continues alone.
    alignas(64) std::atomic<uint32_t> headGone;
    // A robust futex that a thread of the head holds while it serves the program. If the head ends in any other way,
    // the kernel sets FUTEX_OWNER_DIED, and the app continues alone.
    std::atomic<uint32_t> headLiveness;

    // Results of `--verify`: written by the app, read by the head for the report.
    alignas(64) std::atomic<uint64_t> verifiedFrames;
    std::atomic<uint64_t> verifiedPixels;
    std::atomic<uint64_t> differingPixels;
    std::atomic<uint64_t> squaredDifference; // sum over all components
    std::atomic<uint32_t> largestDifference;
    std::atomic<uint64_t> uncomparedFrames[kUncomparedReasons]; // indexed by Uncompared
    // The app's counters for the report.
    std::atomic<uint64_t> callsUnsupported;
    std::atomic<uint64_t> roundTrips;
    std::atomic<uint64_t> waitNs[kWaits]; // blocked time of the app's threads, indexed by Wait
    std::atomic<uint32_t> waitingFor;     // Wait of the thread that began to wait last
    // CPU time of the threads that show frames, and the number of frames in that sum.
    std::atomic<uint64_t> frameCpuNs;
    std::atomic<uint64_t> frameCpuFrames;
    CommandCount trips[kCommandCounts]; // round trips; written under the program's request lock
    CommandCount unsupported[kCommandCounts];

    // Names of the X displays on which the program has windows. Written by the app before the first window's record.
    std::atomic<uint32_t> displayCount;
    char displays[kDisplays][kDisplayNameBytes];

    alignas(64) OwnWindow ownWindows[kOwnWindows];
    alignas(64) PrefetchedReply prefetched[kPrefetchedReplies]; // head writes
};

inline Publication* publications(CaptureHeader* h) {
    return reinterpret_cast<Publication*>(reinterpret_cast<std::byte*>(h) + h->publicationsAt);
}
inline uint32_t* freed(CaptureHeader* h) {
    return reinterpret_cast<uint32_t*>(reinterpret_cast<std::byte*>(h) + h->freedAt);
}
inline std::byte* replies(CaptureHeader* h) { return reinterpret_cast<std::byte*>(h) + h->repliesAt; }
inline DriverEventSlot* driverEvents(CaptureHeader* h) {
    return reinterpret_cast<DriverEventSlot*>(reinterpret_cast<std::byte*>(h) + h->driverEventsAt);
}
inline std::byte* chunk(CaptureHeader* h, uint32_t index) {
    return reinterpret_cast<std::byte*>(h) + h->chunksAt + size_t{index} * kChunkBytes;
}

// The handshake on the session's Unix socket (SOCK_STREAM, abstract name from MURAL_SESSION, or path from
// MURAL_SOCKET).
//
// 1. App → head: Hello.
// 2. Head → app: Welcome with the mapping's memfd attached (SCM_RIGHTS).
// 3. Head → app: Welcome.extensionBytes bytes, the GL extensions that all nodes have, separated by spaces.
// 4. The app closes the socket.
//
// After that the app's mapping indicates that it is alive. The head has locked the memfd's file description (flock),
// and the kernel releases the lock with its last mapping and descriptor.
enum class ProgramKind : uint32_t {
    Captured = 0, // its stream contains GL commands
    Native = 1,   // its stream contains objects and frames of the native API
};

struct Hello {
    uint32_t magic;
    uint32_t version;
    uint64_t registryDigest; // of the command table: both ends must come from one build
    int32_t pid;
    ProgramKind kind;
};

enum LocalRendering : uint32_t { kLocalRenderingOff = 0, kLocalRenderingOn = 1 };

struct Welcome {
    uint32_t magic;
    uint32_t version;
    uint32_t clientId;
    uint32_t localRendering;
    uint32_t verifyEvery;   // 0: never; n: compare every n-th frame with the local picture
    uint32_t nodeCount;     // render nodes; 1: copies need no gathering
    uint32_t displayApp;    // 1: pictures come back into the app's own window
    uint32_t nodeGlVersion; // lowest GL version of the nodes, 10 * major + minor; 0 unknown
    uint32_t refused;       // not 0: the head rejects the program; a text of extensionBytes follows instead
    uint32_t extensionBytes;
    uint32_t width, height; // of the wall in pixels; 0: the program's window determines it
    uint32_t multicasts;    // 1: packets to all nodes travel by multicast to at least two of them
    uint32_t isOneMachine;  // 1: all nodes are processes of this machine
    uint32_t members;       // nodes whose membership the first replies report (native API)
};

} // namespace mural::capture
