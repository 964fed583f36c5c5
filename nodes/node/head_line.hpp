// The node's end of the connection to the head: messages out, packets in.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "nodes/node/node.hpp"
#include "streamcodec/wire.hpp"
#include "transport/connection.hpp"

namespace mural {

class HeadLine {
public:
    static Result<std::unique_ptr<HeadLine>> open(const NodeOptions& options);

    // The next packet; its payload lives until the next call. Error: the head is gone.
    Result<wire::PacketHeader> next(std::span<const std::byte>& payload);

    // One message of up to three parts, sent at once. Errors end the node: `broken()`.
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    void sendText(wire::NodeMessage type, const std::string& text);
    [[nodiscard]] bool broken() const { return broken_; }

private:
    explicit HeadLine(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

    std::unique_ptr<Connection> connection_;
    std::vector<std::byte> payload_;
    bool broken_ = false;
};

} // namespace mural
