// Wrappers of draws from vertex arrays.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/array_element.hpp"
#include "interposer/wrappers/client_draw.hpp"
#include "interposer/wrappers/validate_only_draws.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/sizes/vertex_types.hpp"
#include "streamcodec/wire/control_records.hpp"

using namespace mural;

namespace {

VertexRange arraysRange(GLint first, GLsizei count, GLsizei instances = 1, GLuint baseInstance = 0) {
    return {first, int64_t{first} + count - 1, instances > 0 ? static_cast<uint32_t>(instances) : 0, baseInstance};
}

// IBM_multimode_draw_arrays: modes are `stride` bytes apart.
GLenum modeAt(const GLenum* modes, GLsizei index, GLint stride) {
    GLenum mode = 0;
    std::memcpy(&mode, reinterpret_cast<const std::byte*>(modes) + ptrdiff_t{index} * stride, sizeof mode);
    return mode;
}

// Sends everything that must precede a draw without indices.
inline void prepareArrays(ThreadState& t, GLint first, GLsizei count, GLsizei instances = 1, GLuint baseInstance = 0) {
    Context* c = t.context;
    if (!c) return;
    beforeDraw(t, *c);
    if (c->arrays.anyClient()) [[unlikely]]
        sendClientArrays(t, *c, arraysRange(first, count, instances, baseInstance));
}

// Whether indices are in client memory.
bool inMemory(const Context& c, const void* indices) {
    return reinterpret_cast<uintptr_t>(indices) >= c.indicesInMemoryFrom && elementBufferBinding() == 0;
}

// The same for a draw with indices; returns their source.
DataArg prepareElements(ThreadState& t, GLsizei count, GLenum type, const void* indices, GLint baseVertex = 0,
                        GLsizei instances = 1, GLuint baseInstance = 0) {
    Context* c = t.context;
    if (!c) return {};
    beforeDraw(t, *c);
    if (c->arrays.anyClient()) [[unlikely]] {
        VertexRange range = indexedRange(t, *c, count, type, indices, baseVertex);
        range.instances = instances > 0 ? static_cast<uint32_t>(instances) : 0;
        range.baseInstance = baseInstance;
        sendClientArrays(t, *c, range);
    }
    if (!inMemory(*c, indices)) return DataArg::offset(indices);
    return DataArg::of(indices, count > 0 ? uint64_t(count) * sizes::typeBytes(type) : 0);
}

// Only compatibility contexts allow client memory for indirect draws.
DataArg indirectSource(ThreadState& t, const void* indirect, bool withElements, GLsizei drawCount, GLsizei stride) {
    Context* c = t.context;
    if (!c) return {};
    beforeDraw(t, *c);
    GLint buffer = 0;
    gReal.glGetIntegerv(GL_DRAW_INDIRECT_BUFFER_BINDING, &buffer);
    const bool clientMemory = c->api == wire::Api::Desktop && !c->core;
    if (buffer != 0 || !clientMemory) return DataArg::offset(indirect);
    return DataArg::of(indirect, sizes::indirectBytes(withElements, drawCount, stride));
}

void indirectClientArrays(ThreadState& t, const DataArg& source, bool withElements, GLenum indexType, GLsizei drawCount,
                          GLsizei stride) {
    Context* c = t.context;
    if (!c || !c->arrays.anyClient() || drawCount <= 0) return;
    const size_t bytes = sizes::indirectBytes(withElements, drawCount, stride);
    const void* commands = source.pointer;
    if (source.isOffset) {
        void* copy = scratchMemory(t, bytes);
        if (!copy) return;
        gReal.glGetBufferSubData(GL_DRAW_INDIRECT_BUFFER, reinterpret_cast<GLintptr>(source.pointer),
                                 static_cast<GLsizeiptr>(bytes), copy);
        commands = copy;
    }
    const size_t step = stride > 0     ? static_cast<size_t>(stride)
                        : withElements ? sizes::kDrawElementsCommandBytes
                                       : sizes::kDrawArraysCommandBytes;
    VertexRange all{INT64_MAX, -1, 0, 0};
    for (GLsizei i = 0; i < drawCount; ++i) {
        GLuint word[5] = {};
        std::memcpy(word, static_cast<const std::byte*>(commands) + static_cast<size_t>(i) * step,
                    withElements ? 20 : 16);
        VertexRange one = arraysRange(static_cast<GLint>(word[2]), static_cast<GLsizei>(word[0]));
        if (withElements)
            one = indexedRange(t, *c, static_cast<GLsizei>(word[0]), indexType,
                               reinterpret_cast<const void*>(uintptr_t{word[2]} * sizes::typeBytes(indexType)),
                               static_cast<GLint>(word[3]));
        if (one.last < one.first) continue;
        if (one.first < all.first) all.first = one.first;
        if (one.last > all.last) all.last = one.last;
        const GLuint base = word[withElements ? 4 : 3];
        if (base + word[1] > all.instances) all.instances = base + word[1];
    }
    sendClientArrays(t, *c, all);
}

// Executes the draw first in the driver, which counts vertices during transform feedback and may reject the draw. The
// nodes' drivers may not count, and would then draw although the call is an error. Returns false if nothing is counted;
// the caller then executes the draw.
template <class Local, class Send> bool drawnCounted(ThreadState& t, Local&& local, Send&& send) {
    if (!t.drawLocally || !t.context || !t.context->drawsFeedback) return false;
    if (raisesNothing(*t.context, local)) send();
    return true;
}

// Returns the number of draws for the driver: 0 if all are valid. If any is invalid the driver receives all of them,
// and executes none.
GLsizei quietDraws(const ThreadState& t, const GLsizei* count, GLsizei drawcount) {
    if (t.drawLocally || drawcount < 0) return drawcount;
    for (GLsizei i = 0; i < drawcount; ++i)
        if (count[i] < 0) return drawcount;
    return 0;
}

} // namespace

