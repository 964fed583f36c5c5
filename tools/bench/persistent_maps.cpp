// Compares methods by which a preloaded library detects writes into persistently mapped memory, in one run. A frame has
// several draws; before each the program writes its share of the frame's bytes, then the method finds and copies the
// changes. Prints microseconds per draw beyond the writes.
//
//   persistent_maps [--quick]
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <poll.h>
#include <pthread.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/memory/dirty_pages.hpp"
#include "common/memory/write_watch.hpp"

namespace {

constexpr size_t kPage = 4096;
std::vector<std::byte> sink; // destination of changes, in place of the stream

// A detection method.
struct ChosenFilter {
    virtual ~ChosenFilter() = default;
    virtual bool begin(std::byte* memory, size_t size) = 0;
    virtual void beforeDraw() = 0;
    std::byte* memory_ = nullptr;
    size_t size_ = 0;
};

void copyOut(const std::byte* from, size_t size) { std::memcpy(sink.data(), from, std::min(size, sink.size())); }

// Compares every byte with a copy, by libc's vectorized memcmp.
struct Comparison : ChosenFilter {
    std::vector<std::byte> shadow;
    bool begin(std::byte* memory, size_t size) override {
        memory_ = memory, size_ = size;
        shadow.assign(memory, memory + size);
        return true;
    }
    void beforeDraw() override { compare(0, size_); }
    void compare(size_t from, size_t end) {
        constexpr size_t kBlock = 1024;
        for (size_t at = from; at < end; at += kBlock) {
            if (std::memcmp(shadow.data() + at, memory_ + at, kBlock) == 0) continue;
            std::memcpy(shadow.data() + at, memory_ + at, kBlock);
            copyOut(memory_ + at, kBlock);
        }
    }
};

// Hashes every page: no copy to read, but more work per byte.
struct Hashes : ChosenFilter {
    std::vector<uint64_t> known;
    static uint64_t hash(const std::byte* page) {
        uint64_t lanes[8] = {};
        for (size_t at = 0; at < kPage; at += 64) {
            uint64_t words[8];
            std::memcpy(words, page + at, sizeof words);
            for (int i = 0; i < 8; ++i) lanes[i] = (lanes[i] ^ words[i]) * 0x9E3779B97F4A7C15U;
        }
        uint64_t all = 0;
        for (const uint64_t lane : lanes) all = (all ^ lane ^ lane >> 29) * 0xBF58476D1CE4E5B9U;
        return all;
    }
    bool begin(std::byte* memory, size_t size) override {
        memory_ = memory, size_ = size;
        for (size_t at = 0; at < size; at += kPage) known.push_back(hash(memory + at));
        return true;
    }
    void beforeDraw() override {
        for (size_t page = 0; page < known.size(); ++page) {
            const uint64_t now = hash(memory_ + page * kPage);
            if (now == known[page]) continue;
            known[page] = now;
            copyOut(memory_ + page * kPage, kPage);
        }
    }
};

// The kernel marks and lists written pages, which are compared with the copy.
struct Watch : Comparison {
    mural::WriteWatch watch;
    bool begin(std::byte* memory, size_t size) override {
        return Comparison::begin(memory, size) && watch.begin(memory, size);
    }
    void beforeDraw() override {
        const bool locked = watch.lock(
            0, size_, [](void* self, size_t from, size_t end) { static_cast<Watch*>(self)->compare(from, end); }, this);
        if (!locked) std::abort();
    }
};

// Mural's method: as Watch, but recently written pages stay unlocked and are compared.
struct Chosen : ChosenFilter {
    mural::DirtyPages changes;
    bool begin(std::byte* memory, size_t size) override { return changes.begin(memory, size); }
    void beforeDraw() override {
        changes.collect(
            false, [](void*, size_t, const std::byte* bytes, size_t size) { copyOut(bytes, size); }, nullptr);
    }
};

// Base of methods that report written pages, which are protected again.
struct Marked : Comparison {
    std::vector<std::atomic<uint8_t>> dirty;
    std::atomic<bool> any{false};
    void mark(size_t page) {
        dirty[page].store(1, std::memory_order_relaxed);
        any.store(true, std::memory_order_release);
    }
    virtual void protect(size_t from, size_t size) = 0;
    void beforeDraw() override {
        if (!any.exchange(false)) return;
        for (size_t page = 0; page < dirty.size(); ++page) {
            const size_t first = page;
            while (page < dirty.size() && dirty[page].exchange(0)) ++page;
            if (page == first) continue;
            protect(first * kPage, (page - first) * kPage);
            compare(first * kPage, page * kPage);
        }
    }
};

// mprotect, with SIGSEGV at the first write to a page. System calls that write there fail (EFAULT).
struct Signals : Marked {
    static inline Signals* one = nullptr;
    struct sigaction before {};
    ~Signals() override {
        if (one == this) sigaction(SIGSEGV, &before, nullptr);
        mprotect(memory_, size_, PROT_READ | PROT_WRITE);
    }
    bool begin(std::byte* memory, size_t size) override {
        Comparison::begin(memory, size);
        dirty = std::vector<std::atomic<uint8_t>>(size / kPage);
        one = this;
        struct sigaction now {};
        now.sa_flags = SA_SIGINFO;
        now.sa_sigaction = [](int, siginfo_t* info, void*) {
            const size_t at = static_cast<size_t>(static_cast<std::byte*>(info->si_addr) - one->memory_);
            if (at >= one->size_) _exit(3);
            one->mark(at / kPage);
            mprotect(one->memory_ + at / kPage * kPage, kPage, PROT_READ | PROT_WRITE);
        };
        sigaction(SIGSEGV, &now, &before);
        protect(0, size);
        return true;
    }
    void protect(size_t from, size_t size) override { mprotect(memory_ + from, size, PROT_READ); }
};

// userfaultfd with a thread that resolves each first write. Unprivileged, system calls that write fail.
struct Answered : Marked {
    int uffd = -1, end = -1;
    pthread_t thread{};
    ~Answered() override {
        if (end >= 0) close(end), pthread_join(thread, nullptr);
        if (uffd >= 0) close(uffd);
    }
    static void* answer(void* self);
    bool begin(std::byte* memory, size_t size) override {
        Comparison::begin(memory, size);
        dirty = std::vector<std::atomic<uint8_t>>(size / kPage);
        uffd = static_cast<int>(syscall(SYS_userfaultfd, O_CLOEXEC | O_NONBLOCK | 1));
        uint64_t api[3] = {0xAA, 0, 0};
        uint64_t range[4] = {reinterpret_cast<uint64_t>(memory), size, 2, 0};
        if (uffd < 0 || ioctl(uffd, _IOC(3, 0xAA, 0x3F, 24), api) || ioctl(uffd, _IOC(3, 0xAA, 0, 32), range))
            return false;
        int ends[2];
        if (pipe2(ends, O_CLOEXEC)) return false;
        end = ends[1];
        readEnd = ends[0];
        protect(0, size);
        return pthread_create(&thread, nullptr, answer, this) == 0;
    }
    int readEnd = -1;
    void write(uint64_t from, uint64_t size, uint64_t mode) {
        uint64_t request[3] = {from, size, mode};
        ioctl(uffd, _IOC(3, 0xAA, 6, 24), request);
    }
    void protect(size_t from, size_t size) override { write(reinterpret_cast<uint64_t>(memory_) + from, size, 1); }
};
void* Answered::answer(void* self) {
    auto& filter = *static_cast<Answered*>(self);
    for (;;) {
        pollfd waits[2] = {{filter.uffd, POLLIN, 0}, {filter.readEnd, POLLIN, 0}};
        poll(waits, 2, -1);
        if (waits[1].revents) break;
        uint64_t message[4];
        if (read(filter.uffd, message, sizeof message) != sizeof message) continue;
        const uint64_t page = message[2] & ~(kPage - 1);
        filter.mark((page - reinterpret_cast<uint64_t>(filter.memory_)) / kPage);
        filter.write(page, kPage, 0);
    }
    close(filter.readEnd);
    return nullptr;
}

// Soft-dirty bits of /proc/self/pagemap; clear_refs clears them for the whole process.
struct SoftDirty : Comparison {
    int pagemap = open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC),
        clear = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    std::vector<uint64_t> entries;
    ~SoftDirty() override { close(pagemap), close(clear); }
    bool read() {
        return pread(pagemap, entries.data(), entries.size() * 8,
                     static_cast<off_t>(reinterpret_cast<uint64_t>(memory_) / kPage * 8)) > 0;
    }
    bool begin(std::byte* memory, size_t size) override {
        Comparison::begin(memory, size);
        entries.resize(size / kPage);
        if (::write(clear, "4", 1) != 1) return false;
        memory[0] = std::byte{1};
        return read() && entries[0] >> 55 & 1; // never set by a kernel without support
    }
    void beforeDraw() override {
        read();
        bool any = false;
        for (const uint64_t entry : entries) any = any || entry >> 55 & 1;
        if (!any) return;
        if (::write(clear, "4", 1) != 1) std::abort();
        for (size_t page = 0; page < entries.size(); ++page) {
            if (entries[page] >> 55 & 1) compare(page * kPage, (page + 1) * kPage);
        }
    }
};

