/* What a codec plug-in offers: a library libmural_codec_NAME.so in a folder that the registry is told of carries the codec
 * NAME. It exports one C function:
 *
 *     const struct mural_codec_plugin* mural_get_codec_plugin(void);
 *
 * Plain C, so that compiler and C++ library may differ. What each function promises is what compositor/codecs/codec.hpp says
 * of the method of its name. A codec is used by one thread at a time; several codecs of one plug-in by several.
 */
#ifndef MURAL_CODEC_PLUGIN_H
#define MURAL_CODEC_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Raised whenever the table or a function's meaning changes; Mural takes its own version only. */
#define MURAL_CODEC_PLUGIN_VERSION 1
#define MURAL_CODEC_PLUGIN_ENTRY "mural_get_codec_plugin"

/* Numbers of plane formats, as in compositor/image/plane_format.hpp; 4, 4, 8, 16, 4 and 4 bytes per pixel. */
enum mural_plane_format {
    MURAL_PLANE_RGBA8 = 0,
    MURAL_PLANE_RGB10A2 = 1,
    MURAL_PLANE_RGBA16F = 2,
    MURAL_PLANE_RGBA32F = 3,
    MURAL_PLANE_D24S8 = 4,
    MURAL_PLANE_D32F = 5
};

struct mural_codec;

/* One line: what, where, next step. Ends with a zero. */
struct mural_codec_error {
    char text[1024];
};

struct mural_codec_shape {
    uint32_t format;
    int32_t width;
    int32_t height;
};

/* Row 0 stands at pixels, the next ones stride_bytes further on each. */
struct mural_codec_plane {
    struct mural_codec_shape shape;
    int64_t stride_bytes;
    void* pixels;
};

/* Functions with an error return 1 when it worked and 0 when not; error is written to only then. */
struct mural_codec_plugin {
    uint32_t version;    /* MURAL_CODEC_PLUGIN_VERSION */
    uint32_t size_bytes; /* of this table */
    const char* name;    /* as in the library's name */
    uint32_t lossless;   /* 1, or 0 */
    uint32_t formats;    /* a bit 1 << FORMAT for each that it takes */

    struct mural_codec* (*create)(struct mural_codec_error* error); /* null: it did not work */
    void (*destroy)(struct mural_codec*);
    uint64_t (*bound_bytes)(const struct mural_codec*, const struct mural_codec_shape*);
    int (*encode)(struct mural_codec*, const struct mural_codec_plane*, void* into, uint64_t room_bytes, uint64_t* written_bytes, struct mural_codec_error* error);
    int (*decode)(struct mural_codec*, const void* bytes, uint64_t size_bytes, const struct mural_codec_plane* into, struct mural_codec_error* error);
};

typedef const struct mural_codec_plugin* (*mural_codec_plugin_entry)(void);

#ifdef __cplusplus
}
#endif

#endif
