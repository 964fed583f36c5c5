// State that belongs to one process and ends in a forked child. The kernel clears it in the child (MADV_WIPEONFORK), so a
// child is recognised without a system call, also where no handler of pthread_atfork runs: raw fork and clone.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace mural {

class Session;

namespace process {

struct alignas(4096) Page {
    std::atomic<uint32_t> number;    // counts the forks of a line of processes, from 1; 0: a child that has not begun yet
    std::atomic<uint32_t> beginning; // 1: a thread has begun the child
    Session* session;                // null: none, or not connected yet
    bool connectTried;
};
extern Page page;

// Begins the process: calls the child handler when the parent had begun before. Returns its number.
uint32_t begin();

inline uint32_t number() {
    const uint32_t known = page.number.load(std::memory_order_acquire);
    return known != 0 ? known : begin();
}

// Called once in each forked child, by the thread that first uses the interposer there.
void onChildBegins(void (*handler)());
// For the handler of pthread_atfork: kernels before 4.14 do not clear the page.
void forked();
// This process, or one that it was forked from, has been captured.
[[nodiscard]] bool everCaptured();

// Zeroed memory, which a forked child finds zeroed again. Never freed. Null: there is no memory.
void* memory(size_t sizeBytes);

} // namespace process

} // namespace mural