extern "C" {

void mural_glDrawArrays(GLenum mode, GLint first, GLsizei count) {
    ThreadState& t = *tThread;
    const auto send = [&] {
        prepareArrays(t, first, count);
        encode_glDrawArrays(t, mode, first, count);
    };
    if (drawnCounted(
            t, [&] { gReal.glDrawArrays(mode, first, count); }, send))
        return;
    send();
    gReal.glDrawArrays(mode, first, quiet::count(t, count));
}
void mural_glDrawArraysInstanced(GLenum mode, GLint first, GLsizei count, GLsizei instancecount) {
    ThreadState& t = *tThread;
    const auto send = [&] {
        prepareArrays(t, first, first < 0 ? 0 : count, instancecount);
        encode_glDrawArraysInstanced(t, mode, first, count, instancecount);
    };
    if (drawnCounted(
            t, [&] { gReal.glDrawArraysInstanced(mode, first, count, instancecount); }, send))
        return;
    send();
    gReal.glDrawArraysInstanced(mode, first, quiet::count(t, count), instancecount);
}
void mural_glDrawArraysInstancedBaseInstance(GLenum mode, GLint first, GLsizei count, GLsizei instancecount,
                                             GLuint baseinstance) {
    ThreadState& t = *tThread;
    prepareArrays(t, first, first < 0 ? 0 : count, instancecount, baseinstance);
    encode_glDrawArraysInstancedBaseInstance(t, mode, first, count, instancecount, baseinstance);
    gReal.glDrawArraysInstancedBaseInstance(mode, first, quiet::count(t, count), instancecount, baseinstance);
}
void mural_glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    ThreadState& t = *tThread;
    const auto send = [&] { encode_glDrawElements(t, mode, count, type, prepareElements(t, count, type, indices)); };
    if (drawnCounted(
            t, [&] { gReal.glDrawElements(mode, count, type, indices); }, send))
        return;
    send();
    gReal.glDrawElements(mode, quiet::count(t, count), type, indices);
}
void mural_glDrawElementsBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices, GLint basevertex) {
    ThreadState& t = *tThread;
    encode_glDrawElementsBaseVertex(t, mode, count, type, prepareElements(t, count, type, indices, basevertex),
                                    basevertex);
    gReal.glDrawElementsBaseVertex(mode, quiet::count(t, count), type, indices, basevertex);
}
void mural_glDrawElementsInstanced(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                   GLsizei instancecount) {
    ThreadState& t = *tThread;
    encode_glDrawElementsInstanced(t, mode, count, type, prepareElements(t, count, type, indices, 0, instancecount),
                                   instancecount);
    gReal.glDrawElementsInstanced(mode, quiet::count(t, count), type, indices, instancecount);
}
void mural_glDrawElementsInstancedBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                             GLsizei instancecount, GLint basevertex) {
    ThreadState& t = *tThread;
    encode_glDrawElementsInstancedBaseVertex(t, mode, count, type,
                                             prepareElements(t, count, type, indices, basevertex, instancecount),
                                             instancecount, basevertex);
    gReal.glDrawElementsInstancedBaseVertex(mode, quiet::count(t, count), type, indices, instancecount, basevertex);
}
void mural_glDrawElementsInstancedBaseInstance(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                               GLsizei instancecount, GLuint baseinstance) {
    ThreadState& t = *tThread;
    encode_glDrawElementsInstancedBaseInstance(t, mode, count, type,
                                               prepareElements(t, count, type, indices, 0, instancecount, baseinstance),
                                               instancecount, baseinstance);
    gReal.glDrawElementsInstancedBaseInstance(mode, quiet::count(t, count), type, indices, instancecount, baseinstance);
}
void mural_glDrawElementsInstancedBaseVertexBaseInstance(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                                         GLsizei instancecount, GLint basevertex, GLuint baseinstance) {
    ThreadState& t = *tThread;
    encode_glDrawElementsInstancedBaseVertexBaseInstance(
        t, mode, count, type, prepareElements(t, count, type, indices, basevertex, instancecount, baseinstance),
        instancecount, basevertex, baseinstance);
    gReal.glDrawElementsInstancedBaseVertexBaseInstance(mode, quiet::count(t, count), type, indices, instancecount,
                                                        basevertex, baseinstance);
}
// Programs violate the promised range start … end, so the actual indices count.
void mural_glDrawRangeElements(GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type, const void* indices) {
    ThreadState& t = *tThread;
    encode_glDrawRangeElements(t, mode, start, end, count, type, prepareElements(t, count, type, indices));
    gReal.glDrawRangeElements(mode, start, end, quiet::count(t, count), type, indices);
}
void mural_glDrawRangeElementsBaseVertex(GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                         const void* indices, GLint basevertex) {
    ThreadState& t = *tThread;
    encode_glDrawRangeElementsBaseVertex(t, mode, start, end, count, type,
                                         prepareElements(t, count, type, indices, basevertex), basevertex);
    gReal.glDrawRangeElementsBaseVertex(mode, start, end, quiet::count(t, count), type, indices, basevertex);
}

