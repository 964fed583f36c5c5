/* What a transport plug-in offers: a library libmural_transport_SCHEME.so beside Mural's own libraries carries the
 * connections SCHEME://host:port?name=value&… It exports one C function:
 *
 *     const struct mural_transport_plugin* mural_get_transport_plugin(void);
 *
 * Plain C, so that compiler and C++ library may differ. In C++, exported_transport.hpp makes the table of a Connection and a
 * Listener. What each function promises is what transport/connection.hpp says of the method of its name: one thread reads
 * while another writes, flush and close come from any thread, and no wait goes on after its deadline_ns.
 */
#ifndef MURAL_TRANSPORT_PLUGIN_H
#define MURAL_TRANSPORT_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Raised whenever the table or a function's meaning changes; Mural takes its own version only. */
#define MURAL_TRANSPORT_PLUGIN_VERSION 1
#define MURAL_TRANSPORT_PLUGIN_ENTRY "mural_get_transport_plugin"

/* deadline_ns: nanoseconds of CLOCK_MONOTONIC; in the past: take only what is there; this: no limit. */
#define MURAL_TRANSPORT_NO_DEADLINE INT64_MAX

struct mural_transport_connection;
struct mural_transport_listener;

/* One line: what, where, next step. Ends with a zero. */
struct mural_transport_error {
    char text[1024];
};

/* Functions with an error return 1 when it worked and 0 when not; error is written to only then. */
struct mural_transport_plugin {
    uint32_t version;    /* MURAL_TRANSPORT_PLUGIN_VERSION */
    uint32_t size_bytes; /* of this table */
    const char* scheme;  /* as in the library's name */

    /* description: the whole text, as the user wrote it. */
    int (*connect)(const char* description, int64_t deadline_ns, struct mural_transport_connection** into, struct mural_transport_error* error);
    int (*listen)(const char* description, struct mural_transport_listener** into, struct mural_transport_error* error);

    int (*accept)(struct mural_transport_listener*, int64_t deadline_ns, struct mural_transport_connection** into, struct mural_transport_error* error);
    const char* (*listener_description)(const struct mural_transport_listener*); /* stays until free */
    void (*free_listener)(struct mural_transport_listener*);

    int (*read)(struct mural_transport_connection*, void* into, size_t size_bytes, int64_t deadline_ns, struct mural_transport_error* error);
    int (*write)(struct mural_transport_connection*, const void* bytes, size_t size_bytes, int64_t deadline_ns, struct mural_transport_error* error);
    void (*flush)(struct mural_transport_connection*);
    void (*close)(struct mural_transport_connection*);
    int (*timed_out)(const struct mural_transport_connection*);
    int (*alive)(const struct mural_transport_connection*);
    const char* (*connection_description)(const struct mural_transport_connection*); /* stays until free */
    uint64_t (*bytes_written)(const struct mural_transport_connection*);
    uint64_t (*bytes_read)(const struct mural_transport_connection*);
    void (*free_connection)(struct mural_transport_connection*);
};

typedef const struct mural_transport_plugin* (*mural_transport_plugin_entry)(void);

#ifdef __cplusplus
}
#endif

#endif
