#include "interposer/memory/vertex_arrays.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "streamcodec/sizes/vertex_types.hpp"

namespace mural {

using namespace client_arrays;

VertexArray* VertexArrayMirror::find(GLuint name) {
    if (name == 0) return &zero_;
    if (name >= namedCount_) {
        const GLuint count = name + name / 2 + 16;
        auto** larger = static_cast<VertexArray**>(std::realloc(named_, count * sizeof(VertexArray*)));
        if (!larger) return &zero_;
        std::memset(larger + namedCount_, 0, (count - namedCount_) * sizeof(VertexArray*));
        named_ = larger;
        namedCount_ = count;
    }
    if (!named_[name]) {
        void* memory = std::malloc(sizeof(VertexArray));
        if (!memory) return &zero_;
        named_[name] = new (memory) VertexArray;
        named_[name]->name = name;
    }
    return named_[name];
}

void VertexArrayMirror::bind(GLuint name) { current_ = find(name); }

void VertexArrayMirror::remove(GLsizei n, const GLuint* names) {
    for (GLsizei i = 0; i < n; ++i) {
        const GLuint name = names[i];
        if (name == 0 || name >= namedCount_ || !named_[name]) continue;
        if (current_ == named_[name]) current_ = &zero_;
        std::free(named_[name]);
        named_[name] = nullptr;
    }
}

void VertexArrayMirror::forgetBuffers(GLsizei n, const GLuint* names) {
    for (GLsizei i = 0; i < n; ++i) {
        if (names[i] != 0 && names[i] == arrayBuffer_) arrayBuffer_ = 0;
    }
}

bool VertexArrayMirror::setPointer(uint32_t slot, GLint size, GLenum type, GLsizei stride, uint32_t flags,
                                   const void* pointer) {
    VertexArray& va = *current_;
    ArrayPointer& a = va.slots[slot];
    a.pointer = pointer;
    a.size = size;
    a.type = type;
    a.stride = stride;
    a.bindingStride = stride != 0 ? stride : static_cast<GLsizei>(sizes::attributeBytes(size, type));
    a.flags = flags;
    a.relative = 0;
    const bool client = arrayBuffer_ == 0 && pointer != nullptr;
    va.set(va.client, slot, client);
    return client;
}

void VertexArrayMirror::setFormat(GLuint array, uint32_t slot, GLint size, GLenum type, uint32_t flags,
                                  GLuint relative) {
    ArrayPointer& a = find(array)->slots[slot];
    // keeps the effective stride
    if (a.stride == 0) a.stride = static_cast<GLsizei>(sizes::attributeBytes(a.size, a.type));
    a.size = size;
    a.type = type;
    a.flags = flags;
    a.relative = relative;
}

bool VertexArrayMirror::anyInMemory(GLuint name, uint32_t first, uint32_t end) {
    const VertexArray* const va = find(name);
    for (uint32_t slot = first; slot < end; ++slot) {
        if (va->client[slot / 64] >> slot % 64 & 1) return true;
    }
    return false;
}

void VertexArrayMirror::moveToBuffer(GLuint name, uint32_t first, uint32_t end) {
    VertexArray* const va = find(name);
    for (uint32_t slot = first; slot < end; ++slot) va->set(va->client, slot, false);
}

void VertexArrayMirror::step(GLuint name, uint32_t slot, uint32_t as) {
    VertexArray* const va = find(name);
    va->slots[slot].stride = va->slots[as].bindingStride;
}

uint32_t VertexArrayMirror::slotOf(GLenum array) const {
    switch (array) {
    case GL_VERTEX_ARRAY: return kVertex;
    case GL_NORMAL_ARRAY: return kNormal;
    case GL_COLOR_ARRAY: return kColor;
    case GL_SECONDARY_COLOR_ARRAY: return kSecondaryColor;
    case GL_FOG_COORD_ARRAY: return kFogCoord;
    case GL_INDEX_ARRAY: return kIndex;
    case GL_EDGE_FLAG_ARRAY: return kEdgeFlag;
    case 0x8B9C: return kPointSize; // GL_POINT_SIZE_ARRAY_OES
    case GL_TEXTURE_COORD_ARRAY: return texCoordSlot();
    default: return kSlots;
    }
}

void VertexArrayMirror::push(GLbitfield mask) {
    if (depth_ >= kStack) return;
    Saved& s = stack_[depth_++];
    s = {};
    if (!(mask & GL_CLIENT_VERTEX_ARRAY_BIT)) return;
    void* memory = std::malloc(sizeof(VertexArray));
    if (!memory) return;
    s = {true, current_->name, arrayBuffer_, unit_, new (memory) VertexArray(*current_)};
}

void VertexArrayMirror::reset(GLbitfield mask) {
    if (!(mask & GL_CLIENT_VERTEX_ARRAY_BIT)) return;
    const GLuint name = current_->name;
    *current_ = VertexArray{};
    current_->name = name;
    arrayBuffer_ = 0;
    unit_ = 0;
}

void VertexArrayMirror::pop() {
    if (depth_ == 0) return;
    Saved& s = stack_[--depth_];
    if (!s.arrays) return;
    current_ = find(s.name);
    *current_ = *s.copy;
    arrayBuffer_ = s.arrayBuffer;
    unit_ = s.unit;
    std::free(s.copy);
    s.copy = nullptr;
}

} // namespace mural
