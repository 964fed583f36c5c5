#include "interposer/session.hpp"

#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/clock.hpp"
#include "common/window_mark.hpp"
#include "interposer/lock.hpp"
#include "interposer/log.hpp"
#include "interposer/owed_answers.hpp"
#include "streamcodec/registry_digest.hpp"

namespace mural {

namespace {

constexpr int64_t kSliceNs = 50 * kNsPerMs;   // how often a blocked thread looks whether the head lives
constexpr int64_t kStuckNs = 60 * kNsPerS;    // a living head that gives nothing for so long is given up
constexpr int64_t kShowNs = 5 * kNsPerS;      // for a finished picture to get into its window: the head's own patience

Session* theSession = nullptr;
bool tried = false;
Lock connectLock;
Lock ringLock;    // publications and freed chunks have one producer, one consumer
Lock requestLock; // one question at a time

bool sendAll(int fd, const void* data, size_t bytes) {
    const auto* p = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t n = send(fd, p, bytes, MSG_NOSIGNAL);
        if (n <= 0) return false;
        p += n;
        bytes -= static_cast<size_t>(n);
    }
    return true;
}

bool receiveAll(int fd, void* into, size_t bytes) {
    auto* p = static_cast<char*>(into);
    while (bytes > 0) {
        const ssize_t n = recv(fd, p, bytes, 0);
        if (n <= 0) return false;
        p += n;
        bytes -= static_cast<size_t>(n);
    }
    return true;
}

// The welcome and the descriptor of the mapping that comes with its first byte.
bool receiveWelcome(int fd, capture::Welcome& welcome, int& memory) {
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
    iovec part{&welcome, sizeof welcome};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t n = recvmsg(fd, &message, MSG_CMSG_CLOEXEC);
    if (n <= 0) return false;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_RIGHTS) std::memcpy(&memory, CMSG_DATA(c), sizeof(int));
    }
    return receiveAll(fd, reinterpret_cast<char*>(&welcome) + n, sizeof welcome - static_cast<size_t>(n));
}

int connectAbstract(const char* name) {
    const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return -1;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const size_t length = std::strlen(name);
    if (length + 1 > sizeof address.sun_path) {
        close(fd);
        return -1;
    }
    std::memcpy(address.sun_path + 1, name, length);
    const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
    if (::connect(fd, reinterpret_cast<sockaddr*>(&address), bytes) != 0) {
        close(fd);
        return -1;
    }
    const timeval patience{30, 0};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    return fd;
}

// While it exists a thread waits; the header says so to `mural stat`, and for how long to the report.
class Waiting {
public:
    Waiting(capture::CaptureHeader& header, capture::Wait what) : header_(header), what_(static_cast<uint32_t>(what)), sinceNs_(monotonicNowNs()) {
        header_.waitingFor.store(what_, std::memory_order_relaxed);
    }
    ~Waiting() {
        header_.waitNs[what_].fetch_add(static_cast<uint64_t>(forNs()), std::memory_order_relaxed);
        header_.waitingFor.store(static_cast<uint32_t>(capture::Wait::Nothing), std::memory_order_relaxed);
    }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    [[nodiscard]] int64_t forNs() const { return monotonicNowNs() - sinceNs_; }

private:
    capture::CaptureHeader& header_;
    uint32_t what_;
    int64_t sinceNs_;
};

// Under the lock of questions.
void countTrip(capture::CaptureHeader& header, const char* by) {
    constexpr char kPrefix[] = "mural_"; // of wrappers
    const char* command = std::strncmp(by, kPrefix, sizeof kPrefix - 1) == 0 ? by + sizeof kPrefix - 1 : by;
    uint32_t i = 0;
    for (; i + 1 < capture::kTripCounts && header.trips[i].command[0]; ++i)
        if (std::strncmp(header.trips[i].command, command, sizeof header.trips[i].command - 1) == 0) break;
    capture::TripCount& trips = header.trips[i];
    if (i + 1 == capture::kTripCounts) command = "others";
    if (!trips.command[0]) std::strncpy(trips.command, command, sizeof trips.command - 1);
    trips.count.fetch_add(1, std::memory_order_release);
    header.roundTrips.fetch_add(1, std::memory_order_relaxed);
}

