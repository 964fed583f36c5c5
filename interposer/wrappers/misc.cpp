// Display lists, synchronisation, programs, and corrected query results.
#include <cstring>
#include <utility>

#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/client_draw.hpp"
#include "interposer/context/context.hpp"
#include "interposer/context/extensions.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/memory/shader_writes.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/program_layout.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/size_expressions.hpp"

using namespace mural;

namespace {
void publish(ThreadState& t) {
    if (Session* s = Session::current(); s && t.context) s->publish(t, false);
}

// Calls a list within a discarded primitive, so that commands invalid there raise their errors. `closes`: the list
// contains the glEnd.
template <class Call> void callBetweenBeginAndEnd(Context& c, bool closes, Call&& call) {
    const uint32_t mode = c.openPrimitive;
    gReal.glEnd();
    const bool discards = gReal.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (!discards) gReal.glEnable(GL_RASTERIZER_DISCARD);
    raisesNothing(c, [&] {
        gReal.glBegin(mode);
        call();
        if (!closes) gReal.glEnd();
    });
    if (!discards) gReal.glDisable(GL_RASTERIZER_DISCARD);
    if (closes)
        c.openPrimitive = kNoPrimitive;
    else
        gReal.glBegin(mode);
}

// Call after a list with an unmatched glBegin. The mode of the local primitive is irrelevant, because nothing is drawn.
void primitiveOpened(ThreadState& t, bool locallyOpen) {
    if (!locallyOpen) gReal.glBegin(GL_POINTS);
    if (t.context) t.context->openPrimitive = GL_POINTS;
}

// Calls a list for its state changes without its draws. If a bitmap of the list may move the raster position, the draws
// are executed as well, because a discarded bitmap does not move it.
template <class Call> void callWithoutDrawing(ThreadState& t, bool movesRaster, bool opens, bool closes, Call&& call) {
    if (t.drawLocally) {
        call();
        if (opens) primitiveOpened(t, true);
        return;
    }
    if (t.context && t.context->openPrimitive != kNoPrimitive && t.context->version >= 30)
        return callBetweenBeginAndEnd(*t.context, closes, call);
    const PrimitivePause pause(t); // otherwise the list's vertices would join the primitive
    if (movesRaster || !t.context || t.context->version < 30) {
        ownDrawingBegins();
        call();
        if (opens) primitiveOpened(t, true);
        return ownDrawingEnds();
    }
    const bool discards = gReal.glIsEnabled(GL_RASTERIZER_DISCARD);
    if (!discards) gReal.glEnable(GL_RASTERIZER_DISCARD);
    call();
    if (opens) gReal.glEnd();
    if (!gReal.glIsEnabled(GL_RASTERIZER_DISCARD)) { // the list has ended the primitive
        ownDrawingBegins();
        ownDrawingEnds();
    }
    if (!discards) gReal.glDisable(GL_RASTERIZER_DISCARD);
    ++t.context->listsUnflushed;
    if (opens) primitiveOpened(t, false);
}

// Enables drawing for compile-and-execute, selection and feedback.
void setDrawing(bool& draws, bool now) {
    if (draws == now) return;
    draws = now;
    (now ? ownDrawingBegins : ownDrawingEnds)();
}

void listEndsPrimitive(Context& c) {
    if (!c.listPrimitive) c.group->listCloses.set(c.compiledList, true);
    c.listPrimitive = false;
}

void drawFeedback(ThreadState& t, bool now) {
    setDrawing(t.context->drawsFeedback, now);
    refreshDrawLocally(t);
}

// A list that calls other lists may move the raster position, depending on their content at the call.
void noteListCall(const ThreadState& t, bool conditional) {
    if (!t.context || !t.context->compilingList) return;
    ShareGroup& group = *t.context->group;
    group.listMovesRaster.set(t.context->compiledList, true);
    if (conditional) group.listConditional.set(t.context->compiledList, true);
}
void notePrimitives(Context& c, GLuint called) {
    if (!c.compilingList) return;
    if (c.group->listCloses.get(called)) listEndsPrimitive(c);
    if (c.group->listOpens.get(called)) c.listPrimitive = true;
}

// Whether both sides support SPIR-V.
bool takesModules(Context& c) {
    for (GLint i = 0; i < extensionCount(c); ++i) {
        if (!std::strcmp(extensionAt(c, static_cast<GLuint>(i)), "GL_ARB_gl_spirv")) return true;
    }
    return false;
}
GLint textBytes(const GLchar* text, GLint length) {
    return length < 0 ? static_cast<GLint>(std::strlen(text)) : length;
}

bool isFront(GLenum buffer) {
    return buffer == GL_FRONT || buffer == GL_FRONT_LEFT || buffer == GL_FRONT_RIGHT || buffer == GL_FRONT_AND_BACK ||
           buffer == GL_LEFT || buffer == GL_RIGHT;
}
} // namespace

