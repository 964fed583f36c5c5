#include "interposer/process/process.hpp"

#include <cstdlib>
#include <sys/mman.h>
#include <time.h>

namespace mural::process {

constinit Page page{}; // in .bss, because the kernel clears private anonymous memory only

namespace {

// Children inherit it.
uint32_t lastNumber = 0;
void (*childHandler)() = nullptr;

void waitUntilBegun() {
    const timespec nap{0, 100'000};
    while (page.number.load(std::memory_order_acquire) == 0) nanosleep(&nap, nullptr);
}

} // namespace

uint32_t begin() {
    uint32_t nobody = 0;
    if (!page.beginning.compare_exchange_strong(nobody, 1)) {
        waitUntilBegun();
        return page.number.load(std::memory_order_acquire);
    }
    const bool isChild = lastNumber != 0;
    const uint32_t number = ++lastNumber;
    if (!isChild) madvise(&page, sizeof page, MADV_WIPEONFORK);
    page.number.store(number, std::memory_order_release);
    if (isChild && childHandler) childHandler();
    return number;
}

void onChildBegins(void (*handler)()) { childHandler = handler; }

void forked() {
    page.session = nullptr;
    page.connectTried = false;
    page.beginning.store(0, std::memory_order_relaxed);
    page.number.store(0, std::memory_order_release);
    begin();
}

bool everCaptured() { return childHandler != nullptr; }

void* memory(size_t sizeBytes) {
    void* const pages = mmap(nullptr, sizeBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) return std::calloc(1, sizeBytes);
    madvise(pages, sizeBytes, MADV_WIPEONFORK);
    return pages;
}

} // namespace mural::process
