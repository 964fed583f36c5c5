// The memory that a captured program shares with the head: chunks of encoded commands one way,
// answers and credits the other way. Plain data and atomics: it is mapped into foreign processes.
//
//   app thread → chunk (bump pointer)  → publication (chunk, range, stream) → head
//   head       → freed chunk index     → app
//   head       → reply ring (bytes)    → the one app thread that asked
//   head       → table of answers      → query results that were asked for at the end of the query
//
// Producer side of publications and consumer side of freed chunks are guarded by one lock in the app
// process; so both rings have one producer and one consumer each.
//
// At the start every chunk's index lies in the freed ring: the app takes its chunks from there only.
//
//   head       → news slots (a ring)   → the app thread that looks first; full: news are lost
//   head       → reply ring (pictures) → the app, which puts them into its own windows during a server grab
//
// Layout of the mapping: CaptureHeader | publications | freed | reply bytes | news | chunks.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace mural::capture {

constexpr uint32_t kMagic = 0x4d55524c; // "MURL"
constexpr uint32_t kVersion = 9;
constexpr uint32_t kChunkBytes = 256 * 1024;
constexpr uint32_t kDefaultChunks = 256; // 64 MiB
constexpr uint32_t kReplyBytes = 4 * 1024 * 1024;
constexpr int kMaxWindows = 256;
constexpr uint32_t kNewsSlots = 64; // a power of two
constexpr uint32_t kNewsTextBytes = 480;
// X displays of one program; their numbers are in WindowConfig::nativeHigh.
constexpr uint32_t kDisplays = 16;
constexpr uint32_t kDisplayNameBytes = 128; // with the 0 at the end
constexpr uint32_t kNoDisplay = 0xffffffff; // the table is full, or the name is too long

// Requests whose answers nobody waits for yet: ids with this bit. Their answers lie in a table, each at its id
// modulo the table's size, until a later one takes the place.
constexpr uint32_t kAskedAhead = 0x80000000;
constexpr uint32_t kAheadAnswers = 1024;
// Requests whose answers come as replies, but are read when the program needs them, if ever: ids with this bit.
constexpr uint32_t kOwed = 0x40000000;
struct AheadAnswer {
    std::atomic<uint32_t> request; // whose answer this is; 0: none yet. Stored last; futex
    std::atomic<uint64_t> value;
};

// A range of one chunk that is complete and may be read.
struct Publication {
    uint32_t chunk;
    uint32_t beginBytes;
    uint32_t endBytes;
    uint16_t stream;    // one per app thread
    uint16_t lastOfChunk; // 1: the chunk is free once this range has been read
};
static_assert(sizeof(Publication) == 16);

// What a thread of the program waits for.
enum class Wait : uint32_t {
    Nothing = 0,
    Room = 1,   // in the ring: the head has not read it yet, for nodes take no more
    Frames = 2, // credit: the nodes draw the frames before
    Answer = 3, // of the nodes, to a question: a round trip
    Window = 4, // the picture is in the program's own window
};
constexpr uint32_t kWaits = 5;

// Why `--verify` could not compare a frame.
enum class Uncompared : uint32_t {
    NoContext = 0,   // the thread that swapped has none
    NotBindable = 1, // another window is current, and this one can't be bound with the thread's context
    Front = 2,       // drawn into the front buffer of a window with two buffers, and shown by a flush
    NoSize = 3,      // the driver does not tell the window's size
    NoMemory = 4,
    NotReadable = 5, // the program's own GL does not read its picture
    NoAnswer = 6,    // of the nodes
};
constexpr uint32_t kUncomparedReasons = 7;

// How many round trips a command has caused. Written under the program's lock of questions; a name is
// complete before its count is more than 0.
struct TripCount {
    char command[56]; // ends with 0
    std::atomic<uint64_t> count;
};
constexpr uint32_t kTripCounts = 48; // the last one is for all that find no place

