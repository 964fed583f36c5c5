// State of one app thread for the encoding of calls: a bump pointer into its chunk of the ring. In a forked child the
// state is zero (interposer/process/process.hpp): it has no room, no context and no stream.
//
// It is reached through an initial-exec thread-local pointer, which is 2 to 4 times cheaper than the default model.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "interposer/encode/frame_cpu.hpp"
#include "interposer/readback/read_pixels_cache.hpp"

namespace mural {

struct Context; // interposer/context/context.hpp

struct ThreadState {
    std::byte* cursor = nullptr;   // end of the last complete record; other threads may read it (release)
    std::byte* limit = nullptr;    // limit of records; null: every call takes the slow path
    std::byte* chunkEnd = nullptr; // actual end of the chunk
    Context* context = nullptr;    // current context; null: none
    bool drawLocally = true;       // the app's own context executes draws as well
    bool vertexLocally = true;     // also vertices; true without glBegin, where they are errors
    bool locked = false;           // the share group's lock is held for the current record
    bool shared = false;           // several threads use this share group: every record is ordered
    bool drawingAwaited = false;   // the next draw must call beforeAwaitedDrawing
    // the last record may have begun before its fast path was closed; guarded by the group's lock
    bool mayBeWriting = false;
    uint16_t stream = 0;         // number of this thread in the session, from 1
    uint32_t chunk = UINT32_MAX; // index of the chunk; UINT32_MAX: none
    uint32_t chunksTaken = 0;    // number of chunks so far
    uint32_t publishedBytes = 0; // position in the chunk; later records are not visible yet
    uint32_t publications = 0;   // number of publications so far
    ReadPixelsCache pixels;
    ThreadState* next = nullptr;   // list of all threads of the process; entries are never removed
    int endRounds = 0;             // rounds of key destructors that this thread has run
    std::atomic<bool> gone{false}; // the thread has ended; another one may take over its entry
    void* scratch = nullptr;       // for re-packed images and strings; grows, never shrinks
    size_t scratchBytes = 0;
    void* scratch2 = nullptr;
    size_t scratch2Bytes = 0;
    FrameCpu frameCpu;
};

// Never null: threads without a context share one idle state whose limit is null.
extern thread_local ThreadState* tThread __attribute__((tls_model("initial-exec")));

// Returns this thread's own state. Creates it at the first call.
ThreadState& ownThreadState();

// For a forked child: drops all entries, because its threads are new.
void forgetThreads();

// First of all threads that have ever encoded, linked by `next`.
ThreadState* firstThread();

// Returns memory for `bytes` bytes, valid until the thread's next call. Null: no memory.
void* scratchMemory(ThreadState& t, size_t bytes);
void* secondScratch(ThreadState& t, size_t bytes);

} // namespace mural
