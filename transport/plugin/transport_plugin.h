/* The C interface of transport plug-ins. The library libmural_transport_SCHEME.so in the folder of Mural's own
 * libraries provides the connections SCHEME://host:port?name=value&… It exports one C function:
 *
 *     const struct mural_transport_plugin* mural_get_transport_plugin(void);
 *
 * The interface is plain C, so plug-in and Mural may use different compilers and C++ libraries. For plug-ins in C++,
 * exported_transport.hpp builds the table from a Connection and a Listener. Each function has the contract of the
 * method of the same name in transport/connection.hpp: one thread may read while another writes, any thread may call
 * flush and close, and every wait ends at its deadline_ns.
 */
#ifndef MURAL_TRANSPORT_PLUGIN_H
#define MURAL_TRANSPORT_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Increases with each change of the table or of a function's meaning. Mural accepts only its own version. */
#define MURAL_TRANSPORT_PLUGIN_VERSION 1
#define MURAL_TRANSPORT_PLUGIN_ENTRY "mural_get_transport_plugin"

/* Special value of deadline_ns (nanoseconds of CLOCK_MONOTONIC): no limit. A deadline in the past: do not wait. */
#define MURAL_TRANSPORT_NO_DEADLINE INT64_MAX

struct mural_transport_connection;
struct mural_transport_listener;

/* One line with the problem, its place and the next step, zero-terminated. */
struct mural_transport_error {
    char text[1024];
};

/* Functions with an error parameter return 1 on success, and 0 on failure. They write to error on failure only. */
struct mural_transport_plugin {
    uint32_t version;    /* MURAL_TRANSPORT_PLUGIN_VERSION */
    uint32_t size_bytes; /* of this table */
    const char* scheme;  /* as in the library's name */

    /* description: the complete text as the user wrote it. */
    int (*connect)(const char* description, int64_t deadline_ns, struct mural_transport_connection** into,
                   struct mural_transport_error* error);
    int (*listen)(const char* description, struct mural_transport_listener** into, struct mural_transport_error* error);

    int (*accept)(struct mural_transport_listener*, int64_t deadline_ns, struct mural_transport_connection** into,
                  struct mural_transport_error* error);
    const char* (*listener_description)(const struct mural_transport_listener*); /* valid until free_listener */
    void (*free_listener)(struct mural_transport_listener*);

    int (*read)(struct mural_transport_connection*, void* into, size_t size_bytes, int64_t deadline_ns,
                struct mural_transport_error* error);
    int (*write)(struct mural_transport_connection*, const void* bytes, size_t size_bytes, int64_t deadline_ns,
                 struct mural_transport_error* error);
    void (*flush)(struct mural_transport_connection*);
    void (*close)(struct mural_transport_connection*);
    int (*timed_out)(const struct mural_transport_connection*);
    int (*alive)(const struct mural_transport_connection*);
    const char* (*connection_description)(const struct mural_transport_connection*); /* valid until free_connection */
    uint64_t (*bytes_written)(const struct mural_transport_connection*);
    uint64_t (*bytes_read)(const struct mural_transport_connection*);
    void (*free_connection)(struct mural_transport_connection*);
};

typedef const struct mural_transport_plugin* (*mural_transport_plugin_entry)(void);

#ifdef __cplusplus
}
#endif

#endif
