// What the commands that read images from the nodes share: sizes of levels, parts of images, and the way of an answer
// to where the program wants it.
#pragma once

#include "encoders.hpp"
#include "interposer/asking.hpp"
#include "interposer/context.hpp"
#include "interposer/image_part.hpp"
#include "interposer/real_gl.hpp"
#include "streamcodec/sizes/pixel_format.hpp"

namespace mural::image_reads {

[[nodiscard]] bool capturing(const ThreadState& t);

// Writes tight pixels where the pack state puts them: client memory, or the bound pack buffer (the
// program's own and the nodes').
void deliver(ThreadState& t, const void* tight, void* pixels, const sizes::ImageLayout& layout);

struct ImageQuestion {
    bool byName;
    GLuint targetOrTexture;
    GLint level;
    GLenum format, type; // 0: the blocks of a compressed image
    size_t sizeBytes;    // of the tight image; 0: it can't be asked for
    ImagePart part{};    // of it that is wanted
};
// Asks the nodes for an image of a texture, and delivers it or a part: later, where it goes into a pack buffer.
void askAndDeliver(ThreadState& t, const ImageQuestion& question, void* pixels, const sizes::ImageLayout& layout, const char* by);

// The program's own context packs something by `local`, its errors are kept: true when there was none. What the
// bound pack buffer is still owed comes first.
template <class Local> bool packsHere(ThreadState& t, Local&& local, const char* by = __builtin_FUNCTION()) {
    settleBound(t, GL_PIXEL_PACK_BUFFER, by);
    return raisesNothing(*t.context, local);
}

// The same before nodes are asked for what goes to the same place: what the buffer is owed from before need not be here, for
// answers are put there in their order. askAndDeliver waits for it where this one is not owed.
template <class Local> bool packsAhead(ThreadState& t, Local&& local) { return raisesNothing(*t.context, local); }

// The program's own context has written so many bytes into the bound pack buffer: the nodes get them.
void tellPackBuffer(ThreadState& t, const void* offset, size_t bytes);

// How many dimensions of an image of that target the pack state counts.
int imageDimensions(GLenum target);
// Of an image by name: a cube map's faces are images one behind the other.
int dimensionsByName(GLenum target);

// ask(pname, &value) asks the driver.
template <class Ask> Level levelOf(Ask&& ask) {
    Level size;
    ask(GL_TEXTURE_WIDTH, &size.width);
    ask(GL_TEXTURE_HEIGHT, &size.height);
    ask(GL_TEXTURE_DEPTH, &size.depth);
    return size;
}
// A cube map's level is its six faces.
Level levelOf(Context& c, GLuint texture, GLint level, GLenum& target);

struct Target {
    GLenum target, binding;
};
// Null: textures of it have no images to read.
const Target* targetWithImages(GLenum target);
GLint boundTo(const Target& t);

// EXT_direct_state_access: the nodes read what is bound, so the texture is bound there as long as `read` takes.
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
