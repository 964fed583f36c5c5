// Deferred replies: reads into pixel pack buffers whose pixels the program has not used yet. The call sends a request
// and returns. The reply is written into the program's own copy of the buffer when the program first reads, writes or
// otherwise uses it. The nodes do not need the bytes, and receive them only before a use for other purposes.
#pragma once

#include <GL/gl.h>
#include <atomic>
#include <cstdint>

#include "interposer/memory/image_part.hpp"
#include "interposer/context/lock.hpp"
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct Context;
struct ShareGroup;
struct ThreadState;
struct PendingRead; // interposer/readback/pending_reads.cpp
struct ReadArea;

// One bit per object name, set by any thread. Names above the limit never have it.
class SharedNameBits {
public:
    [[nodiscard]] bool get(GLuint name) const {
        return known(name) && (bits_[name / 64].load(std::memory_order_relaxed) >> name % 64 & 1);
    }
    void set(GLuint name, bool on) {
        if (!known(name)) return;
        const uint64_t bit = uint64_t{1} << name % 64;
        if (on)
            bits_[name / 64].fetch_or(bit, std::memory_order_relaxed);
        else
            bits_[name / 64].fetch_and(~bit, std::memory_order_relaxed);
    }
    [[nodiscard]] static bool known(GLuint name) { return name < kNames; }

private:
    static constexpr GLuint kNames = 16384;
    std::atomic<uint64_t> bits_[kNames / 64] = {};
};

// Per share group.
struct PendingReads {
    Lock lock;                    // for the list, and while waiting for replies
    PendingRead* first = nullptr; // in call order
    std::atomic<int> count{0};
    uint64_t sizeBytes = 0;
    SharedNameBits usedElsewhere; // the buffer was used for other purposes than reads: the nodes have all of its bytes
    SharedNameBits nodesLack;     // the nodes lack some of its bytes
    std::atomic<bool> dueAtUnmap{false}; // a buffer that the nodes lack was mapped at its first other use

    [[nodiscard]] bool onlyReadInto(GLuint buffer) const {
        return SharedNameBits::known(buffer) && !usedElsewhere.get(buffer);
    }
};

// The image's place in the bound pack buffer, and the part of the reply that goes there.
struct PackTarget {
    uint64_t offset;
    sizes::ImageLayout layout;
    ImagePart part{};
};

// Both defer a read. They return false if it must complete now: the buffer has other uses, or memory is exhausted.
bool deferPixels(ThreadState& t, const ReadArea& area, GLenum format, GLenum type, const PackTarget& target,
                 const char* by);
bool deferTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type,
                   uint64_t sizeBytes, const PackTarget& target, const char* by);

// interposer/context/context.hpp has fast paths for the following functions.
void settle(ThreadState& t, GLuint buffer, const char* by);
void firstUse(ThreadState& t, GLuint buffer, const char* by);
GLuint boundPackBuffer();

// True if the program's own copy is valid and the nodes' is not.
[[nodiscard]] bool nodesLack(const ThreadState& t, GLuint buffer);
// Call after the program has unmapped the buffer, or has given it new storage.
void unmappedHere(ThreadState& t, GLuint buffer);
void newStorage(ThreadState& t, GLuint buffer);
// Call when the program deletes the buffer.
void forgetReads(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION());
// Call when the last context of the group is destroyed.
void forgetReads(ShareGroup& group);

} // namespace mural
