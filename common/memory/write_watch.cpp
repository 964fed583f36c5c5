#include "common/memory/write_watch.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace mural {

namespace {

// Kernel interfaces (linux/userfaultfd.h, linux/fs.h) that are newer than the headers at build time.
struct UffdApi {
    uint64_t api, features, ioctls;
};
struct UffdRegister {
    uint64_t start, length, mode, ioctls;
};
struct UffdRange {
    uint64_t start, length;
};
struct PageRegion {
    uint64_t start, end, categories;
};
struct PageScan {
    uint64_t sizeBytes, flags, start, end, walkEnd, regions, regionCount, maxPages;
    uint64_t categoryInverted, categoryMask, categoryAnyOf, returnMask;
};

constexpr uint64_t kUffdApi = 0xAA;
// the only kind that unprivileged processes may request; asynchronous faults need no other
constexpr int kUserModeOnly = 1;
constexpr uint64_t kFeatureUnpopulated = 1 << 13, kFeatureAsync = 1 << 15;
constexpr uint64_t kRegisterWriteProtect = 2;
constexpr unsigned long kIoctlApi = _IOC(_IOC_READ | _IOC_WRITE, 0xAA, 0x3F, sizeof(UffdApi));
constexpr unsigned long kIoctlRegister = _IOC(_IOC_READ | _IOC_WRITE, 0xAA, 0x00, sizeof(UffdRegister));
constexpr unsigned long kIoctlUnregister = _IOC(_IOC_READ, 0xAA, 0x01, sizeof(UffdRange));
constexpr unsigned long kIoctlScan = _IOC(_IOC_READ | _IOC_WRITE, 'f', 16, sizeof(PageScan));
constexpr uint64_t kScanLock = 1, kScanOnlyWatched = 2, kPageWritten = 1 << 1;
constexpr uint64_t kPageBytes = WriteWatch::kPageBytes;
constexpr int kRegions = 64;

uint64_t pageFloor(uint64_t at) { return at & ~(kPageBytes - 1); }
uint64_t pageCeil(uint64_t at) { return pageFloor(at + kPageBytes - 1); }

int openUninterrupted(const char* path) {
    int fd = -1;
    do {
        fd = open(path, O_RDONLY | O_CLOEXEC);
    } while (fd < 0 && errno == EINTR);
    return fd;
}

// A sandbox (seccomp) may kill a program for unknown system calls. Each thread has its own filters.
bool sandboxed() {
    const int file = openUninterrupted("/proc/thread-self/status");
    if (file < 0) return true;
    char text[4096];
    const ssize_t length = read(file, text, sizeof text - 1);
    close(file);
    if (length <= 0) return true;
    text[length] = 0;
    const char* mode = std::strstr(text, "\nSeccomp:\t");
    return !mode || mode[10] != '0';
}

// Descriptors of this process's own memory. A forked child has none: the inherited ones refer to the parent's memory.
// A program may close them and reuse their numbers.
struct Kernel {
    pid_t process = 0;
    int uffd = -1, pagemap = -1;
    dev_t device = 0;
    ino_t pagemapInode = 0;
    [[nodiscard]] bool usable() const { return uffd >= 0 && process == getpid() && isPagemap(); }
    [[nodiscard]] bool isPagemap() const {
        struct stat file {};
        return fstat(pagemap, &file) == 0 && file.st_dev == device && file.st_ino == pagemapInode;
    }
};
Kernel kernel;

void openKernel() {
    if (sandboxed() || sysconf(_SC_PAGESIZE) != static_cast<long>(kPageBytes)) return;
    const int uffd = static_cast<int>(syscall(SYS_userfaultfd, O_CLOEXEC | kUserModeOnly));
    if (uffd < 0) return;
    UffdApi api = {kUffdApi, kFeatureUnpopulated | kFeatureAsync, 0};
    const int pagemap = openUninterrupted("/proc/self/pagemap");
    struct stat file {};
    if (pagemap >= 0 && fstat(pagemap, &file) == 0 && ioctl(uffd, kIoctlApi, &api) == 0) {
        kernel = {getpid(), uffd, pagemap, file.st_dev, file.st_ino};
        return;
    }
    if (pagemap >= 0) close(pagemap);
    close(uffd);
}

bool openedKernel() {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, openKernel);
    return kernel.usable();
}

} // namespace

bool WriteWatch::begin(void* memory, size_t sizeBytes) {
    end();
    if (sizeBytes == 0 || !openedKernel()) return false;
    memory_ = reinterpret_cast<uint64_t>(memory);
    const uint64_t start = pageFloor(memory_);
    UffdRegister range = {start, pageCeil(memory_ + sizeBytes) - start, kRegisterWriteProtect, 0};
    if (ioctl(kernel.uffd, kIoctlRegister, &range) != 0) return false;
    sizeBytes_ = sizeBytes;
    if (lock(
            0, sizeBytes, [](void*, size_t, size_t) {}, nullptr))
        return true;
    end();
    return false;
}

void WriteWatch::end() {
    if (!active()) return;
    const uint64_t start = pageFloor(memory_);
    UffdRange range = {start, pageCeil(memory_ + sizeBytes_) - start};
    if (kernel.usable()) ioctl(kernel.uffd, kIoctlUnregister, &range);
    sizeBytes_ = 0;
}

bool WriteWatch::lock(size_t fromByte, size_t endByte, Visit visit, void* self) const {
    return scan(fromByte, endByte, kScanLock, visit, self);
}

bool WriteWatch::scan(size_t fromByte, size_t endByte, uint64_t flags, Visit visit, void* self) const {
    if (!kernel.usable()) return false;
    const uint64_t end = pageCeil(memory_ + endByte);
    PageRegion regions[kRegions];
    for (uint64_t start = pageFloor(memory_ + fromByte); start < end;) {
        PageScan request = {sizeof request,
                            flags | kScanOnlyWatched,
                            start,
                            end,
                            0,
                            reinterpret_cast<uint64_t>(regions),
                            kRegions,
                            0,
                            0,
                            kPageWritten,
                            0,
                            kPageWritten};
        const int count = ioctl(kernel.pagemap, kIoctlScan, &request);
        if (count < 0 || request.walkEnd <= start) return false;
        for (int i = 0; i < count; ++i) {
            const uint64_t from = regions[i].start > memory_ ? regions[i].start - memory_ : 0;
            const uint64_t to = regions[i].end - memory_ < sizeBytes_ ? regions[i].end - memory_ : sizeBytes_;
            visit(self, from, to);
        }
        start = request.walkEnd;
    }
    return true;
}

} // namespace mural