struct Job {
    size_t size;
    int draws;
    double share; // fraction of the memory written per frame
};

// Writes a draw's share of the memory after the previous draw's share, as in a ring buffer.
struct Writer {
    std::byte* memory;
    Job job;
    size_t at = 0;
    uint8_t value = 1;
    void draw() {
        const size_t bytes =
            std::max<size_t>(64, static_cast<size_t>(static_cast<double>(job.size) * job.share / job.draws) / 64 * 64);
        for (size_t left = bytes; left > 0;) {
            const size_t now = std::min(left, job.size - at);
            std::memset(memory + at, ++value, now);
            at = (at + now) % job.size;
            left -= now;
        }
    }
};

// Returns nanoseconds per draw, over at most a frame's draws within the time limit.
double perDraw(const Job& job, std::byte* memory, ChosenFilter* filter, int64_t limitNs) {
    Writer writer{memory, job};
    const int64_t start = mural::monotonicNowNs();
    int draws = 0;
    while (draws < std::max(job.draws, 400) && (draws < 3 || mural::monotonicNowNs() - start < limitNs)) {
        writer.draw();
        if (filter) filter->beforeDraw();
        ++draws;
    }
    return static_cast<double>(mural::monotonicNowNs() - start) / draws;
}

template <class Made> void measure(const Job& job, std::byte* memory, int64_t limitNs) {
    double best = -1;
    for (int i = 0; i < 3; ++i) {
        const double bare = perDraw(job, memory, nullptr, limitNs);
        Made filter;
        if (!filter.begin(memory, job.size)) break;
        const double now = std::max(perDraw(job, memory, &filter, limitNs) - bare, 1.0);
        best = best < 0 ? now : std::min(best, now);
    }
    if (best < 0)
        std::printf(" %11s", "-");
    else
        std::printf(" %11.2f", best / 1000);
    std::fflush(stdout);
}

