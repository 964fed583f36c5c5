// Replies and driver events on their way from the render nodes through the head to the program.
#pragma once

#include <cstdint>

namespace mural::wire {

// Part of the reply to request `requestId` (kOpRequest…).
struct ReplyPartHeader {
    uint32_t client;
    uint32_t requestId;
    uint32_t kind;       // ReplyKind
    uint32_t groupBytes; // bytes per pixel (rectangles)
    int32_t x, y, w, h;  // the part of the requested rectangle that follows (rectangles)
    uint32_t first;      // 1: the bytes are the complete reply: the whole rectangle, or data that is equal on all nodes
    uint32_t last;       // 1: the last part from this node for this request
};
enum class ReplyKind : uint32_t {
    Rectangle = 1, // disjoint parts of a picture, each from the node that drew it
    Bytes = 2,     // equal on all nodes: the bytes of the first living node count
    Sum = 3,       // u64 values, added over nodes
    // A message of a node about distributed objects, unasked: requestId is the node. For programs with the native API.
    Object = 4,
    // Unasked, for the same programs: node requestId is a member of the session; the bytes are its name. No bytes: it
    // is no longer a member.
    Member = 5,
};

// Header of each reply in the client's reply ring (head → program). The bytes follow immediately, and the next header
// follows them without padding. Rectangles: rows of w * groupBytes bytes, tightly packed, lowest row first; pixels that
// no node sent are 0.
struct ReplyHeader {
    uint32_t requestId;
    uint32_t kind;       // ReplyKind
    uint64_t sizeBytes;  // of the following bytes
    int32_t x, y, w, h;  // the union of the parts (rectangles)
    uint32_t groupBytes; // bytes per pixel (rectangles)
    uint32_t failed;     // 1: no node replied; sizeBytes is 0
};
static_assert(sizeof(ReplyHeader) == 40);

// Kinds of driver events.
enum class DriverEventKind : uint32_t {
    DebugMessage = 1, // the arguments of glDebugMessageCallback
    OutOfMemory = 2,  // GL_OUT_OF_MEMORY; `type`: number of kOpErrorReported before it
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

} // namespace mural::wire
