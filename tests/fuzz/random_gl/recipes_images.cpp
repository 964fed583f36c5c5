// Recipes for textures of all targets, framebuffer objects, reads, copies and blits.
#include <algorithm>

#include "tests/fuzz/random_gl/image_formats.hpp"
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

const void* pixels(World& w, GLenum type) { return inputOf(type == GL_FLOAT ? Type::Float : Type::Byte, w.random); }

void plainUnpack(World& w) {
    if (w.profile != Profile::Es1) {
        GL(glBindBuffer, GL_PIXEL_UNPACK_BUFFER, 0);
    }
    if (w.random.chance(80)) {
        GL(glPixelStorei, GL_UNPACK_ALIGNMENT, w.random.chance(50) ? 1 : 4);
    }
    if (w.profile != Profile::Es1 && w.random.chance(70)) {
        GL(glPixelStorei, GL_UNPACK_ROW_LENGTH, w.random.chance(80) ? 0 : 40);
        // Mesa 22.3.6 ignores skipped pixels when glPixelTransfer scales texture uploads.
        const int skipped = w.random.between(0, 3);
        GL(glPixelStorei, GL_UNPACK_SKIP_PIXELS, w.profile == Profile::Compat ? 0 : skipped);
        if (skipped != 0 && !w.es()) { // Mesa swaps each row's pixels without the skip, so the last ones are undefined
            GL(glPixelStorei, GL_UNPACK_SWAP_BYTES, 0);
        }
    }
}

// Disables swapped bytes for depths: Mesa 22.3.6 uploads some depth formats unswapped.
void swapNoDepths(World& w, const ImageFormat& f) {
    if (!w.es() && (f.format == GL_DEPTH_COMPONENT || f.format == GL_DEPTH_STENCIL)) {
        GL(glPixelStorei, GL_UNPACK_SWAP_BYTES, 0);
    }
}

// Uploads one level with contents.
void image(World& w, GLenum target, int level, int size, const ImageFormat& f) {
    const int side = std::max(1, size >> level);
    const auto internal = static_cast<GLint>(f.internal);
    swapNoDepths(w, f);
    const void* const data = pixels(w, f.type);
    switch (target) {
    case GL_TEXTURE_1D: GL(glTexImage1D, target, level, internal, side, 0, f.format, f.type, data); break;
    case GL_TEXTURE_3D:
        GL(glTexImage3D, target, level, internal, side, side, std::max(1, 4 >> level), 0, f.format, f.type, data);
        break;
    case GL_TEXTURE_2D_ARRAY:
        GL(glTexImage3D, target, level, internal, side, side, 3, 0, f.format, f.type, data);
        break;
    case GL_TEXTURE_CUBE_MAP_ARRAY:
        GL(glTexImage3D, target, level, internal, side, side, 6, 0, f.format, f.type, data);
        break;
    case GL_TEXTURE_1D_ARRAY: GL(glTexImage2D, target, level, internal, side, 3, 0, f.format, f.type, data); break;
    case GL_TEXTURE_CUBE_MAP:
        for (GLenum face = GL_TEXTURE_CUBE_MAP_POSITIVE_X; face <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z; ++face) {
            GL(glTexImage2D, face, level, internal, side, side, 0, f.format, f.type, data);
        }
        break;
    default: GL(glTexImage2D, target, level, internal, side, side, 0, f.format, f.type, data);
    }
}

