// Writes one record: beginRecord, put…, endRecord. Uses no allocation, lock or system call unless the chunk is full or
// several threads share the context's objects.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstring>

#include "interposer/context/thread_state.hpp"
#include "streamcodec/wire/record.hpp"

namespace mural {

// The slow path. Takes a new chunk or the share group's lock, or queries the window's size before the first draw after
// a swap. Null: not capturing.
std::byte* makeRoom(ThreadState& t, uint32_t opcode, uint32_t sizeBytes);
void unlockGroup(ThreadState& t);

// Reserves a record of sizeBytes, including the header; a multiple of 4. Returns the place of the arguments.
inline std::byte* beginRecord(ThreadState& t, uint32_t opcode, uint32_t sizeBytes) {
    std::byte* p = t.cursor;
    if (reinterpret_cast<uintptr_t>(p) + sizeBytes + 4 > reinterpret_cast<uintptr_t>(t.limit)) [[unlikely]] {
        p = makeRoom(t, opcode, sizeBytes + 4);
        if (!p) return nullptr;
    }
    const uint32_t words = sizeBytes / 4;
    if (words < record::kLongForm) [[likely]] {
        const uint32_t header = opcode | words << 16;
        std::memcpy(p, &header, 4);
        return p + 4;
    }
    const uint32_t longHeader[2] = {opcode | record::kLongForm << 16, words + 1};
    std::memcpy(p, longHeader, 8);
    return p + 8;
}

// `arguments` is the result of beginRecord; sizeBytes is the same value.
inline void endRecord(ThreadState& t, std::byte* arguments, uint32_t sizeBytes) {
    __atomic_store_n(&t.cursor, arguments + sizeBytes - 4, __ATOMIC_RELEASE);
    if (t.locked) [[unlikely]]
        unlockGroup(t);
}

// The source of a pointer argument: data, or an offset into the bound buffer.
struct DataArg {
    const void* pointer = nullptr;
    uint64_t sizeBytes = 0;
    bool isOffset = false; // the pointer is an offset into the bound buffer

    static DataArg of(const void* p, uint64_t bytes) { return {p, p ? bytes : 0, false}; }
    static DataArg offset(const void* p) { return {p, 0, true}; }
    static DataArg text(const char* p) { return {p, p ? std::strlen(p) + 1 : 0, false}; }
};

// Returns the number of bytes in the record: a tag and the inline data.
inline uint32_t wireBytes(const DataArg& d) {
    if (d.isOffset) return 12;
    if (!d.pointer || d.sizeBytes > record::kInlineBytes) return 4;
    return 4 + (static_cast<uint32_t>(d.sizeBytes) + 3) / 4 * 4;
}

void spill(ThreadState& t, const DataArg& d);
// Sends a value that is too large for a record ahead of it, in pieces.
inline void spillLarge(ThreadState& t, const DataArg& d) {
    if (d.sizeBytes > record::kInlineBytes && !d.isOffset) [[unlikely]]
        spill(t, d);
}

class Writer {
public:
    explicit Writer(std::byte* p) : p_(p) {}

    template <class T> void put4(T value) {
        uint32_t word = 0;
        std::memcpy(&word, &value, sizeof(T) < 4 ? sizeof(T) : 4);
        std::memcpy(p_, &word, 4);
        p_ += 4;
    }
    template <class T> void put8(T value) {
        static_assert(sizeof(T) == 8);
        std::memcpy(p_, &value, 8);
        p_ += 8;
    }
    void bytes(const void* source, uint32_t count) {
        std::memcpy(p_, source, count);
        p_ += (count + 3) / 4 * 4;
    }
    void data(const DataArg& d) {
        if (d.isOffset) {
            put4(record::kTagOffset);
            put8(reinterpret_cast<uint64_t>(d.pointer));
        } else if (!d.pointer) {
            put4(record::kTagNull);
        } else if (d.sizeBytes > record::kInlineBytes) {
            put4(record::kTagBlob);
        } else {
            put4(static_cast<uint32_t>(d.sizeBytes));
            bytes(d.pointer, static_cast<uint32_t>(d.sizeBytes));
        }
    }

private:
    std::byte* p_;
};

// Returns the source of an image under the unpack state of the current context: client memory or an offset. Rows with
// gaps are packed tightly into scratch memory.
DataArg imageSource(ThreadState& t, const void* pixels, GLenum format, GLenum type, GLsizei width, GLsizei height,
                    GLsizei depth, int dimensions);
// The same for one pixel, which is in client memory regardless of bindings.
DataArg elementSource(ThreadState& t, const void* element, GLenum format, GLenum type);
// The same for bytes that the pixel store does not rearrange (compressed images).
DataArg packedSource(ThreadState& t, const void* data, uint64_t sizeBytes);
// Packs `count` strings: u32 lengths, then the concatenated bytes. `lengths` may be null.
DataArg packStrings(ThreadState& t, GLsizei count, const GLchar* const* strings, const GLint* lengths);

// Returns how many elements of a uniform array are readable. Drivers read no more elements than the uniform has,
// whatever the count says. Memory may therefore end earlier. Called for counts above kSureElements only.
constexpr GLsizei kSureElements = 256;
GLsizei readableElements(const void* value, GLsizei count, uint32_t elementBytes);

// Returns whether shaders or transform feedback write into buffers bound to the target.
constexpr bool writesThrough(GLenum target) {
    return target == GL_SHADER_STORAGE_BUFFER || target == GL_ATOMIC_COUNTER_BUFFER ||
           target == GL_TRANSFORM_FEEDBACK_BUFFER;
}

void unsupportedCalled(const char* name, const char* reason);

} // namespace mural
