// Handles of textures and images without a binding (ARB_bindless_texture). The program has those of its own driver, at
// once; each node asks its driver at the same place of the stream and maps what it is told.
#include "custom_wrappers.hpp"
#include "encoders.hpp"
#include "interposer/asking.hpp"
#include "interposer/commands/copies.hpp"
#include "interposer/context.hpp"
#include "interposer/mapped_buffers.hpp"
#include "interposer/real_gl.hpp"

using namespace mural;

extern "C" {

// 0 is an error, which the nodes need not make.
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

// An image that may be written needs no uniform in a shader: the handle may come out of any memory. So what is said of
// fragment shaders that write (interposer/memory_writers.hpp) holds from here on, whichever program is linked.
void mural_glMakeImageHandleResidentARB(GLuint64 handle, GLenum access) {
    ThreadState& t = *tThread;
    const auto local = [=] { gReal.glMakeImageHandleResidentARB(handle, access); };
    if (!t.context) return local();
    if (!raisesNothing(*t.context, local)) return;
    if (access != GL_READ_ONLY) {
        nodesMayWrite(t, 0); // it may be of a buffer
        copies::drawAll(t, "glMakeImageHandleResidentARB");
    }
    encode_glMakeImageHandleResidentARB(t, handle, access);
}

} // extern "C"
