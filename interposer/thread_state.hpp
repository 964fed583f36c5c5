// What one app thread needs to encode a call: a bump pointer into its chunk of the ring. In a forked child it is zero
// (interposer/process.hpp): such a state has no room, no context and no stream.
// Reached through an initial-exec thread-local pointer: 2 to 4 times cheaper than the default model.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "interposer/frame_cpu.hpp"
#include "interposer/kept_pixels.hpp"

namespace mural {

struct Context; // interposer/context.hpp

struct ThreadState {
    std::byte* cursor = nullptr;    // end of the last complete record; others may read it (release)
    std::byte* limit = nullptr;     // records must end before; null: take the slow path at every call
    std::byte* chunkEnd = nullptr;  // real end of the chunk
    Context* context = nullptr;     // current context, null: none
    bool drawLocally = true;        // draws go to the app's own context too
    bool vertexLocally = true;      // vertices too, or there are none: in contexts that know no glBegin they are errors
    bool locked = false;            // the share group's lock is held for the record being written
    bool shared = false;            // several threads use this share group: order every record
    bool drawingAwaited = false;    // the next drawing finds out the window's size, or more: beforeAwaitedDrawing
    bool mayBeWriting = false;      // its last record may have begun before its fast path was closed; the group's lock
    uint16_t stream = 0;            // number of this thread in the session, from 1
    uint32_t chunk = UINT32_MAX;    // index of the chunk, UINT32_MAX: none
    uint32_t publishedBytes = 0;    // of the chunk; the rest up to cursor is not yet visible
    uint32_t publications = 0;      // until now
    KeptPixels pixels;
    ThreadState* next = nullptr;    // all threads of the process; never removed
    std::atomic<bool> gone{false};  // the thread has ended: its entry may be taken over
    void* scratch = nullptr;        // re-packed images, strings; grows, never shrinks
    size_t scratchBytes = 0;
    void* scratch2 = nullptr;
    size_t scratch2Bytes = 0;
    FrameCpu frameCpu;
};

// Never null: threads without a context point at one idle state whose limit is null.
extern thread_local ThreadState* tThread __attribute__((tls_model("initial-exec")));

// This thread's own state, made at the first call.
ThreadState& ownThreadState();

// For a forked child: its threads are new.
void forgetThreads();

// All threads that ever encoded, by `next`.
ThreadState* firstThread();

// Memory for `bytes` bytes, valid until the next call from this thread. Null when there is none.
void* scratchMemory(ThreadState& t, size_t bytes);
void* secondScratch(ThreadState& t, size_t bytes);

} // namespace mural