void row(const Job& job, int64_t limitNs) {
    void* mapped = mmap(nullptr, job.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) std::exit(1);
    auto* memory = static_cast<std::byte*>(mapped);
    std::memset(memory, 1, job.size);
    std::printf("%8zu %6d %6.1f", job.size / 1024, job.draws, job.share * 100);
    measure<Comparison>(job, memory, limitNs);
    measure<Hashes>(job, memory, limitNs);
    measure<Watch>(job, memory, limitNs);
    measure<Chosen>(job, memory, limitNs);
    measure<Answered>(job, memory, limitNs);
    measure<Signals>(job, memory, limitNs);
    measure<SoftDirty>(job, memory, limitNs);
    std::printf("\n");
    munmap(mapped, job.size);
}

} // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
    const int64_t limitNs = quick ? 2'000'000 : 60'000'000;
    sink.resize(1 << 20);
    std::printf("microseconds per draw beyond the program's writes (least of 3)\n");
    std::printf("%8s %6s %6s %11s %11s %11s %11s %11s %11s %11s\n", "KiB", "draws", "% new", "compare", "hash", "watch",
                "chosen", "uffd thread", "SIGSEGV", "soft-dirty");
    const std::vector<size_t> sizes =
        quick ? std::vector<size_t>{64, 4096} : std::vector<size_t>{4, 16, 64, 4096, 65536, 262144};
    for (const size_t kib : sizes) {
        for (const int draws : {1, 100, 10000}) {
            for (const double share : {0.001, 0.1, 1.0}) row({kib * 1024, draws, share}, limitNs);
        }
    }
    return 0;
}