// The ring belongs to the parent; a child that goes on without exec draws alone.
void forkedChild() {
    if (Session* s = theSession) s->die(nullptr);
    tThread->cursor = tThread->limit = tThread->chunkEnd = nullptr;
    tThread->drawLocally = true;
}

} // namespace

Session* Session::current() { return __atomic_load_n(&theSession, __ATOMIC_ACQUIRE); }

Session* Session::get() {
    if (Session* s = current()) return s;
    Guard guard(connectLock);
    if (tried) return theSession;
    tried = true;
    const char* name = getenv("MURAL_SESSION");
    if (!name || !*name || getenv("MURAL_DISABLE")) return nullptr;
    static Session session; // trivially destructible: outlives the program's destructors
    if (!session.connect(name)) return nullptr;
    pthread_atfork(nullptr, nullptr, forkedChild);
    __atomic_store_n(&theSession, &session, __ATOMIC_RELEASE);
    return theSession;
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

bool Session::connect(const char* name) {
    nameKey_ = window_mark::sessionKey(name);
    socket_ = connectAbstract(name);
    if (socket_ < 0) {
        say("no head answers at session %s: this program draws on its own", name);
        return false;
    }
    const capture::Hello hello{capture::kMagic, capture::kVersion, registryDigest(), getpid(), 0};
    int memory = -1;
    const bool received = sendAll(socket_, &hello, sizeof hello) && receiveWelcome(socket_, welcome_, memory);
    if (!received || welcome_.magic != capture::kMagic || welcome_.version != capture::kVersion) {
        say("the head does not speak this version: run the interposer and mural of one build; this program draws on its own");
        close(socket_);
        return false;
    }
    auto* text = static_cast<char*>(std::malloc(welcome_.extensionBytes + 3));
    if (!text) return false;
    text[0] = ' ';
    if (!receiveAll(socket_, text + 1, welcome_.extensionBytes)) welcome_.extensionBytes = 0;
    text[welcome_.extensionBytes + 1] = ' ';
    text[welcome_.extensionBytes + 2] = 0;
    if (welcome_.refused || memory < 0) {
        say("not captured: %s", text + 1);
        close(socket_);
        return false;
    }
    extensions_ = text;
    const off_t size = lseek(memory, 0, SEEK_END);
    void* mapping = mmap(nullptr, static_cast<size_t>(size), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
    close(memory);
    if (mapping == MAP_FAILED) {
        say("can't map %ld bytes shared with the head: this program draws on its own", static_cast<long>(size));
        close(socket_);
        return false;
    }
    madvise(mapping, static_cast<size_t>(size), MADV_DONTFORK);
    header_ = static_cast<capture::CaptureHeader*>(mapping);
    __atomic_store_n(&alive_, true, __ATOMIC_RELEASE);
    return true;
}

void Session::die(const char* why) {
    if (!__atomic_exchange_n(&alive_, false, __ATOMIC_ACQ_REL)) return;
    if (why) say("%s; the program goes on alone", why);
}

bool Session::headAlive() {
    if (!alive()) return false;
    if (header_->headGone.load(std::memory_order_acquire)) {
        die(nullptr); // the head has told the user why
        return false;
    }
    pollfd p{socket_, POLLIN, 0};
    if (poll(&p, 1, 0) > 0) {
        char byte;
        const bool open = !(p.revents & (POLLHUP | POLLERR)) && recv(socket_, &byte, 1, MSG_DONTWAIT | MSG_PEEK) != 0;
        if (!open) {
            die(nullptr); // `mural run`, which has started it, says so
            return false;
        }
    }
    return true;
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

// After a publication: what the reader does is read behind it, as the reader reads the publications behind that.
void Session::wakeReader(bool fromNap) {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    const auto reader = static_cast<capture::Reader>(header_->reader.load(std::memory_order_relaxed));
    if (reader == capture::Reader::Sleeps || (fromNap && reader == capture::Reader::Naps)) futexWakeAll(header_->publishedTail);
}

bool Session::publishLocked(ThreadState& t, bool last) {
    std::byte* start = capture::chunk(header_, t.chunk);
    const auto end = static_cast<uint32_t>(__atomic_load_n(&t.cursor, __ATOMIC_ACQUIRE) - start);
    if (end == t.publishedBytes && !last) return false;
    const uint32_t tail = header_->publishedTail.load(std::memory_order_relaxed);
    // A takeover publishes ranges of one chunk, so publications may outnumber chunks.
    const auto full = [&] { return tail - header_->publishedHead.load(std::memory_order_acquire) >= header_->chunkCount; };
    if (full()) {
        const Waiting waiting(*header_, capture::Wait::Room);
        do {
            if (!headAlive()) return false;
            if (waiting.forNs() > kStuckNs) {
                die("the head takes nothing for 60 s");
                return false;
            }
            timespec nap{0, 200'000};
            syscall(SYS_nanosleep, &nap, nullptr);
        } while (full());
    }
    capture::publications(header_)[tail % header_->chunkCount] =
        {t.chunk, t.publishedBytes, end, t.stream, static_cast<uint16_t>(last)};
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
                __atomic_store_n(&t.cursor, start, __ATOMIC_RELEASE);
                return true;
            }
        }
        if (!waiting) {
            waiting.emplace(*header_, capture::Wait::Room);
        } else {
            if (!headAlive()) return false;
            if (waiting->forNs() > kStuckNs) die("the head frees no memory for 60 s");
        }
        futexWait(header_->freedTail, seen, kSliceNs);
    }
    return false;
}

bool Session::mayGoAhead(uint32_t submitted, uint32_t done, int64_t nowNs) const {
    if (welcome_.latency == 0 || submitted - done >= capture::kAheadFrames) return false;
    const int64_t oldestNs = __atomic_load_n(&submittedNs_[(done + 1) % capture::kAheadFrames], __ATOMIC_RELAXED);
    return nowNs - oldestNs < capture::kAheadNs;
}

void Session::waitForCredit() {
    const uint32_t submitted = framesSubmitted();
    const int64_t nowNs = monotonicNowNs();
    __atomic_store_n(&submittedNs_[submitted % capture::kAheadFrames], nowNs, __ATOMIC_RELAXED);
    header_->framesSubmitted.store(submitted, std::memory_order_relaxed);
    const auto tooMany = [&](uint32_t done) { return static_cast<int32_t>(submitted - done) > static_cast<int32_t>(welcome_.latency); };
    uint32_t done = header_->framesDone.load(std::memory_order_acquire);
    if (!alive() || !tooMany(done) || mayGoAhead(submitted, done, nowNs)) return;
    const Waiting waiting(*header_, capture::Wait::Frames);
    wakeReader(true);
    for (bool inVain = false; alive() && tooMany(done); inVain = true) {
        if (inVain) { // nothing of this is looked at in most frames
            if (!headAlive()) return;
            if (waiting.forNs() > 10 * kStuckNs) die("no frame came back for 10 minutes");
        }
        header_->framesWanted.store(capture::kFramesWanted | (submitted - welcome_.latency), std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_seq_cst);
        done = header_->framesDone.load(std::memory_order_acquire);
        if (tooMany(done)) futexWait(header_->framesDone, done, kSliceNs);
        done = header_->framesDone.load(std::memory_order_acquire);
    }
}

void Session::countFrameCpu(ThreadState& t) {
    const uint64_t tookNs = t.frameCpu.afterFrame();
    if (tookNs == 0) return;
    header_->frameCpuNs.fetch_add(tookNs, std::memory_order_relaxed);
    header_->frameCpuFrames.fetch_add(FrameCpu::kFrames, std::memory_order_relaxed);
}

void Session::waitShown() {
    if (!alive() || !welcome_.displayApp) return;
    const uint32_t submitted = framesSubmitted();
    const auto missing = [&](uint32_t frame) { return static_cast<int32_t>(submitted - frame) > 0; };
    if (!missing(header_->framesShown.load(std::memory_order_acquire))) return;
    const Waiting waiting(*header_, capture::Wait::Window);
    int64_t progressNs = 0;
    uint32_t shownBefore = header_->framesShown.load(std::memory_order_acquire);
    while (alive()) {
        const uint32_t shown = header_->framesShown.load(std::memory_order_acquire);
        if (!missing(shown)) break;
        const int64_t nowNs = waiting.forNs();
        // The nodes may need long for a frame; what they have finished needs only the X server.
        const bool drawing = missing(header_->framesDone.load(std::memory_order_acquire));
        if (shown != shownBefore || drawing) progressNs = nowNs;
        shownBefore = shown;
        if (nowNs - progressNs > kShowNs || nowNs > kStuckNs) break;
        futexWait(header_->framesShown, shown, kSliceNs);
        if (!headAlive()) return;
    }
}

uint32_t Session::beginRequest(const char* by) {
    requestLock.lock();
    if (alive()) countTrip(*header_, by);
    lastRequest_ = (lastRequest_ + 1) & ~(capture::kAskedAhead | capture::kOwed);
    return lastRequest_;
}

void Session::endRequest() { requestLock.unlock(); }

bool Session::aheadAnswer(uint32_t request, uint64_t& value) {
    capture::AheadAnswer& answer = header_->ahead[request % capture::kAheadAnswers];
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
        if (later || (waiting && waiting->forNs() > kStuckNs)) break; // then it is asked once more
        if (!waiting) waiting.emplace(*header_, capture::Wait::Answer);
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
                waiting.emplace(*header_, capture::Wait::Answer);
            } else {
                if (!headAlive()) return false;
                if (waiting->forNs() > kStuckNs) die("the nodes did not answer for 60 s");
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

bool Session::takeNews(wire::News& news, char* text) {
    if (header_->newsTail.load(std::memory_order_acquire) == newsTaken_) return false;
    const capture::NewsSlot& slot = capture::news(header_)[newsTaken_ % capture::kNewsSlots];
    std::memcpy(&news, slot.news, sizeof news);
    if (news.textBytes > capture::kNewsTextBytes) news.textBytes = capture::kNewsTextBytes;
    std::memcpy(text, slot.text, news.textBytes);
    text[news.textBytes] = 0;
    __atomic_store_n(&newsTaken_, newsTaken_ + 1, __ATOMIC_RELAXED);
    header_->newsHead.store(newsTaken_, std::memory_order_release);
    return true;
}

bool Session::answerHeader(uint32_t request, wire::ReplyHeader& header) {
    while (alive()) {
        if (!answerBytes(&header, sizeof header)) return false;
        if (header.requestId == request) return true;
        if (!takeOwed(header)) return false;
    }
    return false;
}

// An answer that is not the one waited for: owed, or late to a question given up.
bool Session::takeOwed(const wire::ReplyHeader& header) {
    void* const into = owed::placeOf(header.requestId, header.sizeBytes, header.failed != 0);
    const bool read = answerBytes(into, header.sizeBytes);
    owed::arrived(header.requestId, read && into);
    return read;
}

bool Session::replyWaits() const {
    return header_->replyTail.load(std::memory_order_acquire) - header_->replyHead.load(std::memory_order_relaxed) >= sizeof(wire::ReplyHeader);
}

bool Session::waitOwed(uint32_t request, const char* by) {
    if (!owed::isAwaited(request)) return true;
    if (!alive()) return false;
    Guard guard(requestLock);
    wakeReader(true);
    bool counted = false;
    while (owed::isAwaited(request)) {
        if (!alive()) return false;
        if (!counted && !replyWaits()) {
            countTrip(*header_, by);
            counted = true;
        }
        wire::ReplyHeader header{};
        if (!answerBytes(&header, sizeof header) || !takeOwed(header)) return false;
    }
    return true;
}

void Session::takeArrived() {
    if (!alive() || !requestLock.tryLock()) return; // who has it takes them, too
    wire::ReplyHeader header{};
    while (alive() && replyWaits() && answerBytes(&header, sizeof header) && takeOwed(header)) {}
    requestLock.unlock();
}

} // namespace mural
