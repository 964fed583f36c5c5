#include "interposer/wrappers/validate_only_draws.hpp"

#include "interposer/readback/node_requests.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::quiet {

namespace {

// Every driver has this many draw buffers. Higher numbers may be errors, so the driver decides.
constexpr GLint kSureDrawBuffers = 4;
// Groups per dimension that every driver accepts.
constexpr GLuint kSureGroups = 65535;
// Mesh tasks per draw that every driver accepts.
constexpr GLuint kSureMeshTasks = 65535;

bool isDesktop(const ThreadState& t, int version) {
    return t.context && t.context->api == wire::Api::Desktop && t.context->version >= version;
}

bool outOfUnpackBuffer(Context& c, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* offset) {
    if (!unpackBufferBound(c) || width == 0 || height == 0) return false;
    const sizes::ImageLayout layout = sizes::layoutOf(unpackStore(c), format, type, width, height, 1, 2);
    return layout.known && !withinBuffer(GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING,
                                         reinterpret_cast<uint64_t>(offset), sizes::spanBytes(layout));
}

} // namespace

bool withinBuffer(GLenum target, GLenum binding, uint64_t offset, uint64_t sizeBytes) {
    GLint buffer = 0, size = 0, mapped = GL_FALSE;
    gReal.glGetIntegerv(binding, &buffer);
    if (buffer == 0) return false;
    gReal.glGetBufferParameteriv(target, GL_BUFFER_SIZE, &size);
    gReal.glGetBufferParameteriv(target, GL_BUFFER_MAPPED, &mapped);
    return mapped == GL_FALSE && size >= 0 && offset <= static_cast<uint64_t>(size) &&
           sizeBytes <= static_cast<uint64_t>(size) - offset;
}

bool clearsBuffer(GLenum buffer, GLint drawBuffer, bool color, GLenum plane) {
    if (buffer == GL_COLOR && color) return drawBuffer >= 0 && drawBuffer < kSureDrawBuffers;
    return buffer == plane && drawBuffer == 0;
}

void clearDepthStencil(GLuint framebuffer, GLenum buffer, GLint drawBuffer, GLfloat depth, GLint stencil) {
    discarded([&] { // Mesa checks completeness only before an actual clear, or for one plane
        if (clearsBuffer(buffer, drawBuffer, false, GL_DEPTH_STENCIL))
            gReal.glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &depth);
        else
            gReal.glClearNamedFramebufferfi(framebuffer, buffer, drawBuffer, depth, stencil);
    });
}

void settleArrays(const ThreadState& t) {
    if (t.drawLocally || !t.context || t.context->compilingList) return;
    stashError(*t.context, driverError());
    gReal.glDrawArrays(GL_POINTS, 0, 0);
    (void)driverError(); // not an error of the program
}

void rectangle(const ThreadState& t) {
    gReal.glBegin(GL_QUADS); // as drivers execute glRect*; an error between glBegin and glEnd
    if (!t.context || t.context->openPrimitive == kNoPrimitive) gReal.glEnd();
}

// The driver draws a mesh as one primitive per row, and each may raise an error. This call makes one empty primitive.
void evalMesh2(GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2) {
    const bool begins = mode == GL_FILL ? j1 < j2 : mode == GL_LINE ? i1 <= i2 || j1 <= j2 : true;
    gReal.glEvalMesh2(mode, 1, 0, begins ? 0 : 1, mode == GL_FILL ? 1 : 0);
}

void drawPixels(const ThreadState& t, GLsizei width, GLsizei height, GLenum format, GLenum type, const void* pixels) {
    const bool isError =
        width < 0 || height < 0 || (t.context && outOfUnpackBuffer(*t.context, width, height, format, type, pixels));
    gReal.glDrawPixels(isError ? width : 0, isError ? height : 0, format, type, pixels);
}

void accumulate(GLenum op, GLfloat value) {
    if (op == GL_ACCUM || op == GL_LOAD || op == GL_ADD || op == GL_MULT || op == GL_RETURN)
        gReal.glAccum(GL_MULT, 1);
    else
        gReal.glAccum(op, value);
}

// The driver reports counts above its limit.
void meshTasks(GLuint first, GLuint count) {
    GLint limit = static_cast<GLint>(kSureMeshTasks);
    if (count > kSureMeshTasks) gReal.glGetIntegerv(GL_MAX_DRAW_MESH_TASKS_COUNT_NV, &limit);
    gReal.glDrawMeshTasksNV(first, count > static_cast<GLuint>(limit) ? count : 0);
}

void dispatch(GLuint x, GLuint y, GLuint z) {
    const GLuint count[3] = {x, y, z};
    for (GLuint i = 0; i < 3; ++i) {
        GLint maximum = static_cast<GLint>(kSureGroups);
        if (count[i] > kSureGroups && gReal.glGetIntegeri_v)
            gReal.glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, i, &maximum);
        if (count[i] > static_cast<GLuint>(maximum)) return gReal.glDispatchCompute(x, y, z);
    }
    gReal.glDispatchCompute(0, 0, 0);
}

void dispatchIndirect(GLintptr indirect) {
    constexpr uint64_t kCommandBytes = 12;
    const bool right = indirect >= 0 && indirect % 4 == 0 &&
                       withinBuffer(GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING,
                                    static_cast<uint64_t>(indirect), kCommandBytes);
    if (right)
        gReal.glDispatchCompute(0, 0, 0);
    else
        gReal.glDispatchComputeIndirect(indirect);
}

void drawFeedback(const ThreadState& t, GLenum mode, GLuint id) {
    if (isDesktop(t, 42))
        gReal.glDrawTransformFeedbackInstanced(mode, id, 0);
    else
        gReal.glDrawArrays(mode, 0, 0);
}

void drawFeedbackStream(const ThreadState& t, GLenum mode, GLuint id, GLuint stream) {
    if (isDesktop(t, 42))
        gReal.glDrawTransformFeedbackStreamInstanced(mode, id, stream, 0);
    else
        gReal.glDrawArrays(mode, 0, 0);
}

bool indirectIsWrong(const ThreadState& t, const void* indirect, uint64_t sizeBytes) {
    const auto offset = reinterpret_cast<uint64_t>(indirect);
    if (offset % 4 != 0) return true;
    GLint buffer = 0, array = 1;
    gReal.glGetIntegerv(GL_DRAW_INDIRECT_BUFFER_BINDING, &buffer);
    const bool compatible = t.context && t.context->compatible();
    if (buffer == 0) return !compatible;                                        // client memory
    if (!isDesktop(t, 0)) gReal.glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &array); // ES requires a vertex array
    return array == 0 || !withinBuffer(GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING, offset, sizeBytes);
}

void drawIndirect(const ThreadState& t, GLenum mode, const void* indirect, GLsizei stride) {
    if (isDesktop(t, 43))
        gReal.glMultiDrawArraysIndirect(mode, indirect, 0, stride);
    else
        gReal.glDrawArrays(mode, 0, 0);
}

void drawElementsIndirect(const ThreadState& t, GLenum mode, GLenum type, const void* indirect, GLsizei stride) {
    const bool isIndex = type == GL_UNSIGNED_BYTE || type == GL_UNSIGNED_SHORT || type == GL_UNSIGNED_INT;
    if (isDesktop(t, 43)) gReal.glMultiDrawElementsIndirect(mode, type, indirect, 0, stride);
    // drivers differ in the error that they raise first
    else if (!isIndex)
        gReal.glDrawElementsIndirect(mode, type, indirect);
    else
        gReal.glDrawElements(mode, 0, type, nullptr);
}

} // namespace mural::quiet
