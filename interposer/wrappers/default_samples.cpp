// Wrappers that set the sample count of framebuffer objects without attachments
// (interposer/context/default_samples.hpp).
#include "interposer/context/default_samples.hpp"

#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"

using namespace mural;

namespace {

// Enables the check before each draw of this context.
void parameterSet(ThreadState& t, GLenum pname) {
    if (pname != GL_FRAMEBUFFER_DEFAULT_SAMPLES || !t.context) return;
    t.context->hasDefaultSamples = true;
    t.drawingAwaited = true;
    t.limit = nullptr;
}

} // namespace

namespace mural {

void fitDefaultSamples(const ThreadState& t) {
    if (t.drawLocally || t.context->openPrimitive != kNoPrimitive) return;
    GLint framebuffer = 0;
    gReal.glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (framebuffer != 0 && gReal.glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        gReal.glClear(0);
}

} // namespace mural

extern "C" {

void mural_glFramebufferParameteri(GLenum target, GLenum pname, GLint param) {
    ThreadState& t = *tThread;
    encode_glFramebufferParameteri(t, target, pname, param);
    gReal.glFramebufferParameteri(target, pname, param);
    parameterSet(t, pname);
}
void mural_glNamedFramebufferParameteri(GLuint framebuffer, GLenum pname, GLint param) {
    ThreadState& t = *tThread;
    encode_glNamedFramebufferParameteri(t, framebuffer, pname, param);
    gReal.glNamedFramebufferParameteri(framebuffer, pname, param);
    parameterSet(t, pname);
}
void mural_glNamedFramebufferParameteriEXT(GLuint framebuffer, GLenum pname, GLint param) {
    ThreadState& t = *tThread;
    encode_glNamedFramebufferParameteriEXT(t, framebuffer, pname, param);
    gReal.glNamedFramebufferParameteriEXT(framebuffer, pname, param);
    parameterSet(t, pname);
}

} // extern "C"
