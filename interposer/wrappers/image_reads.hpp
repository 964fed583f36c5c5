// Shared by commands that read images from the nodes: level sizes, parts of images, and delivery of the reply.
#pragma once

#include "encoders.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/image_part.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::image_reads {

// Writes tight pixels according to the pack state: to client memory, or to the bound pack buffer (the program's own and
// the nodes').
void deliver(ThreadState& t, const void* tight, void* pixels, const sizes::ImageLayout& layout);

struct ImageQuestion {
    bool byName;
    GLuint targetOrTexture;
    GLint level;
    GLenum format, type; // 0: compressed blocks
    size_t sizeBytes;    // of the tight image; 0: it cannot be requested
    ImagePart part{};    // the requested part
};
// Requests a texture image from the nodes and delivers it, or a part. Delivery into a pack buffer is deferred.
void requestAndDeliver(ThreadState& t, const ImageQuestion& question, void* pixels, const sizes::ImageLayout& layout,
                       const char* by);

// Runs `local`, which packs data in the program's own context, and saves its errors; returns true without errors.
// Deferred replies for the bound pack buffer are delivered first.
template <class Local> bool packsHere(ThreadState& t, Local&& local, const char* by = __builtin_FUNCTION()) {
    settleBound(t, GL_PIXEL_PACK_BUFFER, by);
    return raisesNothing(*t.context, local);
}

// The same before a request for the same place. Earlier deferred replies may stay deferred, because replies are
// delivered in order; requestAndDeliver waits for them if this one is not deferred.
template <class Local> bool packsAhead(ThreadState& t, Local&& local) { return raisesNothing(*t.context, local); }

// Sends `bytes` bytes of the bound pack buffer to the nodes, after the program's own context has written them.
void sendPackBuffer(ThreadState& t, const void* offset, size_t bytes);

// The dimensions of an image of that target, as the pack state counts them.
int imageDimensions(GLenum target);
// For access by name: the faces of a cube map are consecutive images.
int dimensionsByName(GLenum target);

// ask(pname, &value) queries the driver.
template <class Query> Level levelOf(Query&& query) {
    Level size;
    query(GL_TEXTURE_WIDTH, &size.width);
    query(GL_TEXTURE_HEIGHT, &size.height);
    query(GL_TEXTURE_DEPTH, &size.depth);
    return size;
}
// A level of a cube map consists of its six faces.
Level levelOf(Context& c, GLuint texture, GLint level, GLenum& target);

struct Target {
    GLenum target, binding;
};
// Null: textures of this target have no readable images.
const Target* targetWithImages(GLenum target);
GLint boundTo(const Target& t);

// EXT_direct_state_access: the nodes read the bound texture, so it is bound during `read`.
template <class Read> void whileBound(ThreadState& t, GLenum target, GLuint texture, Read&& read) {
    const bool isFace = target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
    const Target* const kind = targetWithImages(isFace ? GL_TEXTURE_CUBE_MAP : target);
    if (!kind) return;
    encode_glBindTexture(t, kind->target, texture);
    read();
    encode_glBindTexture(t, kind->target, static_cast<GLuint>(boundTo(*kind)));
}
template <class Read> void whileActive(ThreadState& t, GLenum texunit, Read&& read) {
    GLint unit = 0;
    gReal.glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
    encode_glActiveTexture(t, texunit);
    read();
    encode_glActiveTexture(t, static_cast<GLenum>(unit));
}

} // namespace mural::image_reads
