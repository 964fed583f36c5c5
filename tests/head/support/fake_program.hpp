// A captured program without GL: it sends Hello, maps the ring and publishes words that FakeNode reads.
#pragma once

#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <poll.h>
#include <string>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

#include "common/ipc/capture_ring.hpp"
#include "common/base/clock.hpp"
#include "common/ipc/futex.hpp"
#include "streamcodec/wire/replies.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

// Verbs of the test payloads: u32 length in words, u32 verb, arguments.
enum FakeVerb : uint32_t {
    kFakeSwap = 1,       // frame, window, width, height
    kFakePixels = 2,     // request, x, y, w, h
    kFakeBytes = 3,      // request
    kFakeSum = 4,        // request
    kFakeNote = 5,       // any arguments, which nodes only record
    kFakeWindowGone = 6, // window
};

constexpr uint64_t kTestDigest = 0x1234567890abcdef;
constexpr int64_t kTestPatienceMs = 20'000;

class FakeProgram {
public:
    // Connects to the head. Returns false if the socket is not available or the head's reply is invalid.
    bool connect(const std::string& session, uint64_t digest = kTestDigest,
                 capture::ProgramKind kind = capture::ProgramKind::Captured) {
        socket_ = FileDescriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path + 1, session.data(), session.size());
        const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + session.size());
        if (::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), length) != 0) return false;
        const capture::Hello hello{capture::kMagic, capture::kVersion, digest, getpid(), kind};
        if (send(socket_.get(), &hello, sizeof(hello), MSG_NOSIGNAL) != sizeof(hello)) return false;
        int memory = -1;
        if (!receiveWelcome(memory)) return false;
        text_.resize(welcome_.extensionBytes);
        if (!text_.empty() &&
            recv(socket_.get(), text_.data(), text_.size(), MSG_WAITALL) != static_cast<ssize_t>(text_.size()))
            return false;
        if (memory < 0) return welcome_.refused != 0;
        const FileDescriptor owned(memory);
        sizeBytes_ = static_cast<size_t>(lseek(memory, 0, SEEK_END));
        void* base = mmap(nullptr, sizeBytes_, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
        if (base == MAP_FAILED) return false;
        header_ = static_cast<capture::CaptureHeader*>(base);
        return true;
    }
    FakeProgram() = default;
    FakeProgram(const FakeProgram&) = delete;
    FakeProgram& operator=(const FakeProgram&) = delete;
    ~FakeProgram() { disconnect(); }
    // Closes the socket and unmaps the memory, as the end of a process does.
    void disconnect() {
        closeSocket();
        if (header_ != nullptr) munmap(header_, sizeBytes_);
        header_ = nullptr;
    }
    void closeSocket() { socket_ = FileDescriptor(); }

    capture::CaptureHeader* header() { return header_; }
    const capture::Welcome& welcome() const { return welcome_; }
    const std::string& text() const { return text_; }

    // Publishes one record that ends its chunk.
    bool publish(uint32_t verb, const std::vector<uint32_t>& arguments, uint16_t stream = 0) {
        std::vector<uint32_t> words{static_cast<uint32_t>(arguments.size() + 2), verb};
        words.insert(words.end(), arguments.begin(), arguments.end());
        return publishWords(words, stream);
    }
    bool publishWords(const std::vector<uint32_t>& words, uint16_t stream = 0) {
        uint32_t chunk = 0;
        if (!takeChunk(chunk)) return false;
        std::memcpy(capture::chunk(header_, chunk), words.data(), words.size() * 4);
        return publishRaw({chunk, 0, static_cast<uint32_t>(words.size() * 4), stream, 1});
    }
    bool publishRaw(const capture::Publication& publication) {
        const uint32_t tail = header_->publishedTail.load();
        const bool room =
            waitUntil(header_->publishedHead, [&](uint32_t head) { return tail - head < header_->chunkCount; });
        if (!room) return false;
        capture::publications(header_)[tail % header_->chunkCount] = publication;
        header_->publishedTail.store(tail + 1);
        futexWakeAll(header_->publishedTail);
        return true;
    }
    bool takeChunk(uint32_t& chunk) {
        const uint32_t head = header_->freedHead.load();
        if (!waitUntil(header_->freedTail, [&](uint32_t tail) { return tail != head; })) return false;
        chunk = capture::freed(header_)[head % header_->chunkCount];
        header_->freedHead.store(head + 1);
        return true;
    }

    bool waitFramesDone(uint32_t frames) {
        return waitUntil(header_->framesDone, [&](uint32_t done) { return done >= frames; });
    }
    bool waitFramesShown(uint32_t frames) {
        return waitUntil(header_->framesShown, [&](uint32_t done) { return done >= frames; });
    }
    bool waitHeadGone() {
        return waitUntil(header_->headGone, [](uint32_t gone) { return gone != 0; });
    }

    struct Answer {
        wire::ReplyHeader header{};
        std::vector<std::byte> bytes;
    };
    bool readAnswer(Answer& answer) {
        if (!readReply(&answer.header, sizeof(answer.header))) return false;
        answer.bytes.resize(answer.header.sizeBytes);
        return readReply(answer.bytes.data(), answer.bytes.size());
    }

private:
    template <class Condition> bool waitUntil(const std::atomic<uint32_t>& word, Condition condition) {
        const Deadline deadline = Deadline::inMs(kTestPatienceMs);
        while (true) {
            const uint32_t value = word.load();
            if (condition(value)) return true;
            if (deadline.passed()) return false;
            futexWait(word, value, deadline.leftNs(10 * kNsPerMs));
        }
    }
    bool receiveWelcome(int& memory) {
        alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
        iovec part{&welcome_, sizeof(welcome_)};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        message.msg_control = control;
        message.msg_controllen = sizeof(control);
        pollfd ready{socket_.get(), POLLIN, 0};
        if (poll(&ready, 1, static_cast<int>(kTestPatienceMs)) <= 0) return false;
        if (recvmsg(socket_.get(), &message, MSG_WAITALL | MSG_CMSG_CLOEXEC) != sizeof(welcome_)) return false;
        const cmsghdr* c = CMSG_FIRSTHDR(&message);
        if (c != nullptr && c->cmsg_type == SCM_RIGHTS) std::memcpy(&memory, CMSG_DATA(c), sizeof(int));
        return true;
    }
    bool readReply(void* into, size_t bytes) {
        auto* p = static_cast<std::byte*>(into);
        while (bytes > 0) {
            const uint32_t head = header_->replyHead.load();
            if (!waitUntil(header_->replyTail, [&](uint32_t tail) { return tail != head; })) return false;
            const uint32_t slot = head % header_->replyCapacity;
            const size_t count =
                std::min<size_t>({bytes, header_->replyTail.load() - head, header_->replyCapacity - slot});
            std::memcpy(p, capture::replies(header_) + slot, count);
            p += count;
            bytes -= count;
            header_->replyHead.store(head + static_cast<uint32_t>(count));
            futexWakeAll(header_->replyHead);
        }
        return true;
    }

    FileDescriptor socket_;
    capture::CaptureHeader* header_ = nullptr;
    size_t sizeBytes_ = 0;
    capture::Welcome welcome_{};
    std::string text_;
};

} // namespace mural
