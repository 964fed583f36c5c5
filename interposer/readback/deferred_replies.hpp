// Deferred replies: the program has sent the request and continues without waiting. They arrive in any order, mixed
// with awaited replies. The thread that reads the replies stores each in its place (Session).
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural {

// Limits of the number and size of pending replies, because the head stores them until they are read.
constexpr int kMaxDeferred = 64;
constexpr uint64_t kMaxDeferredReplyBytes = uint64_t{256} << 20;

struct DeferredReply {
    enum class State { Requested, Arrived, None }; // None: the nodes had no reply
    uint32_t request = 0;
    uint64_t sizeBytes = 0;
    std::byte* bytes = nullptr;
    State state = State::Requested;
    bool coming = false;    // a thread is reading its bytes
    bool forgotten = false; // released before its arrival
    DeferredReply* next = nullptr;
};

namespace deferred {

// Adds a pending reply. Any thread may call it. Null: no memory.
DeferredReply* add(uint32_t request, uint64_t sizeBytes);
// Returns 0 if there is room for another reply of this size; otherwise the oldest pending request, which must complete
// first.
uint32_t conflictingWith(uint64_t sizeBytes);
// Returns whether the reply is still pending. Otherwise its entry no longer changes.
[[nodiscard]] bool isAwaited(uint32_t request);
// Ends the caller's ownership of the entry, after its use or without one.
void release(DeferredReply* answer);

// For a forked child: drops all entries, because the replies go to its parent.
void forgetAll();

// For the thread that reads replies. Returns the place for this reply's bytes; null: skip them. A call of arrived()
// must follow.
void* placeOf(uint32_t request, uint64_t sizeBytes, bool failed);
void arrived(uint32_t request, bool whole);

} // namespace deferred

} // namespace mural
