// Wrappers of query objects. Each node counts its own part, so the result is combined from the replies of all nodes.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/copies.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"

using namespace mural;

namespace {

void begins(ThreadState& t, GLenum target, GLuint index, GLuint id) {
    if (!t.context || t.context->listPrimitive) return; // not valid in a list there
    t.context->queryIsAny.set(id, target == GL_ANY_SAMPLES_PASSED || target == GL_ANY_SAMPLES_PASSED_CONSERVATIVE);
    t.context->queryIsTimestamp.set(id, false);
    t.context->queryBegun.set(id, true);
    if (!t.context->compilingList) return t.context->answers.begun(target, index, id);
    ShareGroup& group = *t.context->group;
    group.listCounts.set(id, true);
    for (int i = 0; i < group.listConditionCount; ++i)
        if (group.listConditions[i] == id) copies::drawAll(t, "glBeginQuery");
}

void ends(ThreadState& t, GLenum target, GLuint index) {
    if (t.context && !t.context->compilingList) t.context->answers.ended(t, target, index, t.context->swaps);
}

// A node allocates parts of a query at its begin, so it receives only successful begins.
template <class Local, class Send> void beginQuery(GLenum target, GLuint index, GLuint id, Local&& local, Send&& send) {
    ThreadState& t = *tThread;
    if (!t.context) return local();
    if (!raisesNothing(*t.context, local)) return;
    begins(t, target, index, id);
    send(t);
}

bool isResult(GLenum pname) { return pname == GL_QUERY_RESULT || pname == GL_QUERY_RESULT_NO_WAIT; }

// A query without a begin has counted nothing, so the driver's own state is correct. A list begins its queries at every
// call.
bool neverBegun(const ThreadState& t, GLuint id) {
    return NameBits::known(id) && !t.context->queryBegun.get(id) && !t.context->group->listCounts.get(id);
}

// The result over all tiles. Returns false if the local driver's result applies.
bool result(ThreadState& t, const char* by, GLuint id, uint64_t& value) {
    // Programs compare time stamps with glGetInteger64v(GL_TIMESTAMP): both must use the same clock.
    if (t.context->queryIsTimestamp.get(id) || neverBegun(t, id)) return false;
    const bool keeps = !t.context->group->listCounts.get(id); // a list begins it at every call
    if (!keeps || !t.context->answers.find(id, t.context->swaps, value)) {
        if (!requestQuery(t, id, GL_QUERY_RESULT, value, by)) return false;
        if (keeps) t.context->answers.keep(id, value);
    }
    if (value > 1 && t.context->queryIsAny.get(id)) value = 1; // a boolean result was summed over several tiles
    return true;
}

template <class T> T clampTo(uint64_t value) {
    const uint64_t largest =
        static_cast<uint64_t>(sizeof(T) == 4 ? (static_cast<T>(-1) < 0 ? INT32_MAX : UINT32_MAX) : UINT64_MAX);
    return static_cast<T>(value < largest ? value : largest);
}

// Returns whether the program's own context counts as well. False during list compilation, because it has not drawn
// earlier frames.
bool drawsAllItself(const ThreadState& t) { return swapLocally() || t.context->drawsPixmap; }

// Executes the driver's own call first. It raises errors, and returns values that do not depend on rendering.
template <class T, class Local>
void intoMemory(ThreadState& t, const char* by, GLuint id, GLenum pname, T* params, Local local) {
    if (drawsAllItself(t) || !params || !isResult(pname)) return local();
    uint64_t value = 0;
    if (raisesNothing(*t.context, local) && result(t, by, id, value)) *params = clampTo<T>(value);
}

// The same into a buffer, in the program's own context and on the nodes.
template <class T, class Local>
void intoBuffer(ThreadState& t, const char* by, GLuint id, GLenum pname, GLuint buffer, GLintptr offset, Local local) {
    if (!raisesNothing(*t.context, local)) return;
    T written{};
    GLint before = 0;
    gReal.glGetIntegerv(GL_QUERY_BUFFER_BINDING, &before);
    gReal.glBindBuffer(GL_QUERY_BUFFER, buffer);
    gReal.glGetBufferSubData(GL_QUERY_BUFFER, offset, sizeof written, &written);
    uint64_t value = 0;
    if (isResult(pname) && result(t, by, id, value)) {
        written = clampTo<T>(value);
        writeOwnCopy(t, buffer, static_cast<uint64_t>(offset), &written, sizeof written);
    }
    gReal.glBindBuffer(GL_QUERY_BUFFER, static_cast<GLuint>(before));
    records::bufferBytes(t, buffer, static_cast<uint64_t>(offset), DataArg::of(&written, sizeof written));
}

template <class T, class Local>
void queryObject(GLuint id, GLenum pname, T* params, Local local, const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return local();
    if (t.context->queryBuffer == 0) return intoMemory(t, by, id, pname, params, local);
    intoBuffer<T>(t, by, id, pname, t.context->queryBuffer, reinterpret_cast<GLintptr>(params), local);
}

template <class T, class Local>
void queryBufferObject(GLuint id, GLuint buffer, GLenum pname, GLintptr offset, Local local,
                       const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return local();
    bufferUsed(t, buffer, by);
    intoBuffer<T>(t, by, id, pname, buffer, offset, local);
}

bool isInverted(GLenum mode) {
    return mode == GL_QUERY_WAIT_INVERTED || mode == GL_QUERY_NO_WAIT_INVERTED ||
           mode == GL_QUERY_BY_REGION_WAIT_INVERTED || mode == GL_QUERY_BY_REGION_NO_WAIT_INVERTED;
}

} // namespace

