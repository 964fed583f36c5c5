// Messages over a connection. One thread receives while others send.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/remote_wall/wall_message.hpp"
#include "transport/connection.hpp"

namespace mural::remote {

class WallLink {
public:
    explicit WallLink(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
    ~WallLink() { connection_->close(); }
    WallLink(const WallLink&) = delete;
    WallLink& operator=(const WallLink&) = delete;

    // Sends a message. With More it may wait for the next one. Errors: the connection has ended.
    enum class Follows : uint8_t { Nothing, More };
    Result<void> send(const Message& message, Deadline deadline, Follows follows = Follows::Nothing);
    // Returns the next message; nullopt: none began before the deadline. The bytes of a Tile are valid until the next
    // call. Errors: the connection has ended, or a malformed message.
    Result<std::optional<Message>> receive(Deadline deadline);
    // Any thread. Ends both directions.
    void close() { connection_->close(); }
    // Payload in bytes, since the beginning.
    [[nodiscard]] uint64_t bytesSent() const { return connection_->bytesWritten(); }
    [[nodiscard]] std::string describe() const { return connection_->describe(); }

private:
    const std::unique_ptr<Connection> connection_;
    std::mutex sending_;
    std::vector<std::byte> received_;
};

} // namespace mural::remote
