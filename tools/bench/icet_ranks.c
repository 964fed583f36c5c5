/* IceT among processes, over links that the bench gives it: the communicator, and one picture put together. Built with
 * icet_kernels.c. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <IceT.h>
#include <IceTDevCommunication.h>

#include "tools/bench/icet_ranks.h"

struct group {
    struct IceTCommunicatorStruct functions;
    const struct icet_links* links;
    uint64_t context; /* tells messages of one group from those of another */
    int own, count;
    int* members; /* their ranks in the links */
};
struct request {
    struct IceTCommRequestStruct head;
    int sends, peer;
    uint64_t number, tag;
    void* into;
    size_t bytes;
};

static struct group* group_of(IceTCommunicator self) { return (struct group*)self; }
static uint64_t tag_of(const struct group* g, int tag) {
    return (g->context << 32 | (uint32_t)tag) & ~((uint64_t)1 << 63);
}
static size_t bytes_of(int count, IceTEnum type) {
    switch (type) {
    case ICET_SHORT: return 2 * (size_t)count;
    case ICET_INT:
    case ICET_FLOAT: return 4 * (size_t)count;
    case ICET_DOUBLE:
    case ICET_POINTER: return 8 * (size_t)count;
    default: return (size_t)count; /* ICET_BYTE, ICET_BOOLEAN */
    }
}

static void send_bytes(struct group* g, const void* from, size_t bytes, int to, int tag) {
    const int peer = g->members[to];
    g->links->wait_sent(g->links->self, peer, g->links->post(g->links->self, peer, tag_of(g, tag), from, bytes));
}
static void receive_bytes(struct group* g, void* into, size_t bytes, int from, int tag) {
    g->links->take(g->links->self, g->members[from], tag_of(g, tag), into, bytes);
}

static void barrier(IceTCommunicator self) {
    struct group* g = group_of(self);
    char token = 0;
    for (int r = 1; r < g->count; ++r) {
        if (g->own == 0)
            receive_bytes(g, &token, 1, r, -2);
        else if (g->own == r)
            send_bytes(g, &token, 1, 0, -2);
    }
    for (int r = 1; r < g->count; ++r) {
        if (g->own == 0)
            send_bytes(g, &token, 1, r, -3);
        else if (g->own == r)
            receive_bytes(g, &token, 1, 0, -3);
    }
}
static void send_function(IceTCommunicator self, const void* from, int count, IceTEnum type, int to, int tag) {
    send_bytes(group_of(self), from, bytes_of(count, type), to, tag);
}
static void receive_function(IceTCommunicator self, void* into, int count, IceTEnum type, int from, int tag) {
    receive_bytes(group_of(self), into, bytes_of(count, type), from, tag);
}

