// A Connection over a channel of libfabric. Small writes are gathered until flush() or until a message is full.
// Threads: as Connection says; flush() and close() may come from any thread.
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
    // Waits for credits, and until the provider has sent all, to the deadline of the last write, and a second at least.
    void flush() override;
    // What was written goes out in the background, as the other end reads it (fabric_closing.hpp).
    void close() override;

    [[nodiscard]] bool timedOut() const override;
    // False as soon as the other end is closed or dead; what it has written can still be read.
    [[nodiscard]] bool alive() const override;
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    size_t takeBuffered(std::span<std::byte> into);
    Error failed(Channel::Lock& lock, const char* verb, Channel::End end, size_t doneBytes, size_t wantedBytes);
    void endStream(Channel::Lock& lock);

    std::shared_ptr<Channel> channel_; // outlives this while it is drained
    std::string description_;
    pid_t ownerPid_;
    std::atomic<bool> closed_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};

    // The reader's.
    bool reading_ = false; // has the message
    Channel::Message message_{};

    // The writer's, under the channel's lock.
    Deadline lastWriteDeadline_ = Deadline::inMs(0);
};

} // namespace mural::fabric
