#include "nodes/remote_wall/wall_link.hpp"

#include <array>

#include "common/base/little_endian.hpp"

namespace mural::remote {

namespace {

constexpr int64_t kBodyMs = 30'000; // for the rest of a message
constexpr size_t kLengthBytes = 4;

} // namespace

Result<void> WallLink::send(const Message& message, Deadline deadline, Follows follows) {
    const std::vector<std::byte> body = encode(message);
    std::array<std::byte, kLengthBytes> length;
    storeLittle(length.data(), static_cast<uint32_t>(body.size()));
    const std::lock_guard lock(sending_);
    if (auto sent = connection_->write(length, deadline); !sent) return sent;
    if (auto sent = connection_->write(body, deadline); !sent) return sent;
    if (follows == Follows::Nothing) connection_->flush();
    return connection_->alive() ? Result<void>() : Error{"the connection has ended"};
}

Result<std::optional<Message>> WallLink::receive(Deadline deadline) {
    std::array<std::byte, kLengthBytes> length;
    if (auto came = connection_->read(length, deadline); !came) {
        if (connection_->timedOut()) return std::optional<Message>();
        return came.error();
    }
    const size_t bytes = loadLittle<uint32_t>(length.data());
    if (bytes == 0 || bytes > kMaxMessageBytes)
        return Error{"it sent a message of " + std::to_string(bytes) + " bytes; install the same version of mural"};
    received_.resize(bytes);
    if (auto came = connection_->read(received_, Deadline::inMs(kBodyMs)); !came) return came.error();
    auto message = parseMessage(received_);
    if (!message) return message.error();
    return std::optional<Message>(std::move(*message));
}

} // namespace mural::remote