extern "C" {

// The program's own context compiles complete lists: they still draw if the head is lost.
void mural_glNewList(GLuint list, GLenum mode) {
    ThreadState& t = *tThread;
    if (!t.context) return gReal.glNewList(list, mode);
    if (!raisesNothing(*t.context, [&] { gReal.glNewList(list, mode); })) return;
    encode_glNewList(t, list, mode);
    t.context->compilingList = true;
    t.context->compiledList = list;
    setDrawing(t.context->drawsList, mode == GL_COMPILE_AND_EXECUTE);
    ShareGroup& group = *t.context->group;
    group.listMovesRaster.set(list, false);
    group.listConditional.set(list, false);
    group.listOpens.set(list, false);
    group.listCloses.set(list, false);
    group.listsChange = group.listsChange || group.listCompiled.get(list);
    group.listCompiled.set(list, true);
    refreshDrawLocally(t);
}
void mural_glEndList() {
    ThreadState& t = *tThread;
    encode_glEndList(t);
    gReal.glEndList();
    if (!t.context) return;
    t.context->compilingList = false;
    if (std::exchange(t.context->listPrimitive, false)) t.context->group->listOpens.set(t.context->compiledList, true);
    refreshDrawLocally(t);
    setDrawing(t.context->drawsList, false);
}
void mural_glCallList(GLuint list) {
    ThreadState& t = *tThread;
    beforeList(t, list);
    buffersRead(t);
    encode_glCallList(t, list);
    noteListCall(t, t.context && listConditional(*t.context->group, list));
    const ShareGroup* group = t.context ? t.context->group : nullptr;
    const bool moves = group && group->listsMoveRaster && (group->listMovesRaster.get(list) || !NameBits::known(list));
    if (t.context) notePrimitives(*t.context, list);
    const bool live = group && !t.context->compilingList;
    callWithoutDrawing(t, moves, live && group->listOpens.get(list), live && group->listCloses.get(list),
                       [&] { gReal.glCallList(list); });
}
void mural_glCallLists(GLsizei n, GLenum type, const void* lists) {
    ThreadState& t = *tThread;
    beforeLists(t);
    buffersRead(t);
    encode_glCallLists(t, n, type, DataArg::of(lists, sizes::callListsBytes(n, type)));
    noteListCall(t, true);
    const bool moves = t.context && t.context->group->listsMoveRaster; // mostly text
    callWithoutDrawing(t, moves, false, false, [&] { gReal.glCallLists(n, type, lists); });
}
// Selection and feedback need vertices only and run in the program's own context.
GLint mural_glRenderMode(GLenum mode) {
    ThreadState& t = *tThread;
    encode_glRenderMode(t, mode);
    if (t.context) setDrawing(t.context->drawsSelection, t.context->drawsSelection || mode != GL_RENDER);
    const GLint hits = gReal.glRenderMode(mode);
    if (t.context) {
        t.context->renderMode = mode;
        refreshDrawLocally(t);
        setDrawing(t.context->drawsSelection, mode != GL_RENDER);
    }
    return hits;
}

void mural_glBeginTransformFeedback(GLenum primitiveMode) {
    ThreadState& t = *tThread;
    nodesMayWrite(t, 0);
    encode_glBeginTransformFeedback(t, primitiveMode);
    gReal.glBeginTransformFeedback(primitiveMode);
    if (t.context && t.context->feedbackCounts) drawFeedback(t, true);
}
void mural_glEndTransformFeedback() {
    ThreadState& t = *tThread;
    encode_glEndTransformFeedback(t);
    gReal.glEndTransformFeedback();
    if (t.context && t.context->feedbackCounts) drawFeedback(t, false);
}

// Some drivers check the window's size when a program sets its viewport: a resize takes effect there.
void mural_glViewport(GLint x, GLint y, GLsizei width, GLsizei height) {
    ThreadState& t = *tThread;
    gReal.glViewport(x, y, width, height);
    if (t.context && t.context->sizeAtViewport) {
        if (Window* w = findWindowById(t.context->drawWindow)) updateWindowSize(t, *w);
    }
    encode_glViewport(t, x, y, width, height);
}

// The draw buffer matters at the next flush, which shows a front buffer.
void mural_glDrawBuffer(GLenum buf) {
    ThreadState& t = *tThread;
    if (!t.context) return gReal.glDrawBuffer(buf);
    if (!raisesNothing(*t.context, [&] { gReal.glDrawBuffer(buf); })) return;
    encode_glDrawBuffer(t, buf);
    if (isFront(buf)) t.context->frontDue = true;
}
void mural_glDrawBuffers(GLsizei n, const GLenum* bufs) {
    ThreadState& t = *tThread;
    if (!t.context) return gReal.glDrawBuffers(n, bufs);
    if (!raisesNothing(*t.context, [&] { gReal.glDrawBuffers(n, bufs); })) return;
    // without buffers the pointer may be null, which nodes would treat as missing data
    static const GLenum kNone = GL_NONE;
    encode_glDrawBuffers(t, n, DataArg::of(bufs ? bufs : &kNone, n > 0 ? uint64_t(n) * sizeof(GLenum) : 0));
    for (GLsizei i = 0; i < n && bufs; ++i)
        if (isFront(bufs[i])) t.context->frontDue = true;
}

void mural_glFlush() {
    ThreadState& t = *tThread;
    encode_glFlush(t);
    gReal.glFlush();
    publish(t);
    flushedWindow(t);
}
void mural_glFinish() {
    ThreadState& t = *tThread;
    encode_glFinish(t);
    gReal.glFinish();
    publish(t);
    flushedWindow(t);
    refreshMaps(t);
}
GLsync mural_glFenceSync(GLenum condition, GLbitfield flags) {
    ThreadState& t = *tThread;
    const GLsync sync = gReal.glFenceSync(condition, flags);
    encode_glFenceSync(t, condition, flags, sync);
    publish(t);
    return sync;
}
GLenum mural_glClientWaitSync(GLsync sync, GLbitfield flags, GLuint64 timeout) {
    ThreadState& t = *tThread;
    publish(t);
    const GLenum result = gReal.glClientWaitSync(sync, flags, timeout);
    if (result == GL_ALREADY_SIGNALED || result == GL_CONDITION_SATISFIED) refreshMaps(t);
    return result;
}
void mural_glGetSynciv(GLsync sync, GLenum pname, GLsizei count, GLsizei* length, GLint* values) {
    gReal.glGetSynciv(sync, pname, count, length, values);
    if (pname == GL_SYNC_STATUS && count > 0 && values && values[0] == GL_SIGNALED) refreshMaps(*tThread);
}
void mural_glWaitSync(GLsync sync, GLbitfield flags, GLuint64 timeout) {
    ThreadState& t = *tThread;
    encode_glWaitSync(t, sync, flags, timeout);
    gReal.glWaitSync(sync, flags, timeout);
}
void mural_glDeleteSync(GLsync sync) {
    ThreadState& t = *tThread;
    encode_glDeleteSync(t, sync);
    gReal.glDeleteSync(sync);
}

// Attributes are bound before the nodes link, so that locations agree. Uniforms are matched by name.
void mural_glLinkProgram(GLuint program) {
    ThreadState& t = *tThread;
    gReal.glLinkProgram(program);
    if (capturing(t)) bindAttributes(t, program);
    recordMemoryWriter(t, program);
    encode_glLinkProgram(t, program);
    if (capturing(t)) sendLayout(t, program);
}
void mural_glLinkProgramARB(GLuint program) { mural_glLinkProgram(program); }
GLuint mural_glCreateShaderProgramv(GLenum type, GLsizei count, const GLchar* const* strings) {
    ThreadState& t = *tThread;
    const GLuint program = gReal.glCreateShaderProgramv(type, count, strings);
    recordMemoryWriter(t, program, type, count, strings);
    encode_glCreateShaderProgramv(t, type, count, packStrings(t, count, strings, nullptr), program);
    if (capturing(t) && program) sendLayout(t, program);
    return program;
}
// SPIR-V modules are portable. Other formats are driver-specific and not advertised.
void mural_glShaderBinary(GLsizei count, const GLuint* shaders, GLenum binaryFormat, const void* binary,
                          GLsizei length) {
    ThreadState& t = *tThread;
    if (binaryFormat == GL_SHADER_BINARY_FORMAT_SPIR_V || !capturing(t)) {
        encode_glShaderBinary(t, count, DataArg::of(shaders, n4(count, shaders)), binaryFormat,
                              DataArg::of(binary, vn(length, 1)), length);
        return gReal.glShaderBinary(count, shaders, binaryFormat, binary, length);
    }
    stashError(*t.context, driverError());
    stashError(*t.context, GL_INVALID_ENUM);
}

// Negative lengths mean zero-terminated text.
void mural_glNamedStringARB(GLenum type, GLint namelen, const GLchar* name, GLint stringlen, const GLchar* string) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glNamedStringARB(type, namelen, name, stringlen, string); };
    if (!capturing(t)) return local();
    if (!raisesNothing(*t.context, local)) return;
    const GLint nameBytes = textBytes(name, namelen), stringBytes = textBytes(string, stringlen);
    encode_glNamedStringARB(t, type, nameBytes, DataArg::of(name, vn(nameBytes, 1)), stringBytes,
                            DataArg::of(string, vn(stringBytes, 1)));
}
void mural_glDeleteNamedStringARB(GLint namelen, const GLchar* name) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glDeleteNamedStringARB(namelen, name); };
    if (!capturing(t)) return local();
    if (!raisesNothing(*t.context, local)) return;
    const GLint nameBytes = textBytes(name, namelen);
    encode_glDeleteNamedStringARB(t, nameBytes, DataArg::of(name, vn(nameBytes, 1)));
}