// What the head's reader of publications does. A wake costs the program a system call, so frames that come faster
// than any display shows them are not announced: the reader naps then, and looks again by itself.
enum class Reader : uint32_t {
    Reads = 0,
    Naps = 1,   // for kNapNs at most: woken only when a thread of the program waits for something
    Sleeps = 2, // until it is woken
};
constexpr int64_t kNapNs = 100'000;

// So far a program may be ahead of the nodes beyond the frames of Welcome.latency (unless that is 0): frames that
// take longer are not affected, and one that does nothing but show frames sleeps once in a while, not in each.
constexpr int64_t kAheadNs = 1'000'000;
constexpr uint32_t kAheadFrames = 64; // a power of two

// CaptureHeader::framesWanted: how many done frames a thread of the program sleeps for, and that it does.
constexpr uint64_t kFramesWanted = uint64_t{1} << 32;

// What a node's GL tells of a context: wire::News and its text.
struct NewsSlot {
    std::byte news[32];
    char text[kNewsTextBytes];
};
static_assert(sizeof(NewsSlot) == 512);

// A window into which the program puts its pictures itself, as it holds a grab of the X server: the head's connection is
// not served then. The program writes; `window` is stored last.
struct OwnWindow {
    std::atomic<uint32_t> window; // X id; 0: a free slot
    std::atomic<uint32_t> frame;  // the latest one that the program puts
    std::atomic<uint32_t> depth, bitsPerPixel, rowPadBits, redMask, greenMask, blueMask;
};
constexpr uint32_t kOwnWindows = 16;
// ReplyHeader.kind of such a picture: requestId is the frame, x the window, and w * h pixels in the window's format follow,
// the topmost row first.
constexpr uint32_t kPictureReply = 0xffffffff;

struct alignas(64) CaptureHeader {
    uint32_t magic;
    uint32_t version;
    uint32_t chunkCount;       // = capacity of both index rings, a power of two
    uint32_t replyCapacity;    // bytes, a power of two
    uint64_t publicationsAt;   // offsets in bytes from the start of the mapping
    uint64_t freedAt;
    uint64_t repliesAt;
    uint64_t newsAt;
    uint64_t chunksAt;
    uint64_t totalBytes;

    alignas(64) std::atomic<uint32_t> publishedTail; // app writes; futex: the head sleeps on it
    alignas(64) std::atomic<uint32_t> publishedHead; // head writes
    alignas(64) std::atomic<uint32_t> reader;        // Reader; head writes
    alignas(64) std::atomic<uint32_t> freedTail;     // head writes; futex: the app sleeps on it
    alignas(64) std::atomic<uint32_t> freedHead;     // app writes
    alignas(64) std::atomic<uint32_t> replyTail;     // head writes, bytes; futex
    alignas(64) std::atomic<uint32_t> replyHead;     // app writes, bytes; futex: head may wait for room

    alignas(64) std::atomic<uint32_t> newsTail;      // head writes
    alignas(64) std::atomic<uint32_t> newsHead;      // app writes

    // Frames that the nodes have finished, over all windows: the credit of the frame latency. futex.
    alignas(64) std::atomic<uint32_t> framesDone;
    // kFramesWanted | frames: the head wakes who sleeps on framesDone when so many are done, and clears it. A thread
    // that wants fewer than another may be woken with that one: all are on their way.
    std::atomic<uint64_t> framesWanted;
    std::atomic<uint32_t> framesSubmitted; // app writes
    // Frames of the app's own window that are on the screen (--display app). futex.
    std::atomic<uint32_t> framesShown;

    // Incremented by the head's main loop, about every 50 ms: the limits of the app's waits count only while it runs.
    alignas(64) std::atomic<uint32_t> headBeat;

    // Set by the head when it ends the session in order; the app then goes on alone.
    alignas(64) std::atomic<uint32_t> headGone;
    // A robust futex that a thread of the head holds while it serves the program: the kernel sets FUTEX_OWNER_DIED when
    // the head ends in any other way, and the app goes on alone.
    std::atomic<uint32_t> headLife;