extern "C" {

void mural_glBeginQuery(GLenum target, GLuint id) {
    beginQuery(
        target, 0, id, [=] { gReal.glBeginQuery(target, id); },
        [=](ThreadState& t) { encode_glBeginQuery(t, target, id); });
}
void mural_glEndQuery(GLenum target) {
    ThreadState& t = *tThread;
    encode_glEndQuery(t, target);
    gReal.glEndQuery(target);
    ends(t, target, 0);
}
void mural_glEndQueryIndexed(GLenum target, GLuint index) {
    ThreadState& t = *tThread;
    encode_glEndQueryIndexed(t, target, index);
    gReal.glEndQueryIndexed(target, index);
    ends(t, target, index);
}
void mural_glBeginQueryIndexed(GLenum target, GLuint index, GLuint id) {
    beginQuery(
        target, index, id, [=] { gReal.glBeginQueryIndexed(target, index, id); },
        [=](ThreadState& t) { encode_glBeginQueryIndexed(t, target, index, id); });
}
void mural_glDeleteQueries(GLsizei n, const GLuint* ids) {
    ThreadState& t = *tThread;
    if (t.context && ids)
        for (GLsizei i = 0; i < n; ++i) t.context->queryBegun.set(ids[i], false); // the name may be reused
    encode_glDeleteQueries(t, n, DataArg::of(ids, n > 0 ? uint64_t(n) * 4 : 0));
    gReal.glDeleteQueries(n, ids);
}
void mural_glQueryCounter(GLuint id, GLenum target) {
    ThreadState& t = *tThread;
    if (t.context) t.context->queryIsTimestamp.set(id, target == GL_TIMESTAMP);
    encode_glQueryCounter(t, id, target);
    gReal.glQueryCounter(id, target);
}

} // extern "C"

