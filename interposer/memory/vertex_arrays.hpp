// A mirror of the vertex array state, for one question at every draw: is an enabled array in client memory? Such arrays
// are copied at the draw, as OpenGL reads them then. Source: OpenGL 4.6 compatibility, sections 10.3 and 10.4.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streamcodec/wire/client_arrays.hpp"

namespace mural {

struct ArrayPointer {
    const void* pointer = nullptr;
    GLint size = 4;
    GLenum type = GL_FLOAT;
    GLsizei stride = 0;        // as specified; 0: tightly packed
    GLsizei bindingStride = 0; // of the binding with the same number, bytes
    uint32_t flags = 0;        // client_arrays::Flags
    GLuint divisor = 0;
    GLuint relative = 0; // offset from the pointer in bytes: glVertexAttribFormat
};

// One vertex array object.
struct VertexArray {
    GLuint name = 0;
    uint64_t enabled[2] = {0, 0}; // one bit per slot
    uint64_t client[2] = {0, 0};  // the pointer was specified without a bound buffer
    ArrayPointer slots[client_arrays::kSlots];

    [[nodiscard]] bool anyClient() const { return (enabled[0] & client[0]) | (enabled[1] & client[1]); }
    [[nodiscard]] bool isClient(uint32_t slot) const {
        return enabled[slot / 64] & client[slot / 64] & (uint64_t{1} << slot % 64);
    }
    void set(uint64_t (&mask)[2], uint32_t slot, bool on) {
        const uint64_t bit = uint64_t{1} << slot % 64;
        mask[slot / 64] = on ? mask[slot / 64] | bit : mask[slot / 64] & ~bit;
    }
    void enable(uint32_t slot, bool on) { set(enabled, slot, on); }
};

class VertexArrayMirror {
public:
    VertexArrayMirror() = default;
    VertexArrayMirror(const VertexArrayMirror&) = delete;
    VertexArrayMirror& operator=(const VertexArrayMirror&) = delete;
    ~VertexArrayMirror() {
        for (GLuint i = 0; i < namedCount_; ++i) std::free(named_[i]);
        std::free(named_);
        for (int i = 0; i < depth_; ++i) std::free(stack_[i].copy);
    }

    [[nodiscard]] VertexArray& current() { return *current_; }
    [[nodiscard]] bool anyClient() const { return current_->anyClient(); }

    void bind(GLuint name);
    // True if the name has been bound, which creates the object.
    [[nodiscard]] bool knows(GLuint name) const { return name == 0 || (name < namedCount_ && named_[name]); }
    [[nodiscard]] GLuint currentName() const { return current_->name; }
    void remove(GLsizei n, const GLuint* names);
    // For an existing array, bound or not.
    void enableIn(GLuint name, uint32_t slot, bool on) { find(name)->enable(slot, on); }
    void divide(GLuint name, uint32_t slot, GLuint divisor) { find(name)->slots[slot].divisor = divisor; }
    [[nodiscard]] GLuint divisor(GLuint name, uint32_t slot) { return find(name)->slots[slot].divisor; }
    // Whether any slot in the range points to client memory, enabled or not. The second function clears them.
    [[nodiscard]] bool anyInMemory(GLuint name, uint32_t first, uint32_t end);
    void moveToBuffer(GLuint name, uint32_t first, uint32_t end);
    // Gives an array in client memory the divisor of another one.
    void step(GLuint name, uint32_t slot, uint32_t as);
    void bindArrayBuffer(GLuint buffer) { arrayBuffer_ = buffer; }
    [[nodiscard]] GLuint arrayBuffer() const { return arrayBuffer_; }
    void forgetBuffers(GLsizei n, const GLuint* names);
    void activeTexture(GLenum unit) { unit_ = unit - GL_TEXTURE0 < client_arrays::kTexCoords ? unit - GL_TEXTURE0 : 0; }
    [[nodiscard]] uint32_t texCoordSlot() const { return client_arrays::kTexCoord0 + unit_; }

    // Returns true for client memory, which is sent at the draw; false for an offset, which is sent now.
    bool setPointer(uint32_t slot, GLint size, GLenum type, GLsizei stride, uint32_t flags, const void* pointer);
    // glVertexAttribFormat: changes the interpretation of the slot's data.
    void setFormat(GLuint array, uint32_t slot, GLint size, GLenum type, uint32_t flags, GLuint relative);
    // The slot of a name of glEnableClientState; kSlots: none.
    [[nodiscard]] uint32_t slotOf(GLenum array) const;

    void push(GLbitfield mask);
    void reset(GLbitfield mask); // EXT_direct_state_access: as in a new context
    void pop();

private:
    static constexpr int kStack = 16; // GL_MAX_CLIENT_ATTRIB_STACK_DEPTH
    struct Saved {
        bool arrays = false;
        GLuint name = 0, arrayBuffer = 0;
        uint32_t unit = 0;
        VertexArray* copy = nullptr;
    };
    VertexArray* find(GLuint name);

    VertexArray zero_;
    VertexArray* current_ = &zero_;
    VertexArray** named_ = nullptr; // by name, grows
    GLuint namedCount_ = 0;
    GLuint arrayBuffer_ = 0;
    uint32_t unit_ = 0;
    Saved stack_[kStack];
    int depth_ = 0;
};

} // namespace mural
