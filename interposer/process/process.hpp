// State of one process, which a forked child does not inherit. The kernel clears it in the child (MADV_WIPEONFORK). A
// child is thus recognised without a system call. This also works for raw fork and clone, which run no handler of
// pthread_atfork.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace mural {

class Session;

namespace process {

struct alignas(4096) Page {
    // number of forks from the first ancestor, from 1; 0: a child that is not initialised yet
    std::atomic<uint32_t> number;
    std::atomic<uint32_t> beginning; // 1: a thread initialises the child
    Session* session;                // null: none, or not connected yet
    bool connectTried;
};
extern Page page;

// Initialises the state of this process. Calls the child handler if the parent was initialised. Returns the process
// number.
uint32_t begin();

inline uint32_t number() {
    const uint32_t known = page.number.load(std::memory_order_acquire);
    return known != 0 ? known : begin();
}

// Sets the handler that runs once in each forked child, in the thread that first uses the interposer there.
void onChildBegins(void (*handler)());
// For the handler of pthread_atfork, because kernels before 4.14 do not clear the page.
void forked();
// Returns whether this process or one of its ancestors has been captured.
[[nodiscard]] bool everCaptured();

// Returns zeroed memory, which is zeroed again in a forked child. Never freed. Null: no memory.
void* memory(size_t sizeBytes);

} // namespace process

} // namespace mural
