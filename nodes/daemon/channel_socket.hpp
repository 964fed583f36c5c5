// Messages on a TCP connection with a secure channel. Every call has a deadline.
#pragma once

#include <deque>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/daemon/node_message.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

class ChannelSocket {
public:
    // The socket must be non-blocking.
    ChannelSocket(FileDescriptor socket, SecureChannel channel)
        : socket_(std::move(socket)), channel_(std::move(channel)) {}

    // Waits for the peer's proof of the secret.
    Result<void> open(Deadline deadline);
    Result<void> send(const NodeMessage& message, Deadline deadline);
    // Waits for the next message.
    Result<NodeMessage> receive(Deadline deadline);
    // Reads available messages without waiting. Errors: the peer is gone; an invalid message.
    Result<void> fetch();
    std::optional<NodeMessage> next();

    [[nodiscard]] int descriptor() const { return socket_.get(); }

private:
    Result<void> flush(Deadline deadline);
    FileDescriptor socket_;
    SecureChannel channel_;
    std::deque<NodeMessage> messages_;
};

} // namespace mural
