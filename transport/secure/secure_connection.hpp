// A Connection encrypted with a shared secret: a SecureChannel over another Connection.
//
// Thread safety: as Connection; flush() and close() may be called from any thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "transport/connection.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

class SecureConnection final : public Connection {
public:
    using Cancelled = std::function<bool()>; // polled every 100 ms; may be empty

    // Both return after mutual authentication. Errors: a wrong secret, the deadline, the peer's end.
    static Result<std::unique_ptr<SecureConnection>> connecting(std::unique_ptr<Connection> over,
                                                                const std::string& name, const ChannelSecret& secret,
                                                                Deadline deadline);
    static Result<std::unique_ptr<SecureConnection>> accepting(std::unique_ptr<Connection> over,
                                                               SecureChannel::FindSecret find, Deadline deadline,
                                                               const Cancelled& cancelled = {});
    ~SecureConnection() override;

    Result<void> read(std::span<std::byte> into, Deadline deadline) override;
    // Small writes are buffered until flush() or until a record is full.
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override;
    void flush() override;
    // The peer can distinguish this from a broken connection.
    void close() override;

    [[nodiscard]] bool timedOut() const override { return !closed_ && (readTimedOut_ || writeTimedOut_); }
    [[nodiscard]] bool alive() const override { return !closed_ && over_->alive(); }
    [[nodiscard]] std::string describe() const override { return over_->describe() + ", encrypted"; }
    [[nodiscard]] NetworkPath path() const override { return over_->path(); }
    // Payload, without the overhead of encryption.
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }
    [[nodiscard]] const std::string& name() const { return channel_.name(); } // of the connecting end

private:
    SecureConnection(std::unique_ptr<Connection> over, SecureChannel channel);
    static Result<std::unique_ptr<SecureConnection>> shakeHands(std::unique_ptr<SecureConnection> connection,
                                                                Deadline deadline, const Cancelled& cancelled);

    Result<void> takeRecord(Deadline deadline);
    Result<void> sendGathered(Deadline deadline);
    void endStream();

    const std::unique_ptr<Connection> over_;
    SecureChannel channel_;
    std::atomic<bool> closed_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};

    // State of the reader.
    std::vector<std::byte> arrived_;
    std::vector<std::vector<std::byte>> messages_;
    std::vector<std::byte> opened_; // the last record
    size_t openedAt_ = 0;

    // State of the writer, flush() and close().
    std::mutex writeMutex_;
    std::vector<std::byte> gathered_;
    std::vector<std::byte> sealed_; // a record that is not sent completely
    Deadline lastWriteDeadline_ = Deadline::inMs(0);
};

} // namespace mural