    // Results of `--verify`: written by the app, read by the head for the report.
    alignas(64) std::atomic<uint64_t> verifiedFrames;
    std::atomic<uint64_t> verifiedPixels;
    std::atomic<uint64_t> differingPixels;
    std::atomic<uint64_t> squaredDifference; // of all components, added up
    std::atomic<uint32_t> largestDifference;
    std::atomic<uint64_t> uncomparedFrames[kUncomparedReasons]; // by Uncompared
    // Counters of the app's side, for the report.
    std::atomic<uint64_t> callsUnsupported;
    std::atomic<uint64_t> roundTrips;
    std::atomic<uint64_t> waitNs[kWaits]; // its threads blocked, by what for
    std::atomic<uint32_t> waitingFor;     // Wait, of the thread that began to wait last
    // CPU time of the threads that show frames, and for how many frames it was added up.
    std::atomic<uint64_t> frameCpuNs;
    std::atomic<uint64_t> frameCpuFrames;
    TripCount trips[kTripCounts];

    // Names of the X displays on which the program has windows. Written by the app before the first window's record.
    std::atomic<uint32_t> displayCount;
    char displays[kDisplays][kDisplayNameBytes];

    alignas(64) OwnWindow ownWindows[kOwnWindows];
    alignas(64) AheadAnswer ahead[kAheadAnswers]; // the head writes
};

inline Publication* publications(CaptureHeader* h) {
    return reinterpret_cast<Publication*>(reinterpret_cast<std::byte*>(h) + h->publicationsAt);
}
inline uint32_t* freed(CaptureHeader* h) {
    return reinterpret_cast<uint32_t*>(reinterpret_cast<std::byte*>(h) + h->freedAt);
}
inline std::byte* replies(CaptureHeader* h) {
    return reinterpret_cast<std::byte*>(h) + h->repliesAt;
}
inline NewsSlot* news(CaptureHeader* h) {
    return reinterpret_cast<NewsSlot*>(reinterpret_cast<std::byte*>(h) + h->newsAt);
}
inline std::byte* chunk(CaptureHeader* h, uint32_t index) {
    return reinterpret_cast<std::byte*>(h) + h->chunksAt + size_t{index} * kChunkBytes;
}

// The handshake on the session's Unix socket (SOCK_STREAM, abstract name from MURAL_SESSION, or path from MURAL_SOCKET).
// App → head: Hello. Head → app: Welcome with the mapping's memfd attached (SCM_RIGHTS), then
// Welcome.extensionBytes bytes: the GL extensions that all nodes have, separated by spaces.
// Then the app closes the socket. Its mapping says that it is alive: the head has locked the memfd's file
// description (flock), and the kernel releases the lock with the last mapping and descriptor of it.
struct Hello {
    uint32_t magic;
    uint32_t version;
    uint64_t registryDigest; // of the command table: both ends must be of one build
    int32_t pid;
    uint32_t reserved;
};

// In place of a program `mural stat` may come: a Hello with this magic is answered with the session's state as JSON
// (nodes/head/session_status.hpp), and the end of the connection.
constexpr uint32_t kStatusMagic = 0x4d535441; // "MSTA"

enum Policy : uint32_t { kPolicyState = 0, kPolicyFull = 1 };

struct Welcome {
    uint32_t magic;
    uint32_t version;
    uint32_t clientId;
    uint32_t policy;
    uint32_t latency;      // frames that the app may be ahead of the nodes
    uint32_t verifyEvery;  // 0: never; n: compare every n-th frame with the local picture
    uint32_t nodeCount;    // render nodes (1: no gathering needed for copies)
    uint32_t displayApp;   // 1: pictures come back into the app's own window
    uint32_t nodeGlVersion; // lowest GL version of the nodes, 10 * major + minor; 0 unknown
    uint32_t refused;      // not 0: the session is not for you; a text of extensionBytes follows instead
    uint32_t extensionBytes;
    uint32_t reserved;
};

} // namespace mural::capture
