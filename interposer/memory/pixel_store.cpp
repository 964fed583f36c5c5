#include "interposer/memory/pixel_store.hpp"

#include <GL/glext.h>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

// Without pixel buffers their names are errors.
bool hasPixelBuffers(const Context& c) { return c.api == wire::Api::Desktop ? c.version >= 21 : c.version >= 30; }
bool hasRowLength(const Context& c) { return c.api == wire::Api::Desktop || c.version >= 30; }

// Ordered by availability: ES 1 and 2 have only the last one, ES 3 lacks byte swapping.
constexpr GLenum kPack[6] = {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST,   GL_PACK_ROW_LENGTH,
                             GL_PACK_SKIP_ROWS,  GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT};

GLint get(GLenum name) {
    GLint value = 0;
    gReal.glGetIntegerv(name, &value);
    return value;
}

} // namespace

bool unpackBufferBound(const Context& c) { return hasPixelBuffers(c) && get(GL_PIXEL_UNPACK_BUFFER_BINDING) != 0; }
bool packBufferBound(const Context& c) { return hasPixelBuffers(c) && get(GL_PIXEL_PACK_BUFFER_BINDING) != 0; }

sizes::PixelStore unpackStore(const Context& c) {
    sizes::PixelStore s;
    s.alignment = get(GL_UNPACK_ALIGNMENT);
    if (!hasRowLength(c)) return s;
    s.rowLength = get(GL_UNPACK_ROW_LENGTH);
    s.skipRows = get(GL_UNPACK_SKIP_ROWS);
    s.skipPixels = get(GL_UNPACK_SKIP_PIXELS);
    s.imageHeight = get(GL_UNPACK_IMAGE_HEIGHT);
    s.skipImages = get(GL_UNPACK_SKIP_IMAGES);
    if (c.api != wire::Api::Desktop) return s;
    s.swapBytes = get(GL_UNPACK_SWAP_BYTES) != 0;
    s.lsbFirst = get(GL_UNPACK_LSB_FIRST) != 0;
    return s;
}

sizes::PixelStore packStore(const Context& c) {
    sizes::PixelStore s;
    s.alignment = get(GL_PACK_ALIGNMENT);
    if (!hasRowLength(c)) return s;
    s.rowLength = get(GL_PACK_ROW_LENGTH);
    s.skipRows = get(GL_PACK_SKIP_ROWS);
    s.skipPixels = get(GL_PACK_SKIP_PIXELS);
    if (c.api != wire::Api::Desktop) return s;
    s.imageHeight = get(GL_PACK_IMAGE_HEIGHT);
    s.skipImages = get(GL_PACK_SKIP_IMAGES);
    s.swapBytes = get(GL_PACK_SWAP_BYTES) != 0;
    s.lsbFirst = get(GL_PACK_LSB_FIRST) != 0;
    return s;
}

sizes::PixelStore compressedPackStore(Context& c) {
    sizes::PixelStore s = packStore(c);
    if (c.api != wire::Api::Desktop) return s;
    stashError(c, driverError());
    s.compressedBlockWidth = get(GL_PACK_COMPRESSED_BLOCK_WIDTH);
    s.compressedBlockHeight = get(GL_PACK_COMPRESSED_BLOCK_HEIGHT);
    s.compressedBlockDepth = get(GL_PACK_COMPRESSED_BLOCK_DEPTH);
    s.compressedBlockSize = get(GL_PACK_COMPRESSED_BLOCK_SIZE);
    driverError(); // of drivers without this state
    return s;
}

TightPack::TightPack(const Context& context)
    : first_(context.api == wire::Api::Desktop ? 0
             : context.version >= 30           ? 2
                                               : 5) {
    if (packBufferBound(context)) buffer_ = get(GL_PIXEL_PACK_BUFFER_BINDING);
    // A buffer that another context has deleted may still be bound here.
    ready_ = !buffer_ || gReal.glIsBuffer(static_cast<GLuint>(buffer_));
    if (!ready_) return;
    if (buffer_) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (int i = first_; i < 6; ++i) {
        values_[i] = get(kPack[i]);
        gReal.glPixelStorei(kPack[i], i == 5 ? 1 : 0);
    }
}

TightPack::~TightPack() {
    if (!ready_) return;
    for (int i = first_; i < 6; ++i) gReal.glPixelStorei(kPack[i], values_[i]);
    if (buffer_) gReal.glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
}

bool isTight(const sizes::ImageLayout& l) {
    return !(l.bitmap && (l.lsbFirst || l.firstBit != 0 || l.width % 8 != 0)) && l.swapUnit == 0 &&
           (l.rows <= 1 || l.rowStride == static_cast<ptrdiff_t>(l.rowBytes)) &&
           (l.images <= 1 || l.imageStride == l.rowBytes * l.rows);
}

} // namespace mural
