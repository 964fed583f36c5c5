// A Connection over two byte rings: the in-process pipe, and shared memory between processes.
//
// Between processes a Unix socket reports the peer's liveness: it breaks when the process dies for any reason. Only a
// waiting side checks it, between slices of sleep. Thread safety: as Connection; flush() belongs to the writing thread,
// close() may be called from any thread.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <sys/types.h>

#include "transport/connection.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/shm/ring_memory.hpp"

namespace mural {

class RingConnection final : public Connection {
public:
    // side: 0 or 1, see RingMemory. peerSocket: invalid if both ends are in one process.
    RingConnection(std::shared_ptr<RingMemory> memory, int side, FileDescriptor peerSocket, std::string description);
    ~RingConnection() override;

    Result<void> read(std::span<std::byte> into, Deadline deadline) override;
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override;
    void flush() override { writer_.announce(); }
    void close() override;

    [[nodiscard]] bool timedOut() const override;
    // Returns false after the peer has closed or died; its data can still be read.
    [[nodiscard]] bool alive() const override;
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    enum class WaitEnd { Ready, DeadlinePassed, PeerGone, ClosedHere, Damaged };

    WaitEnd waitForData(Deadline deadline);
    WaitEnd waitForRoom(Deadline deadline);
    [[nodiscard]] bool peerProcessGone() const;
    Error failed(const char* verb, WaitEnd why, size_t doneBytes, size_t wantedBytes);

    std::shared_ptr<RingMemory> memory_;
    RingControl& outControl_;
    RingControl& inControl_;
    RingWriter writer_;
    RingReader reader_;
    FileDescriptor peerSocket_;
    std::string description_;
    pid_t ownerPid_;
    int readSpins_ = 2;  // reader's spins before it sleeps
    int writeSpins_ = 2; // writer's spins
    std::atomic<bool> closed_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};
};

} // namespace mural
