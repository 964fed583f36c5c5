// Answers of the nodes that nobody waits for yet: the program has asked and gone on. They come in any order, between
// those that are waited for; whoever reads the replies puts each of them where it belongs (Session).
#pragma once

#include <cstddef>
#include <cstdint>

namespace mural {

// So many may be on their way, and so many bytes of them: the head keeps what is not read yet.
constexpr int kMostOwed = 64;
constexpr uint64_t kMostOwedBytes = uint64_t{256} << 20;

struct OwedAnswer {
    enum class State { Asked, Here, None }; // None: it came, and is no answer
    uint32_t request = 0;
    uint64_t sizeBytes = 0;
    std::byte* bytes = nullptr;
    State state = State::Asked;
    bool coming = false;    // its bytes are being read
    bool forgotten = false; // nobody wants it any more
    OwedAnswer* next = nullptr;
};

namespace owed {

// From any thread. Null: there is no memory.
OwedAnswer* add(uint32_t request, uint64_t sizeBytes);
// The oldest that is on its way while there is no room for another one of so many bytes; 0: there is room.
uint32_t inTheWayOf(uint64_t sizeBytes);
// Its answer has not come. Otherwise its entry changes no more.
[[nodiscard]] bool isAwaited(uint32_t request);
// What came has been used, or is not wanted any more: the entry is the caller's no longer.
void release(OwedAnswer* answer);

// For a forked child: the answers go to its parent.
void forgetAll();

// For the one that reads the replies: where this answer's bytes go; null: nowhere. arrived() follows.
void* placeOf(uint32_t request, uint64_t sizeBytes, bool failed);
void arrived(uint32_t request, bool whole);

} // namespace owed

} // namespace mural
