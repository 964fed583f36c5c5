// Reads of compressed images. Their texels may come from rendering (copies, mipmaps, unpack buffers), so the nodes
// answer.
#include "custom_wrappers.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/wrappers/image_reads.hpp"
#include "interposer/memory/pixel_store.hpp"
#include "interposer/encode/session.hpp"
#include "streamcodec/sizes/compressed_block.hpp"

using namespace mural;
using namespace mural::image_reads;

namespace {

struct Image {
    GLenum format = 0;
    Level size;
    int dimensions = 2;

    // Returns the bytes of the level without gaps; 0: not a block format.
    [[nodiscard]] size_t bytes() const {
        const size_t tight = sizes::compressedBytes(format, size.width, size.height, size.depth);
        return tight == SIZE_MAX ? 0 : tight;
    }
};

template <class Query> Image imageOf(GLenum target, Query&& query) {
    GLint format = 0;
    query(GL_TEXTURE_INTERNAL_FORMAT, &format);
    return {static_cast<GLenum>(format), levelOf(query), imageDimensions(target)};
}

Image imageByName(ThreadState& t, GLuint texture, GLint level) {
    GLenum target = 0;
    GLint format = 0;
    gReal.glGetTextureLevelParameteriv(texture, level, GL_TEXTURE_INTERNAL_FORMAT, &format);
    const Level size = levelOf(*t.context, texture, level, target);
    return {static_cast<GLenum>(format), size, dimensionsByName(target)};
}

sizes::ImageLayout layoutOf(ThreadState& t, GLenum format, const Level& size, int dimensions) {
    return sizes::compressedLayoutOf(compressedPackStore(*t.context), format, size.width, size.height, size.depth,
                                     dimensions);
}

void read(ThreadState& t, bool byName, GLuint which, GLint level, const Image& image, void* pixels,
          const char* by = __builtin_FUNCTION()) {
    requestAndDeliver(t, {byName, which, level, 0, 0, image.bytes()}, pixels,
                      layoutOf(t, image.format, image.size, image.dimensions), by);
}

Level inBlocks(const Level& texels, const sizes::CompressedBlock& block) {
    const auto along = [](GLint count, uint32_t per) {
        return (count + static_cast<GLint>(per) - 1) / static_cast<GLint>(per);
    };
    return {along(texels.width, block.width), along(texels.height, block.height), along(texels.depth, block.depth)};
}

// Executes the driver's own call first. It raises errors, and returns data in case the nodes have no reply.
template <class Local>
void readBound(GLenum target, GLint level, void* pixels, Local&& local, const char* by = __builtin_FUNCTION()) {
    ThreadState& t = *tThread;
    if (!capturing(t)) return local();
    if (!packsAhead(t, local)) return;
    const Image image = imageOf(
        target, [=](GLenum pname, GLint* value) { gReal.glGetTexLevelParameteriv(target, level, pname, value); });
    read(t, false, target, level, image, pixels, by);
}

} // namespace

extern "C" {

void mural_glGetCompressedTexImage(GLenum target, GLint level, void* img) {
    readBound(target, level, img, [=] { gReal.glGetCompressedTexImage(target, level, img); });
}
void mural_glGetnCompressedTexImage(GLenum target, GLint lod, GLsizei bufSize, void* pixels) {
    readBound(target, lod, pixels, [=] { gReal.glGetnCompressedTexImage(target, lod, bufSize, pixels); });
}
void mural_glGetnCompressedTexImageARB(GLenum target, GLint lod, GLsizei bufSize, void* img) {
    readBound(target, lod, img, [=] { gReal.glGetnCompressedTexImageARB(target, lod, bufSize, img); });
}

void mural_glGetCompressedTextureImage(GLuint texture, GLint level, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetCompressedTextureImage(texture, level, bufSize, pixels); };
    if (!capturing(t)) return local();
    if (packsAhead(t, local)) read(t, true, texture, level, imageByName(t, texture, level), pixels);
}

// Reads a part: requests the whole level and copies the part's blocks.
void mural_glGetCompressedTextureSubImage(GLuint texture, GLint level, GLint xoffset, GLint yoffset, GLint zoffset,
                                          GLsizei width, GLsizei height, GLsizei depth, GLsizei bufSize, void* pixels) {
    ThreadState& t = *tThread;
    const auto local = [&] {
        gReal.glGetCompressedTextureSubImage(texture, level, xoffset, yoffset, zoffset, width, height, depth, bufSize,
                                             pixels);
    };
    if (!capturing(t)) return local();
    if (!packsAhead(t, local) || width <= 0 || height <= 0 || depth <= 0) return;
    const Image image = imageByName(t, texture, level);
    const sizes::CompressedBlock block = sizes::compressedBlock(image.format);
    const Level size{width, height, depth};
    const ImagePart part{inBlocks(image.size, block), inBlocks({xoffset, yoffset, zoffset}, block),
                         inBlocks(size, block), block.bytes};
    requestAndDeliver(t, {true, texture, level, 0, 0, image.bytes(), part}, pixels,
                      layoutOf(t, image.format, size, image.dimensions), __func__);
}

void mural_glGetCompressedTextureImageEXT(GLuint texture, GLenum target, GLint lod, void* img) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetCompressedTextureImageEXT(texture, target, lod, img); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!packsAhead(t, local)) return;
    const Image image = imageOf(target, [=](GLenum pname, GLint* value) {
        gReal.glGetTextureLevelParameterivEXT(texture, target, lod, pname, value);
    });
    whileBound(t, target, texture, [&] { read(t, false, target, lod, image, img, "glGetCompressedTextureImageEXT"); });
}

void mural_glGetCompressedMultiTexImageEXT(GLenum texunit, GLenum target, GLint lod, void* img) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetCompressedMultiTexImageEXT(texunit, target, lod, img); };
    if (!capturing(t) || t.context->compilingList) return local();
    if (!packsAhead(t, local)) return;
    const Image image = imageOf(target, [=](GLenum pname, GLint* value) {
        gReal.glGetMultiTexLevelParameterivEXT(texunit, target, lod, pname, value);
    });
    whileActive(t, texunit, [&] { read(t, false, target, lod, image, img, "glGetCompressedMultiTexImageEXT"); });
}

} // extern "C"
