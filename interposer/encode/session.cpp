#include "interposer/encode/session.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "common/base/running_time.hpp"
#include "common/ipc/window_mark.hpp"
#include "interposer/process/forked_child.hpp"
#include "interposer/process/handshake.hpp"
#include "interposer/process/head_socket.hpp"
#include "interposer/process/launch_settings.hpp"
#include "interposer/context/lock.hpp"
#include "interposer/diagnostics/command_counts.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/readback/deferred_replies.hpp"
#include "interposer/process/process.hpp"
#include "interposer/x11/own_puts.hpp"

namespace mural {

namespace {

constexpr int64_t kSliceNs = 50 * kNsPerMs; // interval at which a blocked thread checks whether the head lives
constexpr int64_t kStuckNs = 60 * kNsPerS;  // limit for a running head that makes no progress

Lock connectLock;
Lock ringLock;    // makes one producer of publications and one consumer of freed chunks
Lock requestLock; // allows one request at a time

// Marks a wait of a thread during its lifetime. `mural stat` shows the reason; the report shows the duration.
class Waiting {
public:
    Waiting(capture::CaptureHeader& header, capture::Wait what)
        : header_(header), what_(static_cast<uint32_t>(what)), sinceNs_(monotonicNowNs()), running_(sinceNs_, beat()) {
        header_.waitingFor.store(what_, std::memory_order_relaxed);
    }
    ~Waiting() {
        header_.waitNs[what_].fetch_add(static_cast<uint64_t>(monotonicNowNs() - sinceNs_), std::memory_order_relaxed);
        header_.waitingFor.store(static_cast<uint32_t>(capture::Wait::Nothing), std::memory_order_relaxed);
    }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    // Returns the time during which this process and the head both ran. Must be called once per slice.
    [[nodiscard]] int64_t forNs() { return running_.countNs(monotonicNowNs(), beat()); }

private:
    [[nodiscard]] uint32_t beat() const { return header_.headBeat.load(std::memory_order_relaxed); }

