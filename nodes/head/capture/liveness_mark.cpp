#include "nodes/head/capture/liveness_mark.hpp"

#include <sys/syscall.h>
#include <unistd.h>

namespace mural {

LivenessMark::LivenessMark(std::atomic<uint32_t>& word) : word_(word) {
    if (syscall(SYS_get_robust_list, 0, &before_, &beforeBytes_) != 0) return;
    entry_.next = &list_.list; // one entry, then the list's head again
    list_.list.next = &entry_;
    list_.futex_offset = reinterpret_cast<char*>(&word_) - reinterpret_cast<char*>(&entry_);
    held_ = syscall(SYS_set_robust_list, &list_, sizeof list_) == 0;
    if (held_) word_.store(static_cast<uint32_t>(gettid()), std::memory_order_release);
}

LivenessMark::~LivenessMark() {
    if (!held_) return;
    word_.store(FUTEX_OWNER_DIED, std::memory_order_release);
    syscall(SYS_set_robust_list, before_, beforeBytes_);
}

} // namespace mural