// Sent as separate draws, each with its own mode.
void mural_glMultiModeDrawArraysIBM(const GLenum* mode, const GLint* first, const GLsizei* count, GLsizei primcount,
                                    GLint modestride) {
    for (GLsizei i = 0; i < primcount; ++i) {
        if (count[i] > 0) mural_glDrawArrays(modeAt(mode, i, modestride), first[i], count[i]);
    }
}
void mural_glMultiModeDrawElementsIBM(const GLenum* mode, const GLsizei* count, GLenum type, const void* const* indices,
                                      GLsizei primcount, GLint modestride) {
    for (GLsizei i = 0; i < primcount; ++i) {
        if (count[i] > 0) mural_glDrawElements(modeAt(mode, i, modestride), count[i], type, indices[i]);
    }
}
void mural_glMultiDrawArrays(GLenum mode, const GLint* first, const GLsizei* count, GLsizei drawcount) {
    ThreadState& t = *tThread;
    const auto n = drawcount > 0 ? uint64_t(drawcount) : 0;
    if (Context* c = t.context) {
        beforeDraw(t, *c);
        if (c->arrays.anyClient() && n > 0) {
            VertexRange all{INT64_MAX, -1, 1, 0};
            for (uint64_t i = 0; i < n; ++i) {
                if (count[i] <= 0) continue;
                if (first[i] < all.first) all.first = first[i];
                if (int64_t{first[i]} + count[i] - 1 > all.last) all.last = int64_t{first[i]} + count[i] - 1;
            }
            sendClientArrays(t, *c, all);
        }
    }
    encode_glMultiDrawArrays(t, mode, DataArg::of(first, 4 * n), DataArg::of(count, 4 * n), drawcount);
    gReal.glMultiDrawArrays(mode, first, count, quietDraws(t, count, drawcount));
}

} // extern "C"

namespace {

// Indices of glMultiDrawElements: u32 kind, u32 0, then offsets (kind 1, u64 each) or the concatenated index lists
// (kind 0).
DataArg multiIndices(ThreadState& t, const GLsizei* count, GLenum type, const void* const* indices, GLsizei drawcount,
                     const GLint* basevertex) {
    Context* c = t.context;
    if (!c || drawcount <= 0) return {};
    beforeDraw(t, *c);
    const auto n = static_cast<size_t>(drawcount);
    const uint32_t bytes = sizes::typeBytes(type);
    if (c->arrays.anyClient()) {
        VertexRange all{INT64_MAX, -1, 1, 0};
        for (size_t i = 0; i < n; ++i) {
            const VertexRange one = indexedRange(t, *c, count[i], type, indices[i], basevertex ? basevertex[i] : 0);
            if (one.last < one.first) continue;
            if (one.first < all.first) all.first = one.first;
            if (one.last > all.last) all.last = one.last;
        }
        sendClientArrays(t, *c, all);
    }
    bool offsets = true;
    for (size_t i = 0; i < n; ++i) offsets = offsets && !(count[i] > 0 && inMemory(*c, indices[i]));
    size_t total = 8;
    for (size_t i = 0; i < n; ++i) total += offsets ? 8 : count[i] > 0 ? static_cast<size_t>(count[i]) * bytes : 0;
    auto* out = static_cast<std::byte*>(scratchMemory(t, total));
    if (!out) return {};
    const uint32_t head[2] = {offsets ? 1u : 0u, 0};
    std::memcpy(out, head, 8);
    std::byte* p = out + 8;
    for (size_t i = 0; i < n; ++i) {
        if (offsets) {
            const auto offset = reinterpret_cast<uint64_t>(indices[i]);
            std::memcpy(p, &offset, 8);
            p += 8;
        } else if (count[i] > 0) {
            std::memcpy(p, indices[i], static_cast<size_t>(count[i]) * bytes);
            p += static_cast<size_t>(count[i]) * bytes;
        }
    }
    return DataArg::of(out, total);
}

} // namespace

