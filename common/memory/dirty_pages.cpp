#include "common/memory/dirty_pages.hpp"

#include <cstring>
#include <sys/mman.h>

namespace mural {

namespace {

constexpr size_t kPage = WriteWatch::kPageBytes;
constexpr size_t kComparedBytes = 64 * 1024; // up to this size a comparison costs less than a system call
constexpr uint8_t kQuietCalls = 16;          // number of comparisons of a page that cost as much as a fault
constexpr size_t kWord = 4, kBlock = 64, kMergedGap = 256;

// Compares whole blocks inline: dense changes spend most of their time here.
bool sameBytes(const std::byte* a, const std::byte* b, size_t sizeBytes) {
    if (sizeBytes != kBlock) return std::memcmp(a, b, sizeBytes) == 0;
    uint64_t left[kBlock / 8], right[kBlock / 8], differ = 0;
    std::memcpy(left, a, kBlock);
    std::memcpy(right, b, kBlock);
    for (size_t i = 0; i < kBlock / 8; ++i) differ |= left[i] ^ right[i];
    return differ == 0;
}

size_t endOf(size_t from, size_t step, size_t end) { return end - from < step ? end : from + step; }

} // namespace

struct DirtyPages::Pass {
    DirtyPages* map;
    size_t unit, gap;
    Changed changed;
    void* self;
    size_t quietFrom = 0, quietEnd = 0; // a run of pages to lock
};

bool DirtyPages::begin(void* memory, size_t sizeBytes, bool mayWatch) {
    end();
    const size_t pages = sizeBytes / kPage + 2; // the memory may begin and end within pages
    reservedBytes_ = sizeBytes + pages;
    void* own =
        mmap(nullptr, reservedBytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (own == MAP_FAILED) return false;
    memory_ = static_cast<std::byte*>(memory);
    known_ = static_cast<std::byte*>(own);
    quiet_ = reinterpret_cast<uint8_t*>(known_ + sizeBytes);
    sizeBytes_ = sizeBytes;
    if (mayWatch && sizeBytes > kComparedBytes) watch_.begin(memory, sizeBytes);
    std::memcpy(known_, memory, sizeBytes);
    return true;
}

void DirtyPages::end() {
    if (!active()) return;
    watch_.end();
    munmap(known_, reservedBytes_);
    memory_ = nullptr;
}

void DirtyPages::collect(bool exact, Changed changed, void* self) {
    Pass pass{this, exact ? kWord : kBlock, exact ? 0 : kMergedGap, changed, self};
    if (!watched()) return static_cast<void>(compare(pass, memory_, 0, sizeBytes_));
    const auto visit = [](void* p, size_t from, size_t end) {
        auto& its = *static_cast<Pass*>(p);
        its.map->comparePages(its, from, end);
    };
    if (watch_.unlocked(visit, &pass)) return lockQuiet(pass);
    watch_.end(); // the watch is lost: compare from now on
    compare(pass, memory_, 0, sizeBytes_);
}

void DirtyPages::accept(size_t fromByte, const std::byte* bytes, size_t sizeBytes, Changed changed, void* self) {
    compare(Pass{this, kWord, 0, changed, self}, bytes - fromByte, fromByte, fromByte + sizeBytes);
}

// Compares unlocked pages. Collects pages without recent changes into runs, and locks the runs.
void DirtyPages::comparePages(Pass& pass, size_t fromByte, size_t endByte) {
    const size_t inPage = reinterpret_cast<uintptr_t>(memory_) % kPage;
    for (size_t at = fromByte, next = 0; at < endByte; at = next) {
        const size_t page = (at + inPage) / kPage;
        next = (page + 1) * kPage - inPage < endByte ? (page + 1) * kPage - inPage : endByte;
        if (compare(pass, memory_, at, next)) {
            quiet_[page] = 0;
            continue;
        }
        if (++quiet_[page] < kQuietCalls) continue;
        quiet_[page] = 0;
        if (pass.quietEnd != at) {
            lockQuiet(pass);
            pass.quietFrom = at;
        }
        pass.quietEnd = next;
    }
}

// Locks the run before its last comparison: later writes unlock pages again.
void DirtyPages::lockQuiet(Pass& pass) {
    if (pass.quietEnd == pass.quietFrom) return;
    const auto visit = [](void* p, size_t from, size_t end) {
        auto& its = *static_cast<Pass*>(p);
        its.map->compare(its, its.map->memory_, from, end);
    };
    // If the watch is lost here, the next call detects it.
    if (!watch_.lock(pass.quietFrom, pass.quietEnd, visit, &pass))
        compare(pass, memory_, pass.quietFrom, pass.quietEnd);
    pass.quietFrom = pass.quietEnd = 0;
}

// Returns true if anything has changed. Reports changed units with small gaps as one run, from the copy, because the
// program may continue to write.
bool DirtyPages::compare(const Pass& pass, const std::byte* with, size_t fromByte, size_t endByte) {
    bool any = false;
    const auto same = [this, with](size_t from, size_t end) {
        return sameBytes(known_ + from, with + from, end - from);
    };
    size_t runFrom = 0, runEnd = 0;
    const auto report = [&] {
        if (runEnd == runFrom) return;
        std::memcpy(known_ + runFrom, with + runFrom, runEnd - runFrom);
        pass.changed(pass.self, runFrom, known_ + runFrom, runEnd - runFrom);
        any = true;
    };
    for (size_t at = fromByte, next = 0; at < endByte; at = next) {
        next = endOf(at, kPage, endByte);
        if (same(at, next)) continue;
        for (size_t unit = at, end = 0; unit < next; unit = end) {
            end = endOf(unit, pass.unit, next);
            if (same(unit, end)) continue;
            if (runEnd == runFrom || unit - runEnd > pass.gap) {
                report();
                runFrom = unit;
            }
            runEnd = end;
        }
    }
    report();
    return any;
}

} // namespace mural
