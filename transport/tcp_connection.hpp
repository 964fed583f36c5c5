// A Connection over TCP. Small writes are gathered until flush() or until a buffer is full; small
// reads are served from a buffer; both so that a stream of small records costs few system calls.
//
// Threads: as Connection says; flush() and close() may come from any thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <vector>

#include "transport/connection.hpp"
#include "transport/file_descriptor.hpp"

namespace mural {

class TcpConnection final : public Connection {
public:
    // The socket is connected and non-blocking.
    explicit TcpConnection(FileDescriptor socket);
    ~TcpConnection() override;

    Result<void> read(std::span<std::byte> into, Deadline deadline) override;
    // Up to 64 KiB are never cut in half by a deadline: none of them or all have been taken then.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override;
    // Waits for a full socket until the deadline of the last write, and a second at least; what
    // does not go out then goes first with the next write or flush.
    void flush() override;
    // What was written goes out first as far as the socket takes it at once.
    void close() override;

    [[nodiscard]] bool timedOut() const override;
    // False as soon as the other end is closed or dead; what it has written can still be read.
    [[nodiscard]] bool alive() const override;
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] NetworkPath path() const override; // from the segments that both ends agreed on
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    // An outcome of one direction. PeerGone keeps the errno that told it, 0 for an orderly end.
    enum class End { Done, DeadlinePassed, PeerGone, ClosedHere };

    size_t takeBuffered(std::span<std::byte> into);
    End receiveSome(std::span<std::byte> into, Deadline deadline, size_t& gotBytes);
    End waitReadable(Deadline deadline);
    End waitWritable(Deadline deadline);
    // Sends the gathered bytes, then `bytes`; sentBytes counts of `bytes` only.
    End sendAll(std::span<const std::byte> bytes, Deadline deadline, size_t& sentBytes);
    ssize_t sendOnce(std::span<const std::byte> bytes);
    [[nodiscard]] size_t gatheredBytes() const { return gathered_.size() - gatheredAt_; }
    void gather(std::span<const std::byte> bytes);
    Error failed(const char* verb, End end, int code, size_t doneBytes, size_t wantedBytes);
    void endStream();

    FileDescriptor socket_;
    std::string description_;
    pid_t ownerPid_;
    std::atomic<bool> closed_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};

    // The reader's.
    std::unique_ptr<std::byte[]> received_;
    size_t receivedAt_ = 0;
    size_t receivedEnd_ = 0;
    int readCode_ = 0;

    // The writer's, also flush's and close's.
    std::mutex writeMutex_;
    std::vector<std::byte> gathered_;
    size_t gatheredAt_ = 0; // before it: already sent
    Deadline lastWriteDeadline_ = Deadline::inMs(0);
    int writeCode_ = 0;
};

// Options that every TCP connection has; false with errno set when the socket is not usable.
bool prepareTcpSocket(int socket);

} // namespace mural