namespace {

void sendCondition(ThreadState& t, const char* by, GLuint id) {
    uint64_t value = 0;
    if (t.context->queryBegun.get(id) && result(t, by, id, value)) records::queryKnown(t, id, value != 0);
}

// Records the conditions that a compiled list evaluates at each call.
void noteListCondition(ThreadState& t, GLuint id) {
    ShareGroup& group = *t.context->group;
    group.listConditional.set(t.context->compiledList, true);
    if (group.listCounts.get(id) || !NameBits::known(id)) copies::drawAll(t, "glBeginConditionalRender");
    for (int i = 0; i < group.listConditionCount; ++i)
        if (group.listConditions[i] == id) return;
    if (group.listConditionCount < ShareGroup::kConditions) group.listConditions[group.listConditionCount++] = id;
}

} // namespace

namespace mural {
void sendListConditions(ThreadState& t, const char* by) {
    // each node has the result itself
    if (!capturing(t) || t.context->compilingList || t.context->group->allDrawn) return;
    const ShareGroup& group = *t.context->group;
    for (int i = 0; i < group.listConditionCount; ++i) sendCondition(t, by, group.listConditions[i]);
}
} // namespace mural

extern "C" {

// A node has the results of its own tiles only, but its draws may depend on all of them. The result of the whole
// picture is fetched and sent to all nodes; for a display list, at its call.
void mural_glBeginConditionalRender(GLuint id, GLenum mode) {
    ThreadState& t = *tThread;
    if (!capturing(t) || t.context->compilingList) {
        if (capturing(t) && !t.context->listPrimitive) {
            noteListCondition(t, id);
            sendCondition(t, __func__, id); // the list may be executed during compilation
        }
        encode_glBeginConditionalRender(t, id, mode);
        return gReal.glBeginConditionalRender(id, mode);
    }
    if (!raisesNothing(*t.context, [&] { gReal.glBeginConditionalRender(id, mode); })) return;
    if (neverBegun(t, id)) return encode_glBeginConditionalRender(t, id, mode); // all drivers agree on its result
    uint64_t value = 1;
    result(t, __func__, id, value);
    records::beginConditional(t, (value != 0) != isInverted(mode));
}

void mural_glGetQueryObjectiv(GLuint id, GLenum pname, GLint* params) {
    queryObject(id, pname, params, [=] { gReal.glGetQueryObjectiv(id, pname, params); });
}
void mural_glGetQueryObjectuiv(GLuint id, GLenum pname, GLuint* params) {
    queryObject(id, pname, params, [=] { gReal.glGetQueryObjectuiv(id, pname, params); });
}
void mural_glGetQueryObjecti64v(GLuint id, GLenum pname, GLint64* params) {
    queryObject(id, pname, params, [=] { gReal.glGetQueryObjecti64v(id, pname, params); });
}
void mural_glGetQueryObjectui64v(GLuint id, GLenum pname, GLuint64* params) {
    queryObject(id, pname, params, [=] { gReal.glGetQueryObjectui64v(id, pname, params); });
}
void mural_glGetQueryBufferObjectiv(GLuint id, GLuint buffer, GLenum pname, GLintptr offset) {
    queryBufferObject<GLint>(id, buffer, pname, offset,
                             [=] { gReal.glGetQueryBufferObjectiv(id, buffer, pname, offset); });
}
void mural_glGetQueryBufferObjectuiv(GLuint id, GLuint buffer, GLenum pname, GLintptr offset) {
    queryBufferObject<GLuint>(id, buffer, pname, offset,
                              [=] { gReal.glGetQueryBufferObjectuiv(id, buffer, pname, offset); });
}
void mural_glGetQueryBufferObjecti64v(GLuint id, GLuint buffer, GLenum pname, GLintptr offset) {
    queryBufferObject<GLint64>(id, buffer, pname, offset,
                               [=] { gReal.glGetQueryBufferObjecti64v(id, buffer, pname, offset); });
}
void mural_glGetQueryBufferObjectui64v(GLuint id, GLuint buffer, GLenum pname, GLintptr offset) {
    queryBufferObject<GLuint64>(id, buffer, pname, offset,
                                [=] { gReal.glGetQueryBufferObjectui64v(id, buffer, pname, offset); });
}

} // extern "C"
