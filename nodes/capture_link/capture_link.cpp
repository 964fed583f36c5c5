#include "nodes/capture_link/capture_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "common/ipc/descriptor_message.hpp"
#include "common/ipc/futex.hpp"
#include "streamcodec/registry_digest.hpp"

namespace mural {
namespace {

Error linkError(const std::string& session, const std::string& what) {
    return Error{"session @" + session + ": " + what};
}

Result<FileDescriptor> connectAbstract(const std::string& session) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (session.empty() || session.size() >= sizeof address.sun_path)
        return linkError(session, "is not the name of a session; start the program with `mural run` or `mural replay`");
    std::memcpy(address.sun_path + 1, session.data(), session.size()); // [0] = 0: abstract
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + session.size());
    FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!socket.valid() || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0)
        return linkError(session, std::string("cannot be reached: ") + std::strerror(errno) + "; start it again");
    return socket;
}

// Fills `into` completely before the deadline. Stores a received descriptor in `memory`.
bool receiveWhole(int socket, std::span<std::byte> into, FileDescriptor* memory, Deadline deadline) {
    while (!into.empty()) {
        pollfd poller{socket, POLLIN, 0};
        if (deadline.passed()) return false;
        if (poll(&poller, 1, static_cast<int>(deadline.leftNs(kNsPerS) / kNsPerMs) + 1) <= 0) continue;
        FileDescriptor passed;
        const ssize_t n = receiveWithDescriptor(socket, into, passed);
        if (n < 0 && errno == EAGAIN) continue;
        if (n <= 0) return false;
        if (passed.valid() && memory != nullptr) *memory = std::move(passed);
        into = into.subspan(static_cast<size_t>(n));
    }
    return true;
}

} // namespace

Result<std::unique_ptr<CaptureLink>> CaptureLink::connect(const std::string& session, capture::ProgramKind kind,
                                                          Deadline deadline) {
    auto socket = connectAbstract(session);
    if (!socket) return socket.error();
    const capture::Hello hello{capture::kMagic, capture::kVersion, registryDigest(), getpid(), kind};
    if (send(socket->get(), &hello, sizeof hello, MSG_NOSIGNAL) != sizeof hello)
        return linkError(session, "does not read; start it again");
    capture::Welcome welcome{};
    FileDescriptor memory;
    if (!receiveWhole(socket->get(), std::as_writable_bytes(std::span(&welcome, 1)), &memory, deadline))
        return linkError(session, "does not answer; start it again");
    std::string text(std::min<uint32_t>(welcome.extensionBytes, 1u << 20), '\0');
    if (!receiveWhole(socket->get(), std::as_writable_bytes(std::span(text)), nullptr, deadline))
        return linkError(session, "does not answer; start it again");
    if (welcome.refused != 0) return linkError(session, "refuses: " + text);
    if (!memory.valid() || welcome.version != capture::kVersion)
        return linkError(session, "is of another build; start it again");
    const off_t size = lseek(memory.get(), 0, SEEK_END);
    void* base = size > 0
                     ? mmap(nullptr, static_cast<size_t>(size), PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0)
                     : MAP_FAILED;
    if (base == MAP_FAILED)
        return linkError(session,
                         std::string("its memory cannot be mapped: ") + std::strerror(errno) + "; is memory short?");
    return std::unique_ptr<CaptureLink>(new CaptureLink(
        std::move(*socket), welcome, static_cast<capture::CaptureHeader*>(base), static_cast<size_t>(size)));
}

CaptureLink::CaptureLink(FileDescriptor socket, const capture::Welcome& welcome, capture::CaptureHeader* header,
                         size_t sizeBytes)
    : socket_(std::move(socket)), welcome_(welcome), header_(header), sizeBytes_(sizeBytes) {}

CaptureLink::~CaptureLink() { leave(); }

