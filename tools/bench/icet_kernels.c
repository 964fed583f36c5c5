/* IceT's blending of two images, for compositing_bench to time beside ours. Built by tools/bench/compositing --icet
 * DIR, against the sources of IceT 2 that lie in DIR; nothing of IceT comes into Mural's tree or programs. */
#include <stdlib.h>
#include <string.h>

#include <IceT.h>
#include <IceTDevContext.h>
#include <IceTDevImage.h>
#include <IceTDevState.h>

/* One process, which talks to nobody: what is timed needs no messages. */
static IceTCommunicator duplicate(IceTCommunicator self);
static void destroy(IceTCommunicator self) { (void)self; }
static void barrier(IceTCommunicator self) { (void)self; }
static int one(IceTCommunicator self) {
    (void)self;
    return 1;
}
static int zero(IceTCommunicator self) {
    (void)self;
    return 0;
}
static struct IceTCommunicatorStruct alone;
static IceTCommunicator duplicate(IceTCommunicator self) {
    (void)self;
    return &alone;
}

static struct {
    int width, height;
    IceTImage back, front;
    IceTSparseImage sparse_back, sparse_front, sparse_result;
} bench;

__attribute__((visibility("default"))) int icet_bench_open(int width, int height) {
    alone.Duplicate = duplicate;
    alone.Destroy = destroy;
    alone.Barrier = barrier;
    alone.Comm_size = one;
    alone.Comm_rank = zero;
    icetCreateContext(&alone);
    icetSetColorFormat(ICET_IMAGE_COLOR_RGBA_UBYTE);
    icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
    icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
    bench.width = width;
    bench.height = height;
    const size_t image_bytes = (size_t)icetImageBufferSize(width, height),
                 sparse_bytes = (size_t)icetSparseImageBufferSize(width, height);
    void* memory[5];
    for (int i = 0; i < 5; ++i) {
        memory[i] = calloc(1, i < 2 ? image_bytes : sparse_bytes);
        if (!memory[i]) return 0;
    }
    bench.back = icetImageAssignBuffer(memory[0], width, height);
    bench.front = icetImageAssignBuffer(memory[1], width, height);
    bench.sparse_back = icetSparseImageAssignBuffer(memory[2], width, height);
    bench.sparse_front = icetSparseImageAssignBuffer(memory[3], width, height);
    bench.sparse_result = icetSparseImageAssignBuffer(memory[4], width, height);
    return icetGetError() == ICET_NO_ERROR;
}

__attribute__((visibility("default"))) void icet_bench_load(const void* back, const void* front) {
    const size_t size_bytes = 4 * (size_t)bench.width * (size_t)bench.height;
    memcpy(icetImageGetColorub(bench.back), back, size_bytes);
    memcpy(icetImageGetColorub(bench.front), front, size_bytes);
    icetCompressImage(bench.back, bench.sparse_back);
    icetCompressImage(bench.front, bench.sparse_front);
}

/* Two plain images into one of them. */
__attribute__((visibility("default"))) void icet_bench_blend(void) { icetComposite(bench.back, bench.front, 1); }

/* Two compressed ones into a third, as IceT's strategies do. */
__attribute__((visibility("default"))) void icet_bench_blend_compressed(void) {
    icetCompressedCompressedComposite(bench.sparse_front, bench.sparse_back, bench.sparse_result);
}
