#include "interposer/context/thread_state.hpp"

#include <climits>
#include <cstdlib>
#include <pthread.h>

#include "interposer/context/context.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/process/process.hpp"
#include "interposer/encode/session.hpp"

namespace mural {

namespace {
constinit ThreadState idleThread;
Lock listLock;
ThreadState* allThreads = nullptr;
uint16_t lastStream = 0;
pthread_key_t endKey;
pthread_once_t endKeyOnce = PTHREAD_ONCE_INIT;

// Ends a thread: publishes its records and leaves its entry to the next thread.
void threadEnded(void* p) {
    auto* t = static_cast<ThreadState*>(p);
    if (t->stream == 0) return; // the forking thread, in the child
    // Destructors of other keys may still call GL. The last round ends the thread.
    if (++t->endRounds < PTHREAD_DESTRUCTOR_ITERATIONS && pthread_setspecific(endKey, t) == 0) return;
    t->endRounds = 0;
    threadLeaves(*t);
    if (Session* s = Session::current()) s->publish(*t, true);
    t->cursor = t->limit = t->chunkEnd = nullptr;
    tThread = &idleThread; // before another thread can take the entry over
    t->gone.store(true, std::memory_order_release);
}

ThreadState* takeOver() {
    for (ThreadState* t = allThreads; t; t = t->next) {
        bool gone = true;
        if (t->gone.compare_exchange_strong(gone, false)) return t;
    }
    return nullptr;
}

void* grow(void*& memory, size_t& have, size_t bytes) {
    if (bytes > have) {
        void* larger = std::realloc(memory, bytes + bytes / 4);
        if (!larger) return nullptr;
        memory = larger;
        have = bytes + bytes / 4;
    }
    return memory;
}
} // namespace

constinit thread_local ThreadState* tThread __attribute__((tls_model("initial-exec"))) = &idleThread;

ThreadState& ownThreadState() {
    if (tThread->stream != 0) return *tThread; // a forked child finds the parent's state zeroed
    pthread_once(&endKeyOnce, [] { pthread_key_create(&endKey, threadEnded); });
    Guard guard(listLock);
    ThreadState* t = takeOver();
    if (!t) {
        t = static_cast<ThreadState*>(process::memory(sizeof(ThreadState)));
        if (!t) return idleThread;
        t->drawLocally = t->vertexLocally = true;
        t->chunk = UINT32_MAX;
        t->stream = ++lastStream;
        t->next = allThreads;
        allThreads = t;
    }
    pthread_setspecific(endKey, t);
    tThread = t;
    return *t;
}

void forgetThreads() {
    pthread_once(&endKeyOnce, [] { pthread_key_create(&endKey, threadEnded); });
    pthread_setspecific(endKey, nullptr);
    Guard guard(listLock);
    __atomic_store_n(&allThreads, nullptr, __ATOMIC_RELEASE);
    lastStream = 0;
    tThread = &idleThread;
}

ThreadState* firstThread() { return __atomic_load_n(&allThreads, __ATOMIC_ACQUIRE); }

void* scratchMemory(ThreadState& t, size_t bytes) { return grow(t.scratch, t.scratchBytes, bytes); }
void* secondScratch(ThreadState& t, size_t bytes) { return grow(t.scratch2, t.scratch2Bytes, bytes); }

} // namespace mural