    capture::CaptureHeader& header_;
    uint32_t what_;
    int64_t sinceNs_;
    RunningTime running_;
};

// Requires the request lock.
void countTrip(capture::CaptureHeader& header, const char* by) {
    constexpr char kPrefix[] = "mural_"; // prefix of wrapper names
    countCommand(header.trips, std::strncmp(by, kPrefix, sizeof kPrefix - 1) == 0 ? by + sizeof kPrefix - 1 : by);
    header.roundTrips.fetch_add(1, std::memory_order_relaxed);
}

} // namespace

Session* Session::current() { return __atomic_load_n(&process::page.session, __ATOMIC_ACQUIRE); }

Session* Session::get() {
    if (Session* s = current()) return s;
    Guard guard(connectLock);
    if (process::page.connectTried) return process::page.session;
    process::page.connectTried = true;
    if (!launchSettings().session) return nullptr;
    void* const memory = std::calloc(1, sizeof(Session)); // never freed, because it outlives the program's destructors
    if (!memory) return nullptr;
    auto* const session = new (memory) Session;
    if (!session->connect()) {
        std::free(memory);
        return nullptr;
    }
    expectForks();
    __atomic_store_n(&process::page.session, session, __ATOMIC_RELEASE);
    return session;
}

uint32_t Session::displayNumber(const char* name) {
    static Lock lock;
    Guard guard(lock);
    const uint32_t count = header_->displayCount.load(std::memory_order_relaxed);
    for (uint32_t i = 0; i < count; ++i)
        if (std::strcmp(header_->displays[i], name) == 0) return i;
    if (count == capture::kDisplays || std::strlen(name) >= capture::kDisplayNameBytes) return capture::kNoDisplay;
    std::strcpy(header_->displays[count], name);
    header_->displayCount.store(count + 1, std::memory_order_release);
    return count;
}

bool Session::connect() {
    const int socket = openHeadSocket();
    if (socket < 0) return false; // the reason has been reported
    Handshake handshake;
    if (!shakeHands(socket, handshake)) return false;
    nameKey_ = window_mark::sessionKey(launchSettings().session);
    welcome_ = handshake.welcome;
    extensions_ = handshake.extensions;
    header_ = handshake.header;
    __atomic_store_n(&alive_, true, __ATOMIC_RELEASE);
    return true;
}

void Session::die(const char* why) {
    if (!__atomic_exchange_n(&alive_, false, __ATOMIC_ACQ_REL)) return;
    if (why) say("%s; the program continues alone", why);
}

// Returns whether the head lives. The kernel marks headLiveness if the head ends without setting headGone
// (nodes/head/capture/liveness_mark.hpp).
bool Session::headAlive() {
    if (!alive()) return false;
    const bool gone = header_->headGone.load(std::memory_order_acquire) ||
                      header_->headLiveness.load(std::memory_order_acquire) & FUTEX_OWNER_DIED;
    if (gone) die(nullptr); // the head or `mural run` has reported the reason
    return !gone;
}

void Session::publish(ThreadState& t, bool last, bool hurry) {
    if (!alive() || t.chunk == UINT32_MAX) return;
    bool published = false;
    {
        Guard guard(ringLock);
        published = publishLocked(t, last);
    }
    if (published || hurry) wakeReader(hurry);
}

// Call after a publication. Reads the reader's state after the publication is written. The reader reads publications
// after it writes its state, so no wake-up is lost.
void Session::wakeReader(bool fromNap) {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    const auto reader = static_cast<capture::Reader>(header_->reader.load(std::memory_order_relaxed));
    if (reader == capture::Reader::Sleeps || (fromNap && reader == capture::Reader::Naps))
        futexWakeAll(header_->publishedTail);
}

bool Session::publishLocked(ThreadState& t, bool last) {
    std::byte* const cursor = __atomic_load_n(&t.cursor, __ATOMIC_ACQUIRE);
    if (!cursor) return false; // zero in a forked child
    const auto end = static_cast<uint32_t>(cursor - capture::chunk(header_, t.chunk));
    if (end == t.publishedBytes && !last) return false;
    const uint32_t tail = header_->publishedTail.load(std::memory_order_relaxed);
    // A takeover publishes ranges of one chunk, so publications may outnumber chunks.
    const auto full = [&] {
        return tail - header_->publishedHead.load(std::memory_order_acquire) >= header_->chunkCount;
    };
    if (full()) {
        Waiting waiting(*header_, capture::Wait::Space);
        do {
            if (!headAlive()) return false;
            if (waiting.forNs() > kStuckNs) {
                die("the head read nothing for 60 s");
                return false;
            }
            timespec nap{0, 200'000};
            syscall(SYS_nanosleep, &nap, nullptr);
        } while (full());
    }
    capture::publications(header_)[tail % header_->chunkCount] = {t.chunk, t.publishedBytes, end, t.stream,
                                                                  static_cast<uint16_t>(last)};
    t.publishedBytes = end;
    ++t.publications;
    if (last) t.chunk = UINT32_MAX;
    header_->publishedTail.store(tail + 1, std::memory_order_release);
    return true;
}

bool Session::takeChunk(ThreadState& t) {
    std::optional<Waiting> waiting;
    while (alive()) {
        uint32_t seen = 0;
        {
            Guard guard(ringLock);
            const uint32_t head = header_->freedHead.load(std::memory_order_relaxed);
            seen = header_->freedTail.load(std::memory_order_acquire);
            if (head != seen) {
                const uint32_t index = capture::freed(header_)[head % header_->chunkCount];
                header_->freedHead.store(head + 1, std::memory_order_release);
                std::byte* start = capture::chunk(header_, index);
                t.chunk = index;
                t.publishedBytes = 0;
                t.chunkEnd = start + capture::kChunkBytes;
                ++t.chunksTaken;
                __atomic_store_n(&t.cursor, start, __ATOMIC_RELEASE);
                return true;
            }
        }
        if (!waiting) {
            waiting.emplace(*header_, capture::Wait::Space);
        } else {
            if (!headAlive()) return false;
            if (waiting->forNs() > kStuckNs) die("the head returned no memory for 60 s");
        }
        futexWait(header_->freedTail, seen, kSliceNs);
    }
    return false;
}

bool Session::mayGoAhead(uint32_t submitted, uint32_t done, int64_t nowNs) const {
    if (latency() == 0 || submitted - done >= capture::kAheadFrames) return false;
    const int64_t oldestNs = __atomic_load_n(&submittedNs_[(done + 1) % capture::kAheadFrames], __ATOMIC_RELAXED);
    return nowNs - oldestNs < capture::kAheadNs;
}

void Session::waitForCredit() {
    if (!alive()) return;
    const uint32_t submitted = framesSubmitted();
    const int64_t nowNs = monotonicNowNs();
    __atomic_store_n(&submittedNs_[submitted % capture::kAheadFrames], nowNs, __ATOMIC_RELAXED);
    header_->framesSubmitted.store(submitted, std::memory_order_relaxed);
    const auto tooMany = [&](uint32_t done) {
        return static_cast<int32_t>(submitted - done) > static_cast<int32_t>(latency());
    };
    uint32_t done = header_->framesDone.load(std::memory_order_acquire);
    if (!alive() || !tooMany(done) || mayGoAhead(submitted, done, nowNs)) return;
    Waiting waiting(*header_, capture::Wait::Frames);
    wakeReader(true);
    for (bool inVain = false; alive() && tooMany(done); inVain = true) {
        if (inVain) { // most frames skip these checks
            if (!headAlive()) return;
            if (waiting.forNs() > 10 * kStuckNs) die("no frame was completed for 10 minutes");
        }
        header_->framesWanted.store(capture::kFramesWanted | (submitted - latency()), std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_seq_cst);
        done = header_->framesDone.load(std::memory_order_acquire);
        if (tooMany(done)) futexWait(header_->framesDone, done, kSliceNs);
        done = header_->framesDone.load(std::memory_order_acquire);
    }
}

void Session::countFrameCpu(ThreadState& t) {
    const uint64_t tookNs = t.frameCpu.afterFrame();
    if (tookNs == 0 || !alive()) return;
    header_->frameCpuNs.fetch_add(tookNs, std::memory_order_relaxed);
    header_->frameCpuFrames.fetch_add(FrameCpu::kFrames, std::memory_order_relaxed);
}

void Session::waitShown() {
    if (!alive() || !welcome_.displayApp) return;
    const uint32_t submitted = framesSubmitted();
    const auto missing = [&](uint32_t frame) { return static_cast<int32_t>(submitted - frame) > 0; };
    if (!missing(header_->framesShown.load(std::memory_order_acquire))) return;
    Waiting waiting(*header_, capture::Wait::Window);
    while (alive()) {
        const uint32_t shown = header_->framesShown.load(std::memory_order_acquire);
        if (!missing(shown) || waiting.forNs() > kStuckNs) break;
        futexWait(header_->framesShown, shown, kSliceNs);
        if (!headAlive()) return;
    }
}

void Session::hideOverlay() {
    if (!alive() || !welcome_.displayApp) return;
    header_->readsWindows.store(1, std::memory_order_seq_cst);
    if (header_->overlayShown.load(std::memory_order_seq_cst) == 0) return;
    Waiting waiting(*header_, capture::Wait::Window);
    while (alive()) {
        const uint32_t shown = header_->overlayShown.load(std::memory_order_acquire);
        if (shown == 0 || waiting.forNs() > kStuckNs) break;
        futexWait(header_->overlayShown, shown, kSliceNs);
        if (!headAlive()) return;
    }
}

uint32_t Session::beginRequest(const char* by) {
    requestLock.lock();
    if (alive()) countTrip(*header_, by);
    lastRequest_ = (lastRequest_ + 1) & ~(capture::kPrefetched | capture::kDeferred);
    return lastRequest_;
}

void Session::endRequest() { requestLock.unlock(); }

bool Session::prefetchedReply(uint32_t request, uint64_t& value) {
    capture::PrefetchedReply& answer = header_->prefetched[request % capture::kPrefetchedReplies];
    std::optional<Waiting> waiting;
    bool known = false;
    while (alive()) {
        const uint32_t here = answer.request.load(std::memory_order_acquire);
        if (here == request) {
            value = answer.value.load(std::memory_order_relaxed);
            std::atomic_thread_fence(std::memory_order_acquire);
            known = answer.request.load(std::memory_order_relaxed) == request;
            break;
        }
        const bool later = here != 0 && static_cast<int32_t>((here - request) << 1) > 0;
        if (later || (waiting && waiting->forNs() > kStuckNs)) break; // the caller sends a new request then
        if (!waiting) waiting.emplace(*header_, capture::Wait::Reply);
        futexWait(answer.request, here, kSliceNs);
        if (!headAlive()) break;
    }
    return known;
}

bool Session::answerBytes(void* into, uint64_t sizeBytes) {
    auto* p = static_cast<std::byte*>(into);
    std::optional<Waiting> waiting;
    uint32_t head = header_->replyHead.load(std::memory_order_relaxed);
    while (sizeBytes > 0) {
        const uint32_t tail = header_->replyTail.load(std::memory_order_acquire);
        uint32_t have = tail - head;
        if (have == 0) {
            if (!waiting) {
                waiting.emplace(*header_, capture::Wait::Reply);
            } else {
                if (!headAlive()) return false;
                if (waiting->forNs() > kStuckNs) die("the nodes sent no reply for 60 s");
                if (!alive()) return false;
            }
            futexWait(header_->replyTail, tail, kSliceNs);
            continue;
        }
        const uint32_t at = head % header_->replyCapacity;
        if (have > header_->replyCapacity - at) have = header_->replyCapacity - at;
        if (have > sizeBytes) have = static_cast<uint32_t>(sizeBytes);
        if (p) {
            std::memcpy(p, capture::replies(header_) + at, have);
            p += have;
        }
        head += have;
        sizeBytes -= have;
        header_->replyHead.store(head, std::memory_order_release);
        futexWakeAll(header_->replyHead);
    }
    return true;
}

bool Session::takeDriverEvents(wire::DriverEvent& event, char* text) {
    if (header_->driverEventTail.load(std::memory_order_acquire) == driverEventsTaken_) return false;
    const capture::DriverEventSlot& slot =
        capture::driverEvents(header_)[driverEventsTaken_ % capture::kDriverEventSlots];
    std::memcpy(&event, slot.event, sizeof event);
    if (event.textBytes > capture::kDriverEventTextBytes) event.textBytes = capture::kDriverEventTextBytes;
    std::memcpy(text, slot.text, event.textBytes);
    text[event.textBytes] = 0;
    __atomic_store_n(&driverEventsTaken_, driverEventsTaken_ + 1, __ATOMIC_RELAXED);
    header_->driverEventHead.store(driverEventsTaken_, std::memory_order_release);
    return true;
}

bool Session::answerHeader(uint32_t request, wire::ReplyHeader& header) {
    while (alive()) {
        if (!answerBytes(&header, sizeof header)) return false;
        if (header.kind != capture::kPictureReply && header.requestId == request) return true;
        if (!takeDeferred(header)) return false;
    }
    return false;
}

bool Session::takePicture(const wire::ReplyHeader& header) {
    void* const pixels = header.failed ? nullptr : std::malloc(header.sizeBytes);
    const bool read = answerBytes(pixels, header.sizeBytes);
    if (read && pixels) putOwnPicture(header, static_cast<const std::byte*>(pixels));
    std::free(pixels);
    if (read) picturesTaken_ = header.requestId;
    return read;
}

void Session::takePictures(uint32_t frame) {
    if (!alive()) return;
    Guard guard(requestLock);
    wakeReader(true);
    Waiting waiting(*header_, capture::Wait::Window);
    const auto has = [&](uint32_t frames) { return static_cast<int32_t>(frame - frames) <= 0; };
    while (alive() && !has(picturesTaken_)) {
        // A frame without a picture counts as shown without a reply. For all others the reply arrives before the frame
        // counts as shown.
        const bool shown = has(header_->framesShown.load(std::memory_order_acquire));
        const uint32_t tail = header_->replyTail.load(std::memory_order_acquire);
        if (replyWaits()) {
            wire::ReplyHeader header{};
            if (!answerBytes(&header, sizeof header) || !takeDeferred(header)) return;
            continue;
        }
        if (shown || waiting.forNs() > kStuckNs) return;
        futexWait(header_->replyTail, tail, kSliceNs);
        if (!headAlive()) return;
    }
}

// Takes a reply that no thread waits for: a deferred one, a late one for an abandoned request, or a picture.
bool Session::takeDeferred(const wire::ReplyHeader& header) {
    if (header.kind == capture::kPictureReply) return takePicture(header);
    void* const into = deferred::placeOf(header.requestId, header.sizeBytes, header.failed != 0);
    const bool read = answerBytes(into, header.sizeBytes);
    deferred::arrived(header.requestId, read && into);
    return read;
}

bool Session::replyWaits() const {
    return header_->replyTail.load(std::memory_order_acquire) - header_->replyHead.load(std::memory_order_relaxed) >=
           sizeof(wire::ReplyHeader);
}

bool Session::waitDeferred(uint32_t request, const char* by) {
    if (!deferred::isAwaited(request)) return true;
    if (!alive()) return false;
    Guard guard(requestLock);
    wakeReader(true);
    bool counted = false;
    while (deferred::isAwaited(request)) {
        if (!alive()) return false;
        if (!counted && !replyWaits()) {
            countTrip(*header_, by);
            counted = true;
        }
        wire::ReplyHeader header{};
        if (!answerBytes(&header, sizeof header) || !takeDeferred(header)) return false;
    }
    return true;
}

void Session::takeArrived() {
    if (!alive() || !requestLock.tryLock()) return; // the holder of the lock reads them
    wire::ReplyHeader header{};
    while (alive() && replyWaits() && answerBytes(&header, sizeof header) && takeDeferred(header)) {}
    requestLock.unlock();
}

} // namespace mural