extern "C" {

void mural_glMultiDrawElements(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                               GLsizei drawcount) {
    ThreadState& t = *tThread;
    const DataArg data = multiIndices(t, count, type, indices, drawcount, nullptr);
    encode_glMultiDrawElements(t, mode, DataArg::of(count, drawcount > 0 ? 4 * uint64_t(drawcount) : 0), type, data,
                               drawcount);
    gReal.glMultiDrawElements(mode, count, type, indices, quietDraws(t, count, drawcount));
}
void mural_glMultiDrawElementsBaseVertex(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                         GLsizei drawcount, const GLint* basevertex) {
    ThreadState& t = *tThread;
    const uint64_t bytes = drawcount > 0 ? 4 * uint64_t(drawcount) : 0;
    const DataArg data = multiIndices(t, count, type, indices, drawcount, basevertex);
    encode_glMultiDrawElementsBaseVertex(t, mode, DataArg::of(count, bytes), type, data, drawcount,
                                         DataArg::of(basevertex, bytes));
    gReal.glMultiDrawElementsBaseVertex(mode, count, type, indices, quietDraws(t, count, drawcount), basevertex);
}
void mural_glDrawArraysIndirect(GLenum mode, const void* indirect) {
    ThreadState& t = *tThread;
    const DataArg source = indirectSource(t, indirect, false, 1, 0);
    indirectClientArrays(t, source, false, 0, 1, 0);
    encode_glDrawArraysIndirect(t, mode, source);
    if (t.drawLocally || quiet::indirectIsWrong(t, indirect, sizes::indirectBytes(false, 1, 0)))
        gReal.glDrawArraysIndirect(mode, indirect);
    else
        quiet::drawIndirect(t, mode, indirect, 0);
}
void mural_glDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect) {
    ThreadState& t = *tThread;
    const DataArg source = indirectSource(t, indirect, true, 1, 0);
    indirectClientArrays(t, source, true, type, 1, 0);
    encode_glDrawElementsIndirect(t, mode, type, source);
    if (t.drawLocally || quiet::indirectIsWrong(t, indirect, sizes::indirectBytes(true, 1, 0)))
        gReal.glDrawElementsIndirect(mode, type, indirect);
    else
        quiet::drawElementsIndirect(t, mode, type, indirect, 0);
}
void mural_glMultiDrawArraysIndirect(GLenum mode, const void* indirect, GLsizei drawcount, GLsizei stride) {
    ThreadState& t = *tThread;
    const DataArg source = indirectSource(t, indirect, false, drawcount, stride);
    indirectClientArrays(t, source, false, 0, drawcount, stride);
    encode_glMultiDrawArraysIndirect(t, mode, source, drawcount, stride);
    if (t.drawLocally || drawcount < 0 ||
        quiet::indirectIsWrong(t, indirect, sizes::indirectBytes(false, drawcount, stride)))
        gReal.glMultiDrawArraysIndirect(mode, indirect, drawcount, stride);
    else
        quiet::drawIndirect(t, mode, indirect, stride);
}
void mural_glMultiDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect, GLsizei drawcount,
                                       GLsizei stride) {
    ThreadState& t = *tThread;
    const DataArg source = indirectSource(t, indirect, true, drawcount, stride);
    indirectClientArrays(t, source, true, type, drawcount, stride);
    encode_glMultiDrawElementsIndirect(t, mode, type, source, drawcount, stride);
    if (t.drawLocally || drawcount < 0 ||
        quiet::indirectIsWrong(t, indirect, sizes::indirectBytes(true, drawcount, stride)))
        gReal.glMultiDrawElementsIndirect(mode, type, indirect, drawcount, stride);
    else
        quiet::drawElementsIndirect(t, mode, type, indirect, stride);
}
void mural_glArrayElement(GLint i) {
    ThreadState& t = *tThread;
    if (Context* c = t.context; c && c->arrays.anyClient())
        sendElement(t, *c, i);
    else
        encode_glArrayElement(t, i);
    if (t.vertexLocally) gReal.glArrayElement(i);
}

} // extern "C"
