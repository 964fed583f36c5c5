#include "nodes/head/capture/capture_memory.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/file.h>
#include <sys/mman.h>

#include "common/ipc/futex.hpp"

namespace mural {
namespace {

using capture::CaptureHeader;
using capture::kChunkBytes;
using capture::Publication;

constexpr uint64_t kPageBytes = 4096;

uint64_t roundUp(uint64_t value) { return (value + kPageBytes - 1) / kPageBytes * kPageBytes; }

Error systemError(const char* what) {
    return Error{std::string("cannot allocate shared memory for a program: ") + what + ": " + std::strerror(errno) +
                 "; check the limits of memory, open files and file sizes (ulimit -a)"};
}

// Opens a separate file description for the program, with a lock. The lock shows whether any process still has it.
Result<FileDescriptor> openForProgram(int fd) {
    const std::string path = "/proc/self/fd/" + std::to_string(fd);
    FileDescriptor opened;
    do {
        opened = FileDescriptor(open(path.c_str(), O_RDWR | O_CLOEXEC));
    } while (!opened.valid() && errno == EINTR);
    if (!opened.valid()) return systemError(path.c_str());
    if (flock(opened.get(), LOCK_SH | LOCK_NB) != 0) return systemError("flock");
    return opened;
}

void writeLayout(CaptureHeader& h, uint32_t chunkCount, uint32_t replyBytes) {
    h.magic = capture::kMagic;
    h.version = capture::kVersion;
    h.chunkCount = chunkCount;
    h.replyCapacity = replyBytes;
    h.publicationsAt = roundUp(sizeof(CaptureHeader));
    h.freedAt = roundUp(h.publicationsAt + uint64_t{chunkCount} * sizeof(Publication));
    h.repliesAt = roundUp(h.freedAt + uint64_t{chunkCount} * sizeof(uint32_t));
    h.driverEventsAt = roundUp(h.repliesAt + replyBytes);
    h.chunksAt = roundUp(h.driverEventsAt + capture::kDriverEventSlots * sizeof(capture::DriverEventSlot));
    h.totalBytes = h.chunksAt + uint64_t{chunkCount} * kChunkBytes;
}

// Returns only plain characters, because the program may have written anything there.
std::string commandName(const capture::CommandCount& entry) {
    std::string name;
    for (const char c : entry.command) {
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        if (!plain) break;
        name += c;
    }
    return name.empty() ? "unknown" : name;
}

std::map<std::string, uint64_t> countsBy(const capture::CommandCount (&counts)[capture::kCommandCounts]) {
    std::map<std::string, uint64_t> by;
    for (const capture::CommandCount& entry : counts) {
        const uint64_t count = entry.count.load(std::memory_order_acquire);
        if (count > 0) by[commandName(entry)] += count;
    }
    return by;
}

void store(std::atomic<uint32_t>& word, uint32_t value) {
    word.store(value, std::memory_order_release);
    futexWakeAll(word);
}

} // namespace

Result<std::unique_ptr<CaptureMemory>> CaptureMemory::create(uint32_t chunkCount, uint32_t replyBytes) {
    FileDescriptor fd(memfd_create("mural-capture", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!fd.valid()) return systemError("memfd_create");
    CaptureHeader layout{};
    writeLayout(layout, chunkCount, replyBytes);
    if (ftruncate(fd.get(), static_cast<off_t>(layout.totalBytes)) != 0) return systemError("ftruncate");
    // Without the seals the program could shrink the memory and kill the head with SIGBUS.
    if (fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) return systemError("sealing");
    auto programFd = openForProgram(fd.get());
    if (!programFd) return programFd.error();
    void* base = mmap(nullptr, layout.totalBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
    if (base == MAP_FAILED) return systemError("mmap");
    auto* header = new (base) CaptureHeader{};
    writeLayout(*header, chunkCount, replyBytes);
    return std::unique_ptr<CaptureMemory>(
        new CaptureMemory(std::move(fd), std::move(*programFd), static_cast<std::byte*>(base), layout));
}

CaptureMemory::CaptureMemory(FileDescriptor fd, FileDescriptor programFd, std::byte* base, const CaptureHeader& layout)
    : fd_(std::move(fd)),
      programFd_(std::move(programFd)),
      base_(base),
      shared_(reinterpret_cast<CaptureHeader*>(base)),
      chunkCount_(layout.chunkCount),
      replyCapacity_(layout.replyCapacity),
      publicationsAt_(layout.publicationsAt),
      freedAt_(layout.freedAt),
      repliesAt_(layout.repliesAt),
      driverEventsAt_(layout.driverEventsAt),
      chunksAt_(layout.chunksAt),
      totalBytes_(layout.totalBytes) {
    auto* freed = reinterpret_cast<uint32_t*>(at(freedAt_));
    for (uint32_t i = 0; i < chunkCount_; ++i) freed[i] = i;
    freedTail_ = chunkCount_;
    shared_->freedTail.store(freedTail_, std::memory_order_release);
}

CaptureMemory::~CaptureMemory() { munmap(base_, totalBytes_); }

bool CaptureMemory::programGone() const { return flock(fd_.get(), LOCK_EX | LOCK_NB) == 0; }

CaptureMemory::Next CaptureMemory::next(Range& range) {
    const uint32_t tail = publishedTail();
    if (tail == publishedHead_) return Next::Empty;
    if (tail - publishedHead_ > chunkCount_) return Next::Bad;
    // Copied once, because the program could change it between check and use.
    Publication p;
    const uint32_t slot = publishedHead_ & (chunkCount_ - 1);
    std::memcpy(&p, at(publicationsAt_ + slot * sizeof(Publication)), sizeof(p));
    asm volatile("" ::: "memory"); // the copy is the only read
    const bool whole = p.beginBytes % 4 == 0 && p.endBytes % 4 == 0;
    if (p.chunk >= chunkCount_ || p.beginBytes > p.endBytes || p.endBytes > kChunkBytes || !whole) return Next::Bad;
    range.bytes = {at(chunksAt_ + uint64_t{p.chunk} * kChunkBytes + p.beginBytes), p.endBytes - p.beginBytes};
    range.chunk = p.chunk;
    range.stream = p.stream;
    range.lastOfChunk = p.lastOfChunk != 0;
    return Next::Ready;
}

bool CaptureMemory::take(const Range& range) {
    if (range.lastOfChunk) {
        const uint32_t head = shared_->freedHead.load(std::memory_order_acquire);
        if (freedTail_ - head >= chunkCount_) return false; // more chunks freed than taken
        const uint32_t slot = freedTail_ & (chunkCount_ - 1);
        std::memcpy(at(freedAt_ + slot * sizeof(uint32_t)), &range.chunk, sizeof(uint32_t));
        store(shared_->freedTail, ++freedTail_);
    }
    const bool wasFull = publishedTail() - publishedHead_ >= chunkCount_;
    shared_->publishedHead.store(++publishedHead_, std::memory_order_release);
    if (wasFull) futexWakeAll(shared_->publishedHead); // the program waits for space only in this case
    return true;
}

uint32_t CaptureMemory::publishedTail() const { return shared_->publishedTail.load(std::memory_order_acquire); }

void CaptureMemory::waitPublished(capture::Reader how, int64_t timeoutNs) {
    shared_->reader.store(static_cast<uint32_t>(how), std::memory_order_relaxed);
    // either the program sees this value, or the check below sees its publication
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (publishedTail() == publishedHead_) futexWait(shared_->publishedTail, publishedHead_, timeoutNs);
    shared_->reader.store(static_cast<uint32_t>(capture::Reader::Reads), std::memory_order_relaxed);
}

void CaptureMemory::wakePump() const { futexWakeAll(shared_->publishedTail); }

size_t CaptureMemory::writeReply(std::span<const std::byte> bytes) {
    const uint32_t head = shared_->replyHead.load(std::memory_order_acquire);
    const uint32_t used = replyTail_ - head;
    if (used >= replyCapacity_) return 0; // full, or an invalid head: never write past the end
    const size_t count = std::min<size_t>(bytes.size(), replyCapacity_ - used);
    const uint32_t slot = replyTail_ & (replyCapacity_ - 1);
    const size_t first = std::min<size_t>(count, replyCapacity_ - slot);
    std::memcpy(at(repliesAt_ + slot), bytes.data(), first);
    std::memcpy(at(repliesAt_), bytes.data() + first, count - first);
    replyTail_ += static_cast<uint32_t>(count);
    store(shared_->replyTail, replyTail_);
    return count;
}

void CaptureMemory::waitReplyRoom(int64_t timeoutNs) const {
    const uint32_t head = shared_->replyHead.load(std::memory_order_acquire);
    if (replyTail_ - head < replyCapacity_) return;
    futexWait(shared_->replyHead, head, timeoutNs);
}

void CaptureMemory::answerAhead(uint32_t request, uint64_t value) {
    capture::PrefetchedReply& answer = shared_->prefetched[request % capture::kPrefetchedReplies];
    answer.request.store(0, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    answer.value.store(value, std::memory_order_relaxed);
    answer.request.store(request, std::memory_order_release);
    futexWakeAll(answer.request);
}

bool CaptureMemory::putDriverEvent(const wire::DriverEvent& event, const std::string& text) {
    static_assert(sizeof event == sizeof capture::DriverEventSlot::event);
    const std::lock_guard lock(driverEventMutex_);
    if (driverEventTail_ - shared_->driverEventHead.load(std::memory_order_acquire) >= capture::kDriverEventSlots)
        return false;
    auto* slot = reinterpret_cast<capture::DriverEventSlot*>(at(driverEventsAt_)) +
                 driverEventTail_ % capture::kDriverEventSlots;
    wire::DriverEvent put = event;
    put.textBytes = static_cast<uint32_t>(std::min<size_t>(text.size(), capture::kDriverEventTextBytes));
    std::memcpy(slot->event, &put, sizeof put);
    std::memcpy(slot->text, text.data(), put.textBytes);
    shared_->driverEventTail.store(++driverEventTail_, std::memory_order_release);
    return true;
}

std::optional<PixelFormat> CaptureMemory::ownWindow(uint32_t window, uint32_t frame) const {
    for (const capture::OwnWindow& own : shared_->ownWindows) {
        if (own.window.load(std::memory_order_acquire) != window) continue;
        if (static_cast<int32_t>(frame - own.frame.load()) > 0) return std::nullopt; // swap after the grab
        PixelFormat format;
        format.depth = static_cast<int>(own.depth.load() & 0xff);
        format.bitsPerPixel = static_cast<int>(own.bitsPerPixel.load() & 0xff);
        format.rowPadBits = static_cast<int>(own.rowPadBits.load() & 0xff);
        format.redMask = own.redMask.load();
        format.greenMask = own.greenMask.load();
        format.blueMask = own.blueMask.load();
        return format;
    }
    return std::nullopt;
}

// A thread that read the previous value and is not asleep yet misses this wake-up. It reads the value again after its
// slice of 50 ms.
void CaptureMemory::setLatency(uint32_t frames) {
    shared_->latency.store(frames, std::memory_order_release);
    futexWakeAll(shared_->framesDone);
}

void CaptureMemory::setFramesDone(uint32_t frames) {
    shared_->framesDone.store(frames, std::memory_order_release);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    uint64_t wanted = shared_->framesWanted.load(std::memory_order_relaxed);
    if (!(wanted & capture::kFramesWanted) || static_cast<int32_t>(frames - static_cast<uint32_t>(wanted)) < 0) return;
    shared_->framesWanted.compare_exchange_strong(wanted, 0); // fails if another thread has just stored its own request
    futexWakeAll(shared_->framesDone);
}
void CaptureMemory::setFramesShown(uint32_t frames) { store(shared_->framesShown, frames); }

// Both sides first write their own word and then read the other's, so at least one of them sees the other.
bool CaptureMemory::beginOverlay() {
    shared_->overlayShown.store(1, std::memory_order_seq_cst);
    return shared_->readsWindows.load(std::memory_order_seq_cst) == 0;
}

void CaptureMemory::endOverlay() { store(shared_->overlayShown, 0); }

void CaptureMemory::setHeadGone() {
    store(shared_->headGone, 1);
    for (const auto* word : {&shared_->publishedTail, &shared_->publishedHead, &shared_->freedTail, &shared_->replyTail,
                             &shared_->replyHead, &shared_->framesDone, &shared_->framesShown, &shared_->overlayShown})
        futexWakeAll(*word);
}

std::vector<std::string> CaptureMemory::displayNames() const {
    std::vector<std::string> names(std::min(shared_->displayCount.load(std::memory_order_acquire), capture::kDisplays));
    for (size_t i = 0; i < names.size(); ++i) {
        char copy[capture::kDisplayNameBytes];
        std::memcpy(copy, shared_->displays[i], sizeof copy); // copied first, because the program may change it
        names[i].assign(copy, strnlen(copy, sizeof copy));
    }
    return names;
}

std::array<uint64_t, capture::kWaits> CaptureMemory::waitNs() const {
    std::array<uint64_t, capture::kWaits> waits{};
    for (uint32_t i = 0; i < capture::kWaits; ++i) waits[i] = shared_->waitNs[i].load(std::memory_order_relaxed);
    return waits;
}

CaptureCounts CaptureMemory::counts() const {
    CaptureCounts c;
    c.verifiedFrames = shared_->verifiedFrames.load();
    c.verifiedPixels = shared_->verifiedPixels.load();
    c.differingPixels = shared_->differingPixels.load();
    c.squaredDifference = shared_->squaredDifference.load();
    c.largestDifference = shared_->largestDifference.load();
    for (uint32_t i = 0; i < capture::kUncomparedReasons; ++i)
        c.uncomparedFrames[i] = shared_->uncomparedFrames[i].load();
    c.callsUnsupported = shared_->callsUnsupported.load();
    c.roundTrips = shared_->roundTrips.load();
    for (uint32_t i = 0; i < capture::kWaits; ++i) c.waitNs[i] = shared_->waitNs[i].load();
    const uint32_t waiting = shared_->waitingFor.load();
    if (waiting < capture::kWaits) c.waitingFor = static_cast<capture::Wait>(waiting);
    c.tripsBy = countsBy(shared_->trips);
    c.unsupportedBy = countsBy(shared_->unsupported);
    c.frameCpuNs = shared_->frameCpuNs.load();
    c.frameCpuFrames = shared_->frameCpuFrames.load();
    return c;
}

} // namespace mural
