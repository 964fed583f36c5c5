// Lets programs detect that the head has ended, even without a message. It is a robust futex in their shared memory.
// The kernel marks it when the thread that holds it ends, also by SIGKILL. Programs read one word and need neither a
// descriptor nor a system call.
#pragma once

#include <atomic>
#include <cstdint>
#include <linux/futex.h>

namespace mural {

// Held by the thread that creates it, until the same thread destroys it. A thread can hold only one. Any process may
// write the word, because the kernel follows only pointers in this object.
class LivenessMark {
public:
    explicit LivenessMark(std::atomic<uint32_t>& word);
    ~LivenessMark();
    LivenessMark(const LivenessMark&) = delete;
    LivenessMark& operator=(const LivenessMark&) = delete;

private:
    std::atomic<uint32_t>& word_;
    robust_list entry_{};
    robust_list_head list_{};
    void* before_ = nullptr; // the C library's robust list of this thread
    size_t beforeBytes_ = 0;
    bool held_ = false;
};

} // namespace mural