// The primitive is empty in the program's own context, which still raises the errors of commands inside it.
void mural_glBegin(GLenum mode) {
    ThreadState& t = *tThread;
    buffersRead(t);
    encode_glBegin(t, mode);
    if (Context* c = t.context; c && c->openPrimitive == kNoPrimitive)
        c->restartElement = c->arrays.anyClient() ? restartIndexOf(*c) : kNoRestart;
    gReal.glBegin(mode);
    if (!t.context || mode > GL_PATCHES) return; // invalid mode
    if (t.context->compilingList)
        t.context->listPrimitive = true;
    else if (t.context->openPrimitive == kNoPrimitive && t.context->compatible())
        t.context->openPrimitive = mode;
}
void mural_glEnd() {
    ThreadState& t = *tThread;
    encode_glEnd(t);
    gReal.glEnd();
    if (!t.context) return;
    if (t.context->compilingList)
        listEndsPrimitive(*t.context);
    else
        t.context->openPrimitive = kNoPrimitive;
}

// Primitives are empty in the program's own context. Mesa may apply attributes of an empty primitive only after the
// pop. A query before the pop applies all of them.
void mural_glPopAttrib() {
    ThreadState& t = *tThread;
    encode_glPopAttrib(t);
    if (const Context* c = t.context; c && !t.drawLocally && c->compatible() && c->openPrimitive == kNoPrimitive) {
        GLfloat normal[3];
        gReal.glGetFloatv(GL_CURRENT_NORMAL, normal);
    }
    gReal.glPopAttrib();
}

