#include "interposer/process/forked_child.hpp"

#include <pthread.h>
#include <time.h>

#include "interposer/context/context.hpp"
#include "interposer/context/object_registry.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/readback/deferred_replies.hpp"
#include "interposer/process/process.hpp"
#include "interposer/context/thread_state.hpp"

namespace mural {

namespace {

thread_local constinit bool tablesHeld __attribute__((tls_model("initial-exec"))) = false;

void childBegins() {
    forgetThreads();
    known::inherit();
    deferred::forgetAll();
    forgetDriverEvents();
}

// Locks the tables, because the child copies them and no other thread may be changing them. The wait is bounded,
// because a signal handler of the thread that holds the lock may fork.
void beforeFork() {
    constexpr int kTries = 100;
    const timespec nap{0, 200'000};
    tablesHeld = known::tables().tryLock();
    for (int i = 0; i < kTries && !tablesHeld; ++i) {
        nanosleep(&nap, nullptr);
        tablesHeld = known::tables().tryLock();
    }
}

void afterFork() {
    if (tablesHeld) known::tables().unlock();
    tablesHeld = false;
}

void inChild() {
    tablesHeld = false;
    process::forked(); // a lock of the parent counts as free in the child
}

} // namespace

void expectForks() {
    if (process::everCaptured()) return; // a child inherits its parent's handlers
    process::onChildBegins(childBegins);
    pthread_atfork(beforeFork, afterFork, inChild);
}

void inheritedUsed(Window* window) {
    static bool once = false;
    if (window) window->inherited = true;
    if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED))
        say("a forked child draws with a context of its parent, which is not captured; create the context after the "
            "fork");
}

} // namespace mural