static IceTCommRequest request_of(int sends, int peer, uint64_t number, uint64_t tag, void* into, size_t bytes) {
    struct request* r = calloc(1, sizeof *r);
    if (!r) abort();
    r->sends = sends;
    r->peer = peer;
    r->number = number;
    r->tag = tag;
    r->into = into;
    r->bytes = bytes;
    return &r->head;
}
static IceTCommRequest isend(IceTCommunicator self, const void* from, int count, IceTEnum type, int to, int tag) {
    struct group* g = group_of(self);
    const int peer = g->members[to];
    return request_of(1, peer, g->links->post(g->links->self, peer, tag_of(g, tag), from, bytes_of(count, type)), 0,
                      NULL, 0);
}
static IceTCommRequest ireceive(IceTCommunicator self, void* into, int count, IceTEnum type, int from, int tag) {
    struct group* g = group_of(self);
    return request_of(0, g->members[from], 0, tag_of(g, tag), into, bytes_of(count, type));
}
static void wait_for(IceTCommunicator self, IceTCommRequest* which) {
    const struct icet_links* l = group_of(self)->links;
    struct request* r = (struct request*)*which;
    if (!r) return;
    if (r->sends)
        l->wait_sent(l->self, r->peer, r->number);
    else
        l->take(l->self, r->peer, r->tag, r->into, r->bytes);
    free(r);
    *which = ICET_COMM_REQUEST_NULL;
}
static int wait_any(IceTCommunicator self, int count, IceTCommRequest* all) {
    const struct icet_links* l = group_of(self)->links;
    int* peers = malloc(sizeof(int) * (size_t)(count > 0 ? count : 1));
    for (;;) {
        int receives = 0;
        for (int i = 0; i < count; ++i) {
            struct request* r = (struct request*)all[i];
            if (!r) continue;
            if (r->sends || l->waiting(l->self, r->peer, r->tag)) {
                wait_for(self, &all[i]);
                free(peers);
                return i;
            }
            peers[receives++] = r->peer;
        }
        if (receives == 0) break;
        l->wait_for_any(l->self, peers, receives);
    }
    free(peers);
    return -1;
}
static void send_receive(IceTCommunicator self, const void* from, int count, IceTEnum type, int to, int tag, void* into,
                         int into_count, IceTEnum into_type, int source, int into_tag) {
    IceTCommRequest sent = isend(self, from, count, type, to, tag);
    receive_function(self, into, into_count, into_type, source, into_tag);
    wait_for(self, &sent);
}
static void gatherv(IceTCommunicator self, const void* from, int count, IceTEnum type, void* into, const int* counts,
                    const int* offsets, int root) {
    struct group* g = group_of(self);
    if (g->own != root) {
        send_bytes(g, from, bytes_of(count, type), root, -4);
        return;
    }
    for (int r = 0; r < g->count; ++r) {
        char* at = (char*)into + bytes_of(offsets[r], type);
        if (r != root)
            receive_bytes(g, at, bytes_of(counts[r], type), r, -4);
        else if (from != ICET_IN_PLACE_COLLECT)
            memcpy(at, from, bytes_of(count, type));
    }
}
static void gather(IceTCommunicator self, const void* from, int count, IceTEnum type, void* into, int root) {
    struct group* g = group_of(self);
    int *counts = malloc(sizeof(int) * (size_t)g->count), *offsets = malloc(sizeof(int) * (size_t)g->count);
    for (int r = 0; r < g->count; ++r) {
        counts[r] = count;
        offsets[r] = r * count;
    }
    gatherv(self, from, count, type, into, counts, offsets, root);
    free(counts);
    free(offsets);
}
static void allgather(IceTCommunicator self, const void* from, int count, IceTEnum type, void* into) {
    struct group* g = group_of(self);
    const size_t bytes = bytes_of(count, type);
    const void* own = from == ICET_IN_PLACE_COLLECT ? (const char*)into + bytes * (size_t)g->own : from;
    char* copy = malloc(bytes ? bytes : 1);
    memcpy(copy, own, bytes);
    gather(self, copy, count, type, into, 0);
    free(copy);
    for (int r = 1; r < g->count; ++r) {
        if (g->own == 0)
            send_bytes(g, into, bytes * (size_t)g->count, r, -5);
        else if (g->own == r)
            receive_bytes(g, into, bytes * (size_t)g->count, 0, -5);
    }
}
static void alltoall(IceTCommunicator self, const void* from, int count, IceTEnum type, void* into) {
    struct group* g = group_of(self);
    const size_t bytes = bytes_of(count, type);
    IceTCommRequest* sent = calloc((size_t)g->count, sizeof *sent);
    for (int r = 0; r < g->count; ++r)
        if (r != g->own) sent[r] = isend(self, (const char*)from + bytes * (size_t)r, (int)bytes, ICET_BYTE, r, -6);
    for (int r = 0; r < g->count; ++r) {
        char* at = (char*)into + bytes * (size_t)r;
        if (r == g->own)
            memcpy(at, (const char*)from + bytes * (size_t)r, bytes);
        else
            receive_bytes(g, at, bytes, r, -6);
    }
    for (int r = 0; r < g->count; ++r) wait_for(self, &sent[r]);
    free(sent);
}
static int size_function(IceTCommunicator self) { return group_of(self)->count; }
static int rank_function(IceTCommunicator self) { return group_of(self)->own; }

