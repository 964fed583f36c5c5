// Wrappers of ARB_vertex_attrib_binding. A binding refers to a buffer. A binding without a buffer leaves an array in
// client memory unchanged. Divisors apply to both.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/memory/array_watch.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"

using namespace mural;
using namespace mural::client_arrays;

namespace {

GLuint currentArray(const ThreadState& t) { return t.context ? t.context->arrays.currentName() : 0; }

// The mirror stores a divisor that the program's own context accepts. OpenGL ES, for example, accepts no divisor for
// bindings of vertex array 0. The driver's error is queried only if the divisor differs from the mirror's.
template <class Local, class Send> void divide(GLuint array, GLuint index, GLuint divisor, Local&& local, Send&& send) {
    ThreadState& t = *tThread;
    if (!t.context) return local();
    VertexArrayMirror& mirror = t.context->arrays;
    const bool isChanged =
        index >= kGenerics || !mirror.knows(array) || mirror.divisor(array, genericSlot(index)) != divisor;
    if (!isChanged)
        local();
    else if (!raisesNothing(*t.context, local))
        return;
    if (isChanged && index < kGenerics) mirror.divide(array, genericSlot(index), divisor);
    send(t);
}
template <class Encode, class Real>
void divideNamed(Encode encode, Real real, GLuint array, GLuint index, GLuint divisor) {
    divide(
        array, index, divisor, [=] { real(array, index, divisor); },
        [=](ThreadState& t) { encode(t, array, index, divisor); });
}
template <class Encode, class Real> void divideBound(Encode encode, Real real, GLuint index, GLuint divisor) {
    divide(
        currentArray(*tThread), index, divisor, [=] { real(index, divisor); },
        [=](ThreadState& t) { encode(t, index, divisor); });
}
template <class Local, class Send> void bindTo(GLuint array, GLuint index, GLuint binding, Local&& local, Send&& send) {
    ThreadState& t = *tThread;
    const bool named = t.context && index < kGenerics && binding < kGenerics && t.context->arrays.knows(array);
    const auto inMemory = [&](GLuint of) {
        return t.context->arrays.anyInMemory(array, genericSlot(of), genericSlot(of) + 1);
    };
    if (named && inMemory(index) && inMemory(binding)) { // it keeps its memory, with the binding's divisor
        if (!raisesNothing(*t.context, local)) return;
        t.context->arrays.step(array, genericSlot(index), genericSlot(binding));
        return send(t);
    }
    const ArrayWatch watch(t, array, index == binding ? uint32_t{kSlots} : genericSlot(index));
    send(t);
    local();
}
template <class Encode, class Real>
void bindNamed(Encode encode, Real real, GLuint array, GLuint index, GLuint binding) {
    bindTo(
        array, index, binding, [=] { real(array, index, binding); },
        [=](ThreadState& t) { encode(t, array, index, binding); });
}

} // namespace

extern "C" {

void mural_glVertexAttribDivisor(GLuint index, GLuint divisor) {
    divideBound(encode_glVertexAttribDivisor, gReal.glVertexAttribDivisor, index, divisor);
}
void mural_glVertexBindingDivisor(GLuint bindingindex, GLuint divisor) {
    divideBound(encode_glVertexBindingDivisor, gReal.glVertexBindingDivisor, bindingindex, divisor);
}
void mural_glVertexArrayBindingDivisor(GLuint vaobj, GLuint bindingindex, GLuint divisor) {
    divideNamed(encode_glVertexArrayBindingDivisor, gReal.glVertexArrayBindingDivisor, vaobj, bindingindex, divisor);
}
void mural_glVertexArrayVertexBindingDivisorEXT(GLuint vaobj, GLuint bindingindex, GLuint divisor) {
    divideNamed(encode_glVertexArrayVertexBindingDivisorEXT, gReal.glVertexArrayVertexBindingDivisorEXT, vaobj,
                bindingindex, divisor);
}
void mural_glVertexArrayVertexAttribDivisorEXT(GLuint vaobj, GLuint index, GLuint divisor) {
    divideNamed(encode_glVertexArrayVertexAttribDivisorEXT, gReal.glVertexArrayVertexAttribDivisorEXT, vaobj, index,
                divisor);
}

void mural_glVertexAttribBinding(GLuint attribindex, GLuint bindingindex) {
    bindTo(
        currentArray(*tThread), attribindex, bindingindex,
        [=] { gReal.glVertexAttribBinding(attribindex, bindingindex); },
        [=](ThreadState& t) { encode_glVertexAttribBinding(t, attribindex, bindingindex); });
}
void mural_glVertexArrayAttribBinding(GLuint vaobj, GLuint attribindex, GLuint bindingindex) {
    bindNamed(encode_glVertexArrayAttribBinding, gReal.glVertexArrayAttribBinding, vaobj, attribindex, bindingindex);
}
void mural_glVertexArrayVertexAttribBindingEXT(GLuint vaobj, GLuint attribindex, GLuint bindingindex) {
    bindNamed(encode_glVertexArrayVertexAttribBindingEXT, gReal.glVertexArrayVertexAttribBindingEXT, vaobj, attribindex,
              bindingindex);
}

void mural_glBindVertexBuffer(GLuint bindingindex, GLuint buffer, GLintptr offset, GLsizei stride) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, currentArray(t), genericSlot(bindingindex));
    bufferUsed(t, buffer);
    encode_glBindVertexBuffer(t, bindingindex, buffer, offset, stride);
    gReal.glBindVertexBuffer(bindingindex, buffer, offset, stride);
}
void mural_glBindVertexBuffers(GLuint first, GLsizei count, const GLuint* buffers, const GLintptr* offsets,
                               const GLsizei* strides) {
    ThreadState& t = *tThread;
    const ArrayWatch watch(t, currentArray(t), genericSlot(first), count > 0 ? uint32_t(count) : 0);
    const auto n = count > 0 ? uint64_t(count) : 0;
    buffersUsed(t, count, buffers);
    encode_glBindVertexBuffers(t, first, count, DataArg::of(buffers, n * 4), DataArg::of(offsets, n * 8),
                               DataArg::of(strides, n * 4));
    gReal.glBindVertexBuffers(first, count, buffers, offsets, strides);
}

} // extern "C"