// Uses one chunk per packet, so that a freed chunk shows that the nodes have its packet.
bool CaptureLink::publish(uint16_t thread, std::span<const std::byte> packet) {
    const uint32_t head = header_->freedHead.load(std::memory_order_relaxed);
    if (header_->freedTail.load(std::memory_order_acquire) == head) return false;
    const uint32_t chunk = capture::freed(header_)[head & (header_->chunkCount - 1)];
    header_->freedHead.store(head + 1, std::memory_order_release);
    std::memcpy(capture::chunk(header_, chunk), packet.data(), packet.size());
    const uint32_t tail = header_->publishedTail.load(std::memory_order_relaxed);
    capture::publications(header_)[tail & (header_->chunkCount - 1)] = {chunk, 0, static_cast<uint32_t>(packet.size()),
                                                                        thread, 1};
    header_->publishedTail.store(tail + 1, std::memory_order_release);
    // either the reader sees the publication, or the check below sees that it sleeps
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (header_->reader.load(std::memory_order_relaxed) != static_cast<uint32_t>(capture::Reader::Reads))
        futexWakeAll(header_->publishedTail);
    return true;
}

bool CaptureLink::allTaken() const {
    return header_->freedTail.load(std::memory_order_acquire) - header_->freedHead.load(std::memory_order_relaxed) ==
           header_->chunkCount;
}

bool CaptureLink::mayGoOn(uint32_t submittedFrame) {
    const uint32_t wanted = submittedFrame - header_->latency.load(std::memory_order_relaxed);
    const auto done = [&] {
        return static_cast<int32_t>(header_->framesDone.load(std::memory_order_acquire) - wanted) >= 0;
    };
    if (done()) return true;
    header_->framesWanted.store(capture::kFramesWanted | wanted, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    return done();
}

uint64_t CaptureLink::unanswered() {
    takeAnswers();
    return requested_ > answered_ ? requested_ - answered_ : 0;
}

void CaptureLink::takeAnswers() {
    if (header_ == nullptr) return;
    uint32_t head = header_->replyHead.load(std::memory_order_relaxed);
    const uint32_t tail = header_->replyTail.load(std::memory_order_acquire);
    if (head == tail) return;
    while (head != tail) {
        const uint32_t there = tail - head;
        if (replyBytes_ > 0) {
            const uint32_t slot = head & (header_->replyCapacity - 1);
            const auto n =
                static_cast<uint32_t>(std::min<uint64_t>({replyBytes_, there, header_->replyCapacity - slot}));
            const std::byte* const from = capture::replies(header_) + slot;
            if (takeReply_) replyContent_.insert(replyContent_.end(), from, from + n);
            replyBytes_ -= n;
            head += n;
        } else {
            const uint32_t slot = head & (header_->replyCapacity - 1);
            const auto n = std::min(
                {static_cast<uint32_t>(sizeof reply_ - replyHeaderBytes_), there, header_->replyCapacity - slot});
            std::memcpy(reinterpret_cast<std::byte*>(&reply_) + replyHeaderBytes_, capture::replies(header_) + slot, n);
            replyHeaderBytes_ += n;
            head += n;
            if (replyHeaderBytes_ == sizeof reply_) replyBytes_ = reply_.sizeBytes;
        }
        if (replyHeaderBytes_ == sizeof reply_ && replyBytes_ == 0) {
            replyHeaderBytes_ = 0;
            ++answered_;
            if (takeReply_) takeReply_(reply_, replyContent_);
            replyContent_.clear();
        }
    }
    header_->replyHead.store(head, std::memory_order_release);
    futexWakeAll(header_->replyHead);
}

void CaptureLink::leave() {
    if (header_ != nullptr) munmap(header_, sizeBytes_);
    header_ = nullptr;
}

bool CaptureLink::gone(int64_t sliceMs) {
    pollfd poller{socket_.get(), POLLIN, 0};
    if (poll(&poller, 1, static_cast<int>(sliceMs)) <= 0) return false;
    char byte = 0;
    return recv(socket_.get(), &byte, 1, MSG_DONTWAIT) <= 0;
}

} // namespace mural
