// Pixel store state. Images from client memory arrive tightly packed; images in buffers follow the program's state. The
// client attribute stack is here too, because it consists mostly of that state.
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/engine/to_int.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

// In the order of PixelUnpack::values and ContextState::pack; alignment is the sixth.
constexpr GLenum kUnpackNames[8] = {GL_UNPACK_SWAP_BYTES,  GL_UNPACK_LSB_FIRST,   GL_UNPACK_ROW_LENGTH,
                                    GL_UNPACK_SKIP_ROWS,   GL_UNPACK_SKIP_PIXELS, GL_UNPACK_ALIGNMENT,
                                    GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT};
constexpr GLenum kPackNames[8] = {GL_PACK_SWAP_BYTES,  GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH,  GL_PACK_SKIP_ROWS,
                                  GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT, GL_PACK_SKIP_IMAGES, GL_PACK_IMAGE_HEIGHT};
constexpr int kAlignment = 5;

// Whether the API has parameter i of the eight.
bool knows(wire::Api api, int version, int i, bool pack) {
    if (api == wire::Api::Desktop) return true;
    if (i == kAlignment) return true;
    if (version < 30 || i < 2) return false;
    return !(pack && i >= 6);
}

} // namespace

void Replay::pixelStore(GLenum pname, GLint value) {
    for (size_t i = 0; i < 8; ++i) {
        if (pname == kUnpackNames[i]) c_->unpack.values[i] = value;
        if (pname == kPackNames[i]) {
            c_->pack[i] = value;
            return gl.glPixelStorei(pname, value);
        }
        if (pname == kUnpackNames[i]) return c_->unpack.tight ? void() : gl.glPixelStorei(pname, value);
    }
    if (pname >= GL_PACK_COMPRESSED_BLOCK_WIDTH && pname <= GL_PACK_COMPRESSED_BLOCK_SIZE) c_->packsBlocks = true;
    gl.glPixelStorei(pname, value);
}
void Replay::glPixelStorei(GLenum pname, GLint param) { pixelStore(pname, param); }
void Replay::glPixelStoref(GLenum pname, GLfloat param) {
    pixelStore(pname, toInt(param + (param < 0 ? -0.5f : 0.5f)));
}
void Replay::glPixelStorex(GLenum pname, GLint param) { pixelStore(pname, param >> 16); }

void Replay::setUnpack(bool tight) {
    if (c_->unpack.tight == tight) return;
    c_->unpack.tight = tight;
    for (int i = 0; i < 8; ++i) {
        const GLint value = tight ? (i == kAlignment ? 1 : 0) : c_->unpack.values[static_cast<size_t>(i)];
        if (knows(c_->api, c_->version, i, false)) gl.glPixelStorei(kUnpackNames[i], value);
    }
}
bool Replay::unpackFor(const Data& data) {
    if (data.isOffset()) {
        setUnpack(false);
        return c_->unpackBuffer != 0;
    }
    if (!data.absent()) setUnpack(true);
    return true;
}
bool Replay::readable(const Data& data, GLenum binding) {
    if (!data.isOffset()) return !data.absent();
    GLint buffer = 0;
    gl.glGetIntegerv(binding, &buffer);
    return buffer != 0;
}
void Replay::packTightly(bool tight) {
    for (int i = 0; i < 8; ++i) {
        const GLint value = tight ? (i == kAlignment ? 1 : 0) : c_->pack[static_cast<size_t>(i)];
        if (knows(c_->api, c_->version, i, true)) gl.glPixelStorei(kPackNames[i], value);
    }
}

// ---- client attribute stack

void Replay::glPushClientAttrib(GLbitfield mask) {
    gl.glPushClientAttrib(mask);
    clientStatePushed(mask);
}
void Replay::glPushClientAttribDefaultEXT(GLbitfield mask) {
    gl.glPushClientAttribDefaultEXT(mask);
    clientStatePushed(mask);
    clientStateDefault(mask);
}
void Replay::glClientAttribDefaultEXT(GLbitfield mask) {
    gl.glClientAttribDefaultEXT(mask);
    clientStateDefault(mask);
}
void Replay::clientStatePushed(GLbitfield mask) {
    if (c_->clientAttributes.size() < 64)
        c_->clientAttributes.push_back({mask, c_->unpack, c_->pack, c_->arrayBuffer, c_->packBuffer, c_->unpackBuffer});
}
void Replay::clientStateDefault(GLbitfield mask) {
    if (mask & GL_CLIENT_PIXEL_STORE_BIT) {
        c_->unpack = {};
        c_->unpack.values[kAlignment] = 4;
        c_->pack = c_->unpack.values;
        c_->packBuffer = c_->unpackBuffer = 0;
    }
    if (mask & GL_CLIENT_VERTEX_ARRAY_BIT) c_->arrayBuffer = 0;
}
void Replay::glPopClientAttrib() {
    gl.glPopClientAttrib();
    if (c_->clientAttributes.empty()) return;
    const replay::SavedClientState saved = c_->clientAttributes.back();
    c_->clientAttributes.pop_back();
    if (saved.mask & GL_CLIENT_PIXEL_STORE_BIT) {
        c_->unpack = saved.unpack; // `tight` too: GL has restored its value as well
        c_->pack = saved.pack;
        c_->packBuffer = saved.packBuffer;
        c_->unpackBuffer = saved.unpackBuffer;
    }
    if (saved.mask & GL_CLIENT_VERTEX_ARRAY_BIT) c_->arrayBuffer = saved.arrayBuffer;
}

} // namespace mural
