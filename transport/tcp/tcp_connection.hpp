// A Connection over TCP. Small writes are buffered until flush() or until the buffer is full; small reads are served
// from a buffer. A stream of small records thus needs few system calls.
//
// Thread safety: as Connection; flush() and close() may be called from any thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <sys/types.h>
#include <vector>

#include "transport/connection.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

class TcpConnection final : public Connection {
public:
    // Requires a connected, non-blocking socket.
    explicit TcpConnection(FileDescriptor socket);
    ~TcpConnection() override;

    Result<void> read(std::span<std::byte> into, Deadline deadline) override;
    // A deadline never splits a write of up to 64 KiB: all or nothing is accepted.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override;
    // Waits for a full socket until the deadline of the last write, and for at least a second. The remainder is sent
    // first by the next write or flush.
    void flush() override;
    // Sends buffered data first, as far as the socket accepts it immediately.
    void close() override;

    [[nodiscard]] bool timedOut() const override;
    // Returns false after the peer has closed or died; its data can still be read.
    [[nodiscard]] bool alive() const override;
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] NetworkPath path() const override; // from the negotiated segment size
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    // Result of one direction. PeerGone keeps the errno, 0 for an orderly end.
    enum class End { Done, DeadlinePassed, PeerGone, ClosedHere };

    size_t takeBuffered(std::span<std::byte> into);
    End receiveSome(std::span<std::byte> into, Deadline deadline, size_t& gotBytes);
    End waitReadable(Deadline deadline);
    End waitWritable(Deadline deadline);
    // Sends buffered bytes, then `bytes`; sentBytes counts the latter only.
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

    // State of the reader.
    std::unique_ptr<std::byte[]> received_;
    size_t receivedAt_ = 0;
    size_t receivedEnd_ = 0;
    int readCode_ = 0;

    // State of the writer, flush() and close().
    std::mutex writeMutex_;
    std::vector<std::byte> gathered_;
    size_t gatheredAt_ = 0; // end of the part that is already sent
    Deadline lastWriteDeadline_ = Deadline::inMs(0);
    int writeCode_ = 0;
};

// Sets the options of every TCP connection. Returns false, with errno set, for an unusable socket.
bool prepareTcpSocket(int socket);

} // namespace mural
