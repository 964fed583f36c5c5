#include "recording/trim/context_state.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include "gl_opcodes.hpp"
#include "streamcodec/opcode_names.hpp"
#include "streamcodec/wire.hpp"

namespace mural::recording {
namespace {

constexpr const char* kWritesMemory = "shaders may write into memory";
constexpr const char* kOtherBuffers = "it draws into, or reads, other buffers of its window than the back buffer";

bool isBack(uint32_t buffer) { return buffer == GL_BACK || buffer == GL_BACK_LEFT; }

} // namespace

uint32_t ContextState::clears(uint32_t mask) const {
    if (unknown_ || scissor_ || discard_ || conditional_ || !drawsIntoWindow()) return 0;
    if (colorMasked_) mask &= ~kColorPlane;
    if (depthMasked_) mask &= ~kDepthPlane;
    if (stencilMasked_) mask &= ~kStencilPlane;
    return mask & kAllPlanes;
}

// Lists change the state when they are called, and glPopAttrib brings back what was pushed: neither is followed here.
void ContextState::changes(Doubts& doubts) {
    everChanged_ = true;
    if (compiling_) doubts.listsChangeState = true;
}

void ContextState::enable(uint32_t what, bool on, Doubts& doubts) {
    if (what == GL_DEPTH_TEST && on) doubts.writtenPlanes |= kDepthPlane;
    if (what == GL_STENCIL_TEST && on) doubts.writtenPlanes |= kStencilPlane;
    if (what != GL_SCISSOR_TEST && what != GL_RASTERIZER_DISCARD) return;
    changes(doubts);
    (what == GL_SCISSOR_TEST ? scissor_ : discard_) = on;
}

void ContextState::framebuffer(uint32_t target, uint32_t name) {
    if (target == GL_FRAMEBUFFER || target == GL_DRAW_FRAMEBUFFER) drawFramebuffer_ = name;
    if (target == GL_FRAMEBUFFER || target == GL_READ_FRAMEBUFFER) readFramebuffer_ = name;
}

// glDrawBuffer and its kin; those by name are rare enough to be doubted at once.
void ContextState::buffers(const RecordView& r, Doubts& doubts) {
    if (r.opcode == op::glDrawBuffer && drawFramebuffer_ == 0 && !isBack(argumentWord(r, 0))) doubts.doubt(kOtherBuffers);
    if (r.opcode == op::glReadBuffer && readFramebuffer_ == 0 && !isBack(argumentWord(r, 0))) doubts.doubt(kOtherBuffers);
    // u32 n, a value: its length, and the names
    if (r.opcode == op::glDrawBuffers && drawFramebuffer_ == 0 && !(argumentWord(r, 0) == 1 && isBack(argumentWord(r, 2)))) doubts.doubt(kOtherBuffers);
}

void ContextState::record(const RecordView& r, Doubts& doubts) {
    const uint32_t first = argumentWord(r, 0);
    switch (r.opcode) {
    case op::glEnable:
    case op::glDisable: return enable(first, r.opcode == op::glEnable, doubts);
    case op::glEnablei:
    case op::glScissorIndexed:
    case op::glScissorIndexedv:
    case op::glScissorArrayv:
    case op::glColorMaski:
    case op::glStencilMaskSeparate:
    case op::glWindowRectanglesEXT:
        changes(doubts);
        unknown_ = true;
        return;
    case op::glColorMask:
        changes(doubts);
        colorMasked_ = !(first & 0xff) || !(argumentWord(r, 1) & 0xff) || !(argumentWord(r, 2) & 0xff) || !(argumentWord(r, 3) & 0xff);
        return;
    case op::glDepthMask:
        changes(doubts);
        depthMasked_ = !(first & 0xff);
        return;
    case op::glStencilMask:
        changes(doubts);
        stencilMasked_ = (first & 0xff) != 0xff;
        return;
    case op::glPopAttrib:
        unknown_ = unknown_ || everChanged_;
        return;
    case op::glCallList:
    case op::glCallLists:
        unknown_ = unknown_ || doubts.listsChangeState;
        return;
    case op::glBindFramebuffer:
    case op::glBindFramebufferEXT:
        if (compiling_) changes(doubts);
        return framebuffer(first, argumentWord(r, 1));
    case op::glDrawBuffer:
    case op::glReadBuffer:
    case op::glDrawBuffers:
        if (compiling_) doubts.doubt(kOtherBuffers);
        return buffers(r, doubts);
    case op::glNamedFramebufferDrawBuffer:
    case op::glNamedFramebufferDrawBuffers:
    case op::glNamedFramebufferReadBuffer:
    case op::glFramebufferDrawBufferEXT:
    case op::glFramebufferDrawBuffersEXT:
    case op::glFramebufferReadBufferEXT:
        if (first == 0) doubts.doubt(kOtherBuffers);
        return;
    case op::glBeginQuery:
    case op::glBeginQueryIndexed: ++queries_; return;
    case op::glEndQuery:
    case op::glEndQueryIndexed: queries_ -= queries_ > 0; return;
    case op::glBeginTransformFeedback: feedback_ = true; return;
    case op::glEndTransformFeedback: feedback_ = false; return;
    case op::glNewList: compiling_ = true; return;
    case op::glEndList: compiling_ = false; return;
    case wire::kOpBeginConditional: conditional_ = true; return;
    case op::glEndConditionalRender: conditional_ = false; return;
    case op::glAccum: return doubts.doubt("it uses the accumulation buffer");
    case op::glRenderMode:
        if (first != GL_RENDER) doubts.doubt("it draws for selection or feedback");
        return;
    case op::glBindImageTexture:
    case op::glBindImageTextures: return doubts.doubt(kWritesMemory);
    case op::glBindBufferBase:
    case op::glBindBufferRange:
    case op::glBindBuffersBase:
    case op::glBindBuffersRange:
        if (first == GL_SHADER_STORAGE_BUFFER || first == GL_ATOMIC_COUNTER_BUFFER) doubts.doubt(kWritesMemory);
        return;
    case wire::kOpDrawAll: return doubts.doubt("its display lists or shaders read the picture");
    case wire::kOpFrontPicture: return doubts.doubt("it draws into the front buffer");
    default: return;
    }
}

} // namespace mural::recording
