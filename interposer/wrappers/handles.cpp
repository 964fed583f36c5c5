// Bindless texture and image handles (ARB_bindless_texture). The program receives its own driver's handles immediately.
// Each node requests one at the same position of the stream and maps between them.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/copies.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/mapped_buffers.hpp"
#include "interposer/encode/real_gl.hpp"

using namespace mural;

extern "C" {

// A handle of 0 is an error, which the nodes need not repeat.
GLuint64 mural_glGetTextureHandleARB(GLuint texture) {
    const GLuint64 handle = gReal.glGetTextureHandleARB(texture);
    if (handle) encode_glGetTextureHandleARB(*tThread, texture, handle);
    return handle;
}
GLuint64 mural_glGetTextureSamplerHandleARB(GLuint texture, GLuint sampler) {
    const GLuint64 handle = gReal.glGetTextureSamplerHandleARB(texture, sampler);
    if (handle) encode_glGetTextureSamplerHandleARB(*tThread, texture, sampler, handle);
    return handle;
}
GLuint64 mural_glGetImageHandleARB(GLuint texture, GLint level, GLboolean layered, GLint layer, GLenum format) {
    const GLuint64 handle = gReal.glGetImageHandleARB(texture, level, layered, layer, format);
    if (handle) encode_glGetImageHandleARB(*tThread, texture, level, layered, layer, format, handle);
    return handle;
}

// A writable image needs no uniform: its handle may come from any memory. From now on all programs count as fragment
// shaders that write (interposer/memory/shader_writes.hpp).
void mural_glMakeImageHandleResidentARB(GLuint64 handle, GLenum access) {
    ThreadState& t = *tThread;
    const auto local = [=] { gReal.glMakeImageHandleResidentARB(handle, access); };
    if (!t.context) return local();
    if (!raisesNothing(*t.context, local)) return;
    if (access != GL_READ_ONLY) {
        nodesMayWrite(t, 0); // it may be a buffer image
        copies::drawAll(t, "glMakeImageHandleResidentARB");
    }
    encode_glMakeImageHandleResidentARB(t, handle, access);
}

} // extern "C"