void compressed(World& w) {
    const CompressedFormat* const format = anyCompressedFormat(w);
    GLuint texture = 0;
    GL(glGenTextures, 1, &texture);
    w.keep(Kind::Texture, texture);
    GL(glBindTexture, GL_TEXTURE_2D, texture);
    GL(glTexParameteri, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    if (format == nullptr) {
        return;
    }
    plainUnpack(w);
    GL(glPixelStorei, GL_UNPACK_ROW_LENGTH, 0);
    GL(glPixelStorei, GL_UNPACK_SKIP_PIXELS, 0);
    const int width = w.random.between(1, 20);
    const int height = w.random.between(1, 20);
    const int bytes =
        (width + format->width - 1) / format->width * ((height + format->height - 1) / format->height) * format->bytes;
    GL(glCompressedTexImage2D, GL_TEXTURE_2D, 0, format->format, width, height, 0, bytes,
       inputOf(Type::Byte, w.random));
    GL(glCompressedTexSubImage2D, GL_TEXTURE_2D, 0, 0, 0, 4, 4, format->format, format->bytes,
       inputOf(Type::Byte, w.random));
}

void texture(World& w) { makeTexture(w, anyTarget(w)); }

void storage(World& w) {
    const ImageFormat& f = anyFormat(w);
    const bool layers = w.random.chance(40);
    const GLenum target = layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    GLuint name = 0;
    GL(glGenTextures, 1, &name);
    w.keep(Kind::Texture, name);
    GL(glBindTexture, target, name);
    plainUnpack(w);
    swapNoDepths(w, f);
    if (layers) {
        GL(glTexStorage3D, target, 2, f.internal, 16, 12, 3);
        GL(glTexSubImage3D, target, 0, 0, 0, 0, 16, 12, 3, f.format, f.type, pixels(w, f.type));
    } else {
        GL(glTexStorage2D, target, 3, f.internal, 16, 12);
        GL(glTexSubImage2D, target, 0, 0, 0, 16, 12, f.format, f.type, pixels(w, f.type));
    }
    GL(glTexSubImage2D, target, 1, 2, 1, 4, 4, f.format, f.type, pixels(w, f.type));
    if (!w.es() && w.random.chance(40)) {
        GLuint view = 0;
        GL(glGenTextures, 1, &view);
        GL(glTextureView, view, target, name, f.internal, 1, 1, 0, 1);
        w.keep(Kind::Texture, view);
    }
}

// Draws a textured square with the fixed function.
void showTexture(World& w) {
    const GLuint name = w.living(Kind::Texture);
    calm(w);
    GL(glActiveTexture, GL_TEXTURE0);
    GL(glEnable, GL_TEXTURE_2D);
    GL(glBindTexture, GL_TEXTURE_2D, name);
    constexpr GLint environments[] = {GL_REPLACE, GL_MODULATE, GL_DECAL, GL_ADD};
    GL(glTexEnvi, GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, w.random.of(environments));
    if (w.profile == Profile::Compat) {
        GL(glBindVertexArray, 0);
    }
    GL(glBindBuffer, GL_ARRAY_BUFFER, 0);
    static const float corners[] = {-1, -1, 0, 1, 1, -1, 0, 1, -1, 1, 0, 1, 1, 1, 0, 1};
    GL(glVertexPointer, 4, GL_FLOAT, 16, corners);
    GL(glTexCoordPointer, 2, GL_FLOAT, 16, corners);
    GL(glEnableClientState, GL_VERTEX_ARRAY);
    GL(glEnableClientState, GL_TEXTURE_COORD_ARRAY);
    GL(glDisableClientState, GL_COLOR_ARRAY);
    GL(glDrawArrays, GL_TRIANGLE_STRIP, 0, 4);
    GL(glVertexPointer, 4, GL_FLOAT, 16, vertexMemory(w.random));
    GL(glTexCoordPointer, 2, GL_FLOAT, 16, vertexMemory(w.random));
}

void bindTextures(World& w) {
    GL(glActiveTexture, GL_TEXTURE0 + w.random.below(4));
    GL(glBindTexture, anyTarget(w), w.living(Kind::Texture));
    if (w.random.chance(20)) {
        if (w.shaders()) { // new levels move a texture; Mesa updates framebuffers when they are bound
            GL(glBindFramebuffer, GL_FRAMEBUFFER, 0);
        }
        GL(glGenerateMipmap, GL_TEXTURE_2D);
    }
    GL(glActiveTexture, GL_TEXTURE0);
}

void renderbuffer(World& w, GLenum attachment, GLenum format) {
    GLuint buffer = 0;
    GL(glGenRenderbuffers, 1, &buffer);
    w.keep(Kind::Renderbuffer, buffer);
    GL(glBindRenderbuffer, GL_RENDERBUFFER, buffer);
    // as large as textures: Mesa reads beyond the end of a smaller one
    GL(glRenderbufferStorage, GL_RENDERBUFFER, format, 40, 40);
    GL(glFramebufferRenderbuffer, GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

void framebuffer(World& w) {
    GLuint name = w.living(Kind::Framebuffer);
    if (name == 0 || w.random.chance(50)) {
        GL(glGenFramebuffers, 1, &name);
        w.keep(Kind::Framebuffer, name);
    }
    GL(glBindFramebuffer, GL_FRAMEBUFFER, name);
    const ImageFormat& f = drawableFormat(w);
    if (w.random.chance(60)) {
        GLuint colors = 0;
        GL(glGenTextures, 1, &colors);
        w.keep(Kind::Texture, colors);
        GL(glBindTexture, GL_TEXTURE_2D, colors);
        plainUnpack(w);
        GL(glTexParameteri, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        image(w, GL_TEXTURE_2D, 0, 40, f);
        GL(glFramebufferTexture2D, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colors, 0);
        GL(glBindTexture, GL_TEXTURE_2D, w.living(Kind::Texture));
    } else {
        renderbuffer(w, GL_COLOR_ATTACHMENT0, f.internal);
    }
    if (w.random.chance(60)) {
        renderbuffer(w, GL_DEPTH_STENCIL_ATTACHMENT, GL_DEPTH24_STENCIL8);
    }
    if (w.random.chance(20)) {
        renderbuffer(w, GL_COLOR_ATTACHMENT1, drawableFormat(w).internal);
        const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        GL(glDrawBuffers, 2, buffers);
    }
    w.observe(static_cast<std::uint64_t>(GL(glCheckFramebufferStatus, GL_FRAMEBUFFER)));
    GL(glDisable, GL_SCISSOR_TEST);
    GL(glClear, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void window(World& w) { GL(glBindFramebuffer, w.random.chance(60) ? GL_FRAMEBUFFER : GL_DRAW_FRAMEBUFFER, 0); }

void blit(World& w) {
    const GLuint from = w.random.chance(50) ? 0 : w.living(Kind::Framebuffer);
    const GLuint to = w.random.chance(60) ? 0 : w.living(Kind::Framebuffer);
    GL(glBindFramebuffer, GL_READ_FRAMEBUFFER, from);
    GL(glBindFramebuffer, GL_DRAW_FRAMEBUFFER, to);
    GL(glReadBuffer, from == 0 ? GL_BACK : GL_COLOR_ATTACHMENT0);
    const int x = w.random.between(-4, 30);
    const int y = w.random.between(-4, 20);
    const int width = w.random.between(0, 30);
    const int height = w.random.between(0, 30);
    if (from == to && from != 0) { // overlapping regions are undefined
        return;
    }
    const bool overlaps = from == to;
    const GLbitfield mask =
        w.random.chance(70) ? GL_COLOR_BUFFER_BIT : w.random.below(2) * GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    GL(glBlitFramebuffer, overlaps ? 0 : x, overlaps ? 0 : y, overlaps ? 30 : x + width, overlaps ? 20 : y + height,
       overlaps ? 32 : 3, overlaps ? 22 : 4, w.random.chance(70) ? (overlaps ? 62 : 3 + width) : 66,
       overlaps ? 42 : 4 + height, mask, mask == GL_COLOR_BUFFER_BIT && w.random.chance(40) ? GL_LINEAR : GL_NEAREST);
}

// Disables pixel transfer. With scaling or mapping, Mesa 22.3.6 copies all rows but the first from before its memory
// when it copies a window into a texture.
void plainTransfer(World& w) {
    for (const GLenum scale : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE}) {
        GL(glPixelTransferf, scale, 1.0F);
    }
    for (const GLenum bias : {GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS, GL_MAP_COLOR}) {
        GL(glPixelTransferf, bias, 0.0F);
    }
}

void copyTexture(World& w) {
    if (w.profile == Profile::Compat) {
        plainTransfer(w);
    }
    if (w.shaders() && w.random.chance(70)) {
        GL(glBindFramebuffer, GL_READ_FRAMEBUFFER, 0);
        GL(glReadBuffer, GL_BACK);
    }
    if (w.random.chance(50)) {
        GLuint name = 0;
        GL(glGenTextures, 1, &name);
        w.keep(Kind::Texture, name);
        GL(glBindTexture, GL_TEXTURE_2D, name);
        GL(glTexParameteri, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        constexpr GLenum formats[] = {GL_RGBA, GL_RGB, GL_LUMINANCE, GL_ALPHA, GL_DEPTH_COMPONENT};
        GL(glCopyTexImage2D, GL_TEXTURE_2D, 0, w.random.of(formats), w.random.between(0, 20), w.random.between(0, 10),
           32, 32, 0);
    } else {
        GL(glCopyTexSubImage2D, GL_TEXTURE_2D, 0, w.random.between(0, 5), w.random.between(0, 5),
           w.random.between(-3, 40), w.random.between(-3, 30), w.random.between(0, 11), w.random.between(0, 11));
    }
}

void read(World& w) {
    const int x = w.random.between(-5, 40);
    const int y = w.random.between(-5, 30);
    const int width = w.random.between(0, 40);
    const int height = w.random.between(0, 30);
    if (w.es() || w.random.chance(60)) {
        observePixels(w, x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
        return;
    }
    constexpr GLenum formats[] = {GL_RGBA, GL_BGRA, GL_RED, GL_RGB, GL_DEPTH_COMPONENT, GL_STENCIL_INDEX};
    constexpr GLenum types[] = {GL_UNSIGNED_BYTE, GL_FLOAT, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT};
    const GLenum format = w.random.of(formats);
    observePixels(w, x, y, width / 4, height, format, w.random.of(types));
}

void readToBuffer(World& w) {
    GLuint buffer = 0;
    GL(glGenBuffers, 1, &buffer);
    w.keep(Kind::Buffer, buffer);
    GL(glBindBuffer, GL_PIXEL_PACK_BUFFER, buffer);
    GL(glBufferData, GL_PIXEL_PACK_BUFFER, 40 * 30 * 4 + 64, inputOf(Type::Byte, w.random), GL_STREAM_READ);
    GL(glReadPixels, w.random.between(-4, 30), w.random.between(-4, 30), 30, 20, GL_RGBA, GL_UNSIGNED_BYTE,
       reinterpret_cast<void*>(std::uintptr_t{w.random.below(16)} * 4)); // NOLINT: an offset
    const void* const mapped =
        GL(glMapBufferRange, GL_PIXEL_PACK_BUFFER, 0, 2400, static_cast<GLbitfield>(GL_MAP_READ_BIT));
    if (mapped != nullptr) {
        w.observe(mapped, 2400);
    }
    GL(glUnmapBuffer, GL_PIXEL_PACK_BUFFER);
    GL(glBindBuffer, GL_PIXEL_PACK_BUFFER, 0);
}

constexpr Recipe kRecipes[] = {
    {"texture", texture, "ck13", 9},
    {"compressed texture", compressed, "ck13", 2},
    {"texture storage", storage, "ck3", 3},
    {"show texture", showTexture, "c1", 7},
    {"bind textures", bindTextures, "ck13", 5},
    {"framebuffer", framebuffer, "ck3", 5},
    {"window", window, "ck3", 7},
    {"blit", blit, "ck3", 4},
    {"copy texture", copyTexture, "ck13", 4},
    {"read", read, "ck13", 4},
    {"read to buffer", readToBuffer, "ck3", 2},
};

} // namespace

GLenum anyTarget(World& w) {
    constexpr GLenum targets[] = {GL_TEXTURE_2D,
                                  GL_TEXTURE_2D,
                                  GL_TEXTURE_2D,
                                  GL_TEXTURE_CUBE_MAP,
                                  GL_TEXTURE_3D,
                                  GL_TEXTURE_2D_ARRAY,
                                  GL_TEXTURE_CUBE_MAP_ARRAY,
                                  GL_TEXTURE_1D,
                                  GL_TEXTURE_RECTANGLE,
                                  GL_TEXTURE_1D_ARRAY};
    return targets[w.random.below(w.profile == Profile::Es1 ? 3 : w.es() ? 7 : 10)];
}

GLuint makeTexture(World& w, GLenum target) {
    GLuint name = 0;
    GL(glGenTextures, 1, &name);
    w.keep(Kind::Texture, name);
    GL(glBindTexture, target, name);
    plainUnpack(w);
    const ImageFormat& f = anyFormat(w);
    const int size = w.random.chance(80) ? 16 : w.random.between(1, 24);
    const bool mipmaps = target != GL_TEXTURE_RECTANGLE && w.random.chance(40);
    for (int level = 0; level <= (mipmaps ? 4 : 0); ++level) {
        image(w, target, level, size, f);
    }
    GL(glTexParameteri, target, GL_TEXTURE_MIN_FILTER, mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST);
    GL(glTexParameteri, target, GL_TEXTURE_MAG_FILTER, w.random.chance(50) ? GL_LINEAR : GL_NEAREST);
    if (target == GL_TEXTURE_2D && w.random.chance(30)) {
        GL(glTexSubImage2D, target, 0, 1, 1, 5, 4, f.format, f.type, pixels(w, f.type));
    }
    return name;
}

std::span<const Recipe> imageRecipes() { return kRecipes; }

} // namespace fuzz