static void destroy(IceTCommunicator self) {
    free(group_of(self)->members);
    free(self);
}
static IceTCommunicator duplicate(IceTCommunicator self);
static IceTCommunicator subset(IceTCommunicator self, int count, const IceTInt32* ranks);

static struct group* group_with(const struct icet_links* links, uint64_t context, int count) {
    struct group* g = calloc(1, sizeof *g);
    if (!g) abort();
    const struct IceTCommunicatorStruct functions = {
        duplicate, destroy,  subset, barrier,  send_function, receive_function, send_receive,  gather,        gatherv,
        allgather, alltoall, isend,  ireceive, wait_for,      wait_any,         size_function, rank_function, NULL};
    g->functions = functions;
    g->links = links;
    g->context = context & 0x7fffffff;
    g->count = count;
    g->own = -1;
    g->members = malloc(sizeof(int) * (size_t)count);
    return g;
}
static IceTCommunicator duplicate(IceTCommunicator self) {
    struct group *of = group_of(self), *g = group_with(of->links, of->context * 31 + 7, of->count);
    memcpy(g->members, of->members, sizeof(int) * (size_t)of->count);
    g->own = of->own;
    return &g->functions;
}
static IceTCommunicator subset(IceTCommunicator self, int count, const IceTInt32* ranks) {
    struct group* of = group_of(self);
    uint64_t context = of->context * 31 + 13;
    for (int i = 0; i < count; ++i) context = context * 1000003 + (uint64_t)ranks[i];
    struct group* g = group_with(of->links, context, count);
    for (int i = 0; i < count; ++i) {
        g->members[i] = of->members[ranks[i]];
        if (ranks[i] == of->own) g->own = i;
    }
    if (g->own >= 0) return &g->functions;
    destroy(&g->functions);
    return ICET_COMM_NULL;
}

__attribute__((visibility("default"))) int icet_ranks_open(const struct icet_links* links, int width, int height,
                                                           enum icet_way filter) {
    struct group* world = group_with(links, 1, links->ranks);
    for (int r = 0; r < links->ranks; ++r) world->members[r] = r;
    world->own = links->own;
    char k[16];
    snprintf(k, sizeof k, "%d", links->ranks);
    if (filter == ICET_WAY_DIRECT_SEND) setenv("ICET_MAGIC_K", k, 1); /* read by the next call */
    icetCreateContext(&world->functions);
    icetResetTiles();
    icetAddTile(0, 0, width, height, 0);
    icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_UBYTE);
    icetSetDepthFormat(ICET_IMAGE_DEPTH_FLOAT);
    icetCompositeMode(ICET_COMPOSITE_MODE_Z_BUFFER);
    icetDisable(ICET_ORDERED_COMPOSITE);
    icetStrategy(filter == ICET_WAY_SERIAL ? ICET_STRATEGY_DIRECT : ICET_STRATEGY_SEQUENTIAL);
    icetSingleImageStrategy(filter == ICET_WAY_SWAP ? ICET_SINGLE_IMAGE_STRATEGY_BSWAP
                                                    : ICET_SINGLE_IMAGE_STRATEGY_RADIXK);
    return icetGetError() == ICET_NO_ERROR;
}

/* The first rank's picture is the whole one; null for the others. */
__attribute__((visibility("default"))) const void* icet_ranks_compose(const void* colour, const float* depth) {
    const IceTDouble identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const IceTFloat nothing[4] = {0, 0, 0, 0};
    IceTImage image = icetCompositeImage(colour, depth, NULL, identity, identity, nothing);
    IceTInt tile = -1;
    icetGetIntegerv(ICET_TILE_DISPLAYED, &tile);
    return tile < 0 || icetGetError() != ICET_NO_ERROR ? NULL : icetImageGetColorcub(image);
}