GLenum mural_glGetError() {
    ThreadState& t = *tThread;
    if (!t.context) return gReal.glGetError();
    takeDriverEvents(t);
    return takeError(t);
}
const GLubyte* mural_glGetString(GLenum name) {
    ThreadState& t = *tThread;
    if (capturing(t) && t.context->openPrimitive == kNoPrimitive) { // otherwise an error
        if (const char* text = adjustedString(*t.context, name)) return reinterpret_cast<const GLubyte*>(text);
    }
    return gReal.glGetString(name);
}
const GLubyte* mural_glGetStringi(GLenum name, GLuint index) {
    ThreadState& t = *tThread;
    if (capturing(t) && name == GL_EXTENSIONS && t.context->openPrimitive == kNoPrimitive) {
        if (const char* text = extensionAt(*t.context, index)) return reinterpret_cast<const GLubyte*>(text);
        return gReal.glGetStringi(name, UINT32_MAX); // raises the error
    }
    return gReal.glGetStringi(name, index);
}
void mural_glGetIntegerv(GLenum pname, GLint* data) {
    ThreadState& t = *tThread;
    // the driver may have more formats than the program expects
    if (pname == GL_SHADER_BINARY_FORMATS && capturing(t) && data) {
        GLint formats = 0;
        gReal.glGetIntegerv(GL_NUM_SHADER_BINARY_FORMATS, &formats);
        if (formats > 0 && takesModules(*t.context)) *data = GL_SHADER_BINARY_FORMAT_SPIR_V;
        return;
    }
    gReal.glGetIntegerv(pname, data);
    if (!capturing(t) || !data || t.context->openPrimitive != kNoPrimitive) return;
    if (pname == GL_NUM_EXTENSIONS)
        *data = extensionCount(*t.context) < 0 ? *data : extensionCount(*t.context);
    else if (pname == GL_NUM_SHADER_BINARY_FORMATS)
        *data = *data > 0 && takesModules(*t.context) ? 1 : 0;
}

} // extern "C"
