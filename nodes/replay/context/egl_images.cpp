// EGL images (EGL_KHR_image_base), which share a picture between contexts of different share groups.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

bool Replay::onCreateImage(Args& in) {
    const auto image = in.get<uint64_t>();
    const auto context = in.get<uint32_t>(), target = in.get<uint32_t>(), object = in.get<uint32_t>();
    const auto level = in.get<int32_t>(), layer = in.get<int32_t>();
    if (!in.ok()) return false;
    Client& client = clients_[wire::clientOf(stream_)];
    const auto it = client.contexts.find(context);
    if (it == client.contexts.end()) return true; // its creation failed on this node, which was reported
    const Kind kind = target == EGL_GL_RENDERBUFFER_KHR ? Kind::Renderbuffer : Kind::Texture;
    const gl::ImageSource source{it->second->context.get(), target,
                                 it->second->shared->tables[static_cast<int>(kind)].find(object), level, layer};
    auto made = platform_->createImage(source);
    if (made)
        client.images[image] = std::move(*made);
    else
        log::warning(log::Topic::Replay,
                     "an EGL image of the program is missing on this node's tiles: " + made.error().message);
    return true;
}

bool Replay::onDestroyImage(Args& in) {
    const auto image = in.get<uint64_t>();
    if (!in.ok()) return false;
    clients_[wire::clientOf(stream_)].images.erase(image);
    return true;
}

// An unknown image is an error of the program, or an unsupported image that the interposer has reported.
void Replay::withImage(uint64_t image, const std::function<void(GLeglImageOES)>& call) {
    const auto& images = clients_[wire::clientOf(stream_)].images;
    if (const auto it = images.find(image); it != images.end()) call(it->second->handle());
}

void Replay::glEGLImageTargetTexture2DOES(GLenum target, uint64_t image) {
    if (gl.glEGLImageTargetTexture2DOES)
        withImage(image, [&](GLeglImageOES i) { gl.glEGLImageTargetTexture2DOES(target, i); });
}
void Replay::glEGLImageTargetRenderbufferStorageOES(GLenum target, uint64_t image) {
    if (gl.glEGLImageTargetRenderbufferStorageOES)
        withImage(image, [&](GLeglImageOES i) { gl.glEGLImageTargetRenderbufferStorageOES(target, i); });
}
// No attributes are defined for the list.
void Replay::glEGLImageTargetTexStorageEXT(GLenum target, uint64_t image, const Data&) {
    if (gl.glEGLImageTargetTexStorageEXT)
        withImage(image, [&](GLeglImageOES i) { gl.glEGLImageTargetTexStorageEXT(target, i, nullptr); });
}
void Replay::glEGLImageTargetTextureStorageEXT(GLuint texture, uint64_t image, const Data&) {
    const GLuint nodeName = name(Kind::Texture, texture);
    if (gl.glEGLImageTargetTextureStorageEXT)
        withImage(image, [&](GLeglImageOES i) { gl.glEGLImageTargetTextureStorageEXT(nodeName, i, nullptr); });
}

} // namespace mural
