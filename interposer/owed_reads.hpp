// Reads into pixel pack buffers whose pixels the program has not needed yet: the nodes are asked, and the call returns.
// What comes goes into the program's own copy of the buffer when the program first looks at it, writes into it, or uses
// it for anything else. Until that other use the nodes do without the bytes: they would have no use for them.
#pragma once

#include <GL/gl.h>
#include <atomic>
#include <cstdint>

#include "interposer/image_part.hpp"
#include "interposer/lock.hpp"
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct Context;
struct ShareGroup;
struct ThreadState;
struct OwedRead; // interposer/owed_reads.cpp
struct ReadArea;

// One bit per object name, set by any thread. Names beyond never have it.
class SharedNameBits {
public:
    [[nodiscard]] bool get(GLuint name) const {
        return known(name) && (bits_[name / 64].load(std::memory_order_relaxed) >> name % 64 & 1);
    }
    void set(GLuint name, bool on) {
        if (!known(name)) return;
        const uint64_t bit = uint64_t{1} << name % 64;
        if (on) bits_[name / 64].fetch_or(bit, std::memory_order_relaxed);
        else bits_[name / 64].fetch_and(~bit, std::memory_order_relaxed);
    }
    [[nodiscard]] static bool known(GLuint name) { return name < kNames; }

private:
    static constexpr GLuint kNames = 16384;
    std::atomic<uint64_t> bits_[kNames / 64] = {};
};

// Of a share group.
struct OwedReads {
    Lock lock;                  // of the list, and while answers are waited for
    OwedRead* first = nullptr;  // in the order of the calls
    std::atomic<int> count{0};
    uint64_t sizeBytes = 0;
    SharedNameBits usedElsewhere; // the buffer was used for more than reads into it: the nodes have all its bytes
    SharedNameBits nodesLack;     // the nodes have not got its bytes, or not all
    std::atomic<bool> dueAtUnmap{false}; // some buffer that they lack was mapped when it was first used elsewhere

    [[nodiscard]] bool onlyReadInto(GLuint buffer) const { return SharedNameBits::known(buffer) && !usedElsewhere.get(buffer); }
};

// The image's place in the bound pack buffer, and what of the answer goes there.
struct PackPlace {
    uint64_t offset;
    sizes::ImageLayout layout;
    ImagePart part{};
};

// Both: false when this one has to be read now: the buffer is used for other things, or there is no memory.
bool owePixels(ThreadState& t, const ReadArea& area, GLenum format, GLenum type, const PackPlace& place, const char* by);
bool oweTexImage(ThreadState& t, bool byName, GLuint targetOrTexture, GLint level, GLenum format, GLenum type, uint64_t sizeBytes, const PackPlace& place, const char* by);

// What follows has short ways past it in interposer/context.hpp.
void settle(ThreadState& t, GLuint buffer, const char* by);
void firstUse(ThreadState& t, GLuint buffer, const char* by);
GLuint boundPackBuffer();

// The program's own copy is what counts, and the nodes' is another.
[[nodiscard]] bool nodesLack(const ThreadState& t, GLuint buffer);
// The program has unmapped it; or given it new storage.
void unmappedHere(ThreadState& t, GLuint buffer);
void newStorage(ThreadState& t, GLuint buffer);
// The program deletes it.
void forgetReads(ThreadState& t, GLuint buffer, const char* by = __builtin_FUNCTION());
// The last context of the group is gone.
void forgetReads(ShareGroup& group);

} // namespace mural
