// Bindings of ARB_vertex_attrib_binding name buffers, never client memory. Divisors are those of both.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/array_watch.hpp"
#include "interposer/context.hpp"
#include "interposer/real_gl.hpp"

using namespace mural;
using namespace mural::client_arrays;

namespace {

GLuint currentArray(const ThreadState& t) { return t.context ? t.context->arrays.currentName() : 0; }

void divide(ThreadState& t, GLuint array, GLuint index, GLuint divisor) {
    if (!t.context || index >= kGenerics) return;
    VertexArrayMirror& mirror = t.context->arrays;
    if (mirror.knows(array) || gReal.glIsVertexArray(array)) mirror.divide(array, genericSlot(index), divisor);
}
template <class Encode, class Real> void divideNamed(Encode encode, Real real, GLuint array, GLuint index, GLuint divisor) {
    ThreadState& t = *tThread;
    encode(t, array, index, divisor);
    real(array, index, divisor);
    divide(t, array, index, divisor);
}
template <class Encode, class Real> void bindNamed(Encode encode, Real real, GLuint array, GLuint index, GLuint binding) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, array, index == binding ? uint32_t{kSlots} : genericSlot(index));
    encode(t, array, index, binding);
    real(array, index, binding);
}

} // namespace

extern "C" {

void mural_glVertexAttribDivisor(GLuint index, GLuint divisor) {
    ThreadState& t = *tThread;
    divide(t, currentArray(t), index, divisor);
    encode_glVertexAttribDivisor(t, index, divisor);
    gReal.glVertexAttribDivisor(index, divisor);
}
void mural_glVertexBindingDivisor(GLuint bindingindex, GLuint divisor) {
    ThreadState& t = *tThread;
    divide(t, currentArray(t), bindingindex, divisor);
    encode_glVertexBindingDivisor(t, bindingindex, divisor);
    gReal.glVertexBindingDivisor(bindingindex, divisor);
}
void mural_glVertexArrayBindingDivisor(GLuint vaobj, GLuint bindingindex, GLuint divisor) { divideNamed(encode_glVertexArrayBindingDivisor, gReal.glVertexArrayBindingDivisor, vaobj, bindingindex, divisor); }
void mural_glVertexArrayVertexBindingDivisorEXT(GLuint vaobj, GLuint bindingindex, GLuint divisor) { divideNamed(encode_glVertexArrayVertexBindingDivisorEXT, gReal.glVertexArrayVertexBindingDivisorEXT, vaobj, bindingindex, divisor); }
void mural_glVertexArrayVertexAttribDivisorEXT(GLuint vaobj, GLuint index, GLuint divisor) { divideNamed(encode_glVertexArrayVertexAttribDivisorEXT, gReal.glVertexArrayVertexAttribDivisorEXT, vaobj, index, divisor); }

void mural_glVertexAttribBinding(GLuint attribindex, GLuint bindingindex) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, currentArray(t), attribindex == bindingindex ? uint32_t{kSlots} : genericSlot(attribindex));
    encode_glVertexAttribBinding(t, attribindex, bindingindex);
    gReal.glVertexAttribBinding(attribindex, bindingindex);
}
void mural_glVertexArrayAttribBinding(GLuint vaobj, GLuint attribindex, GLuint bindingindex) { bindNamed(encode_glVertexArrayAttribBinding, gReal.glVertexArrayAttribBinding, vaobj, attribindex, bindingindex); }
void mural_glVertexArrayVertexAttribBindingEXT(GLuint vaobj, GLuint attribindex, GLuint bindingindex) { bindNamed(encode_glVertexArrayVertexAttribBindingEXT, gReal.glVertexArrayVertexAttribBindingEXT, vaobj, attribindex, bindingindex); }

void mural_glBindVertexBuffer(GLuint bindingindex, GLuint buffer, GLintptr offset, GLsizei stride) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, currentArray(t), genericSlot(bindingindex));
    bufferUsed(t, buffer);
    encode_glBindVertexBuffer(t, bindingindex, buffer, offset, stride);
    gReal.glBindVertexBuffer(bindingindex, buffer, offset, stride);
}
void mural_glBindVertexBuffers(GLuint first, GLsizei count, const GLuint* buffers, const GLintptr* offsets, const GLsizei* strides) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, currentArray(t), genericSlot(first), count > 0 ? uint32_t(count) : 0);
    const auto n = count > 0 ? uint64_t(count) : 0;
    buffersUsed(t, count, buffers);
    encode_glBindVertexBuffers(t, first, count, DataArg::of(buffers, n * 4), DataArg::of(offsets, n * 8), DataArg::of(strides, n * 4));
    gReal.glBindVertexBuffers(first, count, buffers, offsets, strides);
}

} // extern "C"
