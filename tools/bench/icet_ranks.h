/* Between compositing_bench and IceT's library: how messages get from rank to rank, and what the library does. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct icet_links {
    void* self;
    int own, ranks;
    uint64_t (*post)(void* self, int to, uint64_t tag, const void* from,
                     size_t bytes); /* which stay where they are until they are sent */
    void (*wait_sent)(void* self, int to, uint64_t number);
    size_t (*take)(void* self, int from, uint64_t tag, void* into, size_t bytes);
    int (*waiting)(void* self, int from, uint64_t tag);
    void (*wait_for_any)(void* self, const int* from, int count);
};
/* IceT's strategy DIRECT sends whole pictures to the one that shows them: what we call serial. Direct send, a band to
   each, is its radix-k with as large a k as there are ranks. */
enum icet_way { ICET_WAY_SERIAL, ICET_WAY_DIRECT_SEND, ICET_WAY_SWAP, ICET_WAY_RADIX_K };

typedef int (*icet_ranks_open_function)(const struct icet_links* links, int width, int height, enum icet_way filter);
typedef const void* (*icet_ranks_compose_function)(const void* colour, const float* depth);

#ifdef __cplusplus
}
#endif
