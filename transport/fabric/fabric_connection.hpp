// A Connection over a libfabric channel. Small writes are buffered until flush() or until a message is full. Thread
// safety: as Connection; flush() and close() may be called from any thread.
#pragma once

#include <atomic>
#include <sys/types.h>

#include "transport/connection.hpp"
#include "transport/fabric/fabric_channel.hpp"

namespace mural::fabric {

class FabricConnection final : public Connection {
public:
    FabricConnection(std::unique_ptr<Endpoint> endpoint, Greeting peer, std::string description);
    ~FabricConnection() override;

    Result<void> read(std::span<std::byte> into, Deadline deadline) override;
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override;
    // Waits for credits and for the provider until the deadline of the last write, and for at least a second.
    void flush() override;
    // Written data is sent in the background while the peer reads it (fabric_closing.hpp).
    void close() override;

    [[nodiscard]] bool timedOut() const override;
    // Returns false after the peer has closed or died; its data can still be read.
    [[nodiscard]] bool alive() const override;
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    size_t takeBuffered(std::span<std::byte> into);
    Error failed(Channel::Lock& lock, const char* verb, Channel::End end, size_t doneBytes, size_t wantedBytes);
    void endStream(Channel::Lock& lock);

    std::shared_ptr<Channel> channel_; // outlives this object while it is drained
    std::string description_;
    pid_t ownerPid_;
    std::atomic<bool> closed_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};

    // State of the reader.
    bool reading_ = false; // owns the message
    Channel::Message message_{};

    // State of the writer, protected by the channel's lock.
    Deadline lastWriteDeadline_ = Deadline::inMs(0);
};

} // namespace mural::fabric
