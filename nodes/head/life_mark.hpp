// Tells programs that the head has ended without a word, by a robust futex in the memory they share: the kernel marks it
// when the thread that holds it ends, also by SIGKILL. Programs read one word and need neither descriptor nor call.
#pragma once

#include <atomic>
#include <cstdint>
#include <linux/futex.h>

namespace mural {

// Held by the thread that makes it, one per thread, until it is destroyed by the same thread. The word may be written by
// anybody: the kernel follows pointers in this object only.
class LifeMark {
public:
    explicit LifeMark(std::atomic<uint32_t>& word);
    ~LifeMark();
    LifeMark(const LifeMark&) = delete;
    LifeMark& operator=(const LifeMark&) = delete;

private:
    std::atomic<uint32_t>& word_;
    robust_list entry_{};
    robust_list_head list_{};
    void* before_ = nullptr; // the C library's list of this thread
    size_t beforeBytes_ = 0;
    bool held_ = false;
};

} // namespace mural
