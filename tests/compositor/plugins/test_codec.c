/* A codec plug-in that inverts all bits, and invalid variants of it: each build has another fault, by a macro of
 * CMakeLists.txt. */
#include "compositor/codecs/plugin/codec_plugin.h"

#include <stdlib.h>
#include <string.h>

#ifndef TEST_VERSION
#define TEST_VERSION MURAL_CODEC_PLUGIN_VERSION
#endif
#ifndef TEST_SIZE_BYTES
#define TEST_SIZE_BYTES sizeof(struct mural_codec_plugin)
#endif
#ifndef TEST_ENTRY
#define TEST_ENTRY mural_get_codec_plugin
#endif
#ifndef TEST_EXTRA_BYTES
#define TEST_EXTRA_BYTES 0
#endif

struct mural_codec {
    int planes;
};

static struct mural_codec* create(struct mural_codec_error* error) {
    (void)error;
    return calloc(1, sizeof(struct mural_codec));
}
static void destroy(struct mural_codec* codec) { free(codec); }

static uint64_t row_bytes(const struct mural_codec_shape* shape) { return (uint64_t)shape->width * 4; }
static uint64_t bound_bytes(const struct mural_codec* codec, const struct mural_codec_shape* shape) {
    (void)codec;
    return row_bytes(shape) * (uint64_t)shape->height;
}

static void invert(unsigned char* to, const unsigned char* from, uint64_t count) {
    for (uint64_t i = 0; i < count; ++i) to[i] = (unsigned char)~from[i];
}

static int encode(struct mural_codec* codec, const struct mural_codec_plane* plane, void* into, uint64_t room_bytes,
                  uint64_t* written_bytes, struct mural_codec_error* error) {
    const uint64_t row = row_bytes(&plane->shape);
    if (room_bytes < bound_bytes(codec, &plane->shape)) {
        strcpy(error->text, "codec inverted: no room; give it more");
        return 0;
    }
    for (int32_t y = 0; y < plane->shape.height; ++y)
        invert((unsigned char*)into + (uint64_t)y * row, (const unsigned char*)plane->pixels + y * plane->stride_bytes,
               row);
    *written_bytes = bound_bytes(codec, &plane->shape) + TEST_EXTRA_BYTES;
    return 1;
}

static int decode(struct mural_codec* codec, const void* bytes, uint64_t size_bytes,
                  const struct mural_codec_plane* into, struct mural_codec_error* error) {
    const uint64_t row = row_bytes(&into->shape);
    if (size_bytes != bound_bytes(codec, &into->shape)) {
        strcpy(error->text, "codec inverted: another size; check the sender");
        return 0;
    }
    for (int32_t y = 0; y < into->shape.height; ++y)
        invert((unsigned char*)into->pixels + y * into->stride_bytes, (const unsigned char*)bytes + (uint64_t)y * row,
               row);
    return 1;
}

const struct mural_codec_plugin* TEST_ENTRY(void);

const struct mural_codec_plugin* TEST_ENTRY(void) {
    static const struct mural_codec_plugin table = {.version = TEST_VERSION,
                                                    .size_bytes = TEST_SIZE_BYTES,
                                                    .name = TEST_NAME,
                                                    .lossless = 1,
                                                    .formats = 1u << MURAL_PLANE_RGBA8,
                                                    .create = create,
                                                    .destroy = destroy,
                                                    .bound_bytes = bound_bytes,
                                                    .encode = encode,
                                                    .decode = decode};
    return &table;
}
