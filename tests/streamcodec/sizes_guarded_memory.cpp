#include "tests/streamcodec/sizes_guarded_memory.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <sys/mman.h>

namespace mural::sizes {
namespace {

// Wide guards detect layouts that are off by whole rows or images.
constexpr size_t kGuardBytes = size_t{1} << 20;
constexpr size_t kPageBytes = 4096;

struct Guards {
    uint8_t* front = nullptr;
    uint8_t* back = nullptr;
};
Guards gGuards;
std::atomic<bool> gTouched{false};
struct sigaction gPrevious = {};

bool within(const uint8_t* address, const uint8_t* guard) {
    return guard != nullptr && address >= guard && address < guard + kGuardBytes;
}

void onFault(int signal, siginfo_t* info, void* /*context*/) {
    auto* address = static_cast<uint8_t*>(info->si_addr);
    for (uint8_t* guard : {gGuards.front, gGuards.back}) {
        if (!within(address, guard)) continue;
        gTouched = true;
        mprotect(guard, kGuardBytes, PROT_READ | PROT_WRITE);
        return;
    }
    sigaction(signal, &gPrevious, nullptr); // a fault with another cause: repeats unhandled
}

} // namespace

GuardedMemory::GuardedMemory(size_t size) : size_((size + kPageBytes - 1) / kPageBytes * kPageBytes) {
    void* map = mmap(nullptr, size_ + 2 * kGuardBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (map == MAP_FAILED || gGuards.front != nullptr) std::abort();
    map_ = static_cast<uint8_t*>(map);
    begin_ = map_ + kGuardBytes;
    gGuards = {map_, begin_ + size_};
    struct sigaction action = {};
    action.sa_sigaction = onFault;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &action, &gPrevious);
    gTouched = true; // the guards are still open
    close();
}

GuardedMemory::~GuardedMemory() {
    sigaction(SIGSEGV, &gPrevious, nullptr);
    gGuards = {};
    munmap(map_, size_ + 2 * kGuardBytes);
}

bool GuardedMemory::touched() const { return gTouched; }

void GuardedMemory::close() {
    if (!gTouched) return;
    mprotect(gGuards.front, kGuardBytes, PROT_NONE);
    mprotect(gGuards.back, kGuardBytes, PROT_NONE);
    gTouched = false;
}

} // namespace mural::sizes
