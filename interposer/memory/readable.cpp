#include "interposer/memory/readable.hpp"

#include <cerrno>
#include <sys/syscall.h>
#include <unistd.h>

namespace mural {

namespace {

constexpr uintptr_t kPageBytes = 4096; // smallest page size; larger pages are checked more than once

// sigprocmask reads the new mask before it rejects the unknown operation. Sandboxes allow it, because libc needs it.
// They may reject process_vm_readv, or kill a program for it.
bool isReadable(uintptr_t at) {
    constexpr int kUnknownOperation = -1;
    constexpr uintptr_t kMaskBytes = 8;
    if (at < kMaskBytes) return false; // a null mask is not read
    const int before = errno;
    const long result = syscall(SYS_rt_sigprocmask, kUnknownOperation, at & ~(kMaskBytes - 1), nullptr, kMaskBytes);
    const bool faulted = result != 0 && errno == EFAULT;
    errno = before;
    return !faulted;
}

} // namespace

uint64_t readableBytes(const void* memory, uint64_t sizeBytes) {
    const auto begin = reinterpret_cast<uintptr_t>(memory);
    for (uintptr_t at = begin; at < begin + sizeBytes; at = (at / kPageBytes + 1) * kPageBytes)
        if (!isReadable(at)) return at - begin;
    return sizeBytes;
}

} // namespace mural
