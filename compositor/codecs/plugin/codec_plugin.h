/* The C interface of codec plug-ins. The library libmural_codec_NAME.so provides the codec NAME. It is in the folder
 * that the registry receives, and exports one C function:
 *
 *     const struct mural_codec_plugin* mural_get_codec_plugin(void);
 *
 * The interface is plain C, so plug-in and Mural may use different compilers and C++ libraries. Each function has the
 * contract of the method of the same name in compositor/codecs/codec.hpp. One thread at a time uses a codec; several
 * threads may use several codecs of one plug-in.
 */
#ifndef MURAL_CODEC_PLUGIN_H
#define MURAL_CODEC_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Increases with each change of the table or of a function's meaning. Mural accepts only its own version. */
#define MURAL_CODEC_PLUGIN_VERSION 1
#define MURAL_CODEC_PLUGIN_ENTRY "mural_get_codec_plugin"

/* Plane formats, with the values of compositor/image/plane_format.hpp: 4, 4, 8, 16, 4 and 4 bytes per pixel. */
enum mural_plane_format {
    MURAL_PLANE_RGBA8 = 0,
    MURAL_PLANE_RGB10A2 = 1,
    MURAL_PLANE_RGBA16F = 2,
    MURAL_PLANE_RGBA32F = 3,
    MURAL_PLANE_D24S8 = 4,
    MURAL_PLANE_D32F = 5
};

struct mural_codec;

/* One line with the problem, its place and the next step, zero-terminated. */
struct mural_codec_error {
    char text[1024];
};

struct mural_codec_shape {
    uint32_t format;
    int32_t width;
    int32_t height;
};

/* Row 0 begins at pixels; each next row begins stride_bytes later. */
struct mural_codec_plane {
    struct mural_codec_shape shape;
    int64_t stride_bytes;
    void* pixels;
};

/* Functions with an error parameter return 1 on success, and 0 on failure. They write to error on failure only. */
struct mural_codec_plugin {
    uint32_t version;    /* MURAL_CODEC_PLUGIN_VERSION */
    uint32_t size_bytes; /* of this table */
    const char* name;    /* as in the library's name */
    uint32_t lossless;   /* 1, or 0 */
    uint32_t formats;    /* accepted formats: one bit 1 << FORMAT each */

    struct mural_codec* (*create)(struct mural_codec_error* error); /* returns null on failure */
    void (*destroy)(struct mural_codec*);
    uint64_t (*bound_bytes)(const struct mural_codec*, const struct mural_codec_shape*);
    int (*encode)(struct mural_codec*, const struct mural_codec_plane*, void* into, uint64_t room_bytes,
                  uint64_t* written_bytes, struct mural_codec_error* error);
    int (*decode)(struct mural_codec*, const void* bytes, uint64_t size_bytes, const struct mural_codec_plane* into,
                  struct mural_codec_error* error);
};

typedef const struct mural_codec_plugin* (*mural_codec_plugin_entry)(void);

#ifdef __cplusplus
}
#endif

#endif
