// The node's end of the connection to the head: receives packets and sends messages.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "streamcodec/delta/batch_codec.hpp"
#include "streamcodec/delta/delta_decoder.hpp"
#include "nodes/render/staged_multicast_join.hpp"
#include "nodes/render/node.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "transport/connection.hpp"

namespace mural {

class HeadConnection {
public:
    static Result<std::unique_ptr<HeadConnection>> open(const NodeOptions& options);

    // Receives packets from this multicast group (rsp://…) from now on, not from the connection.
    Result<void> follow(const std::string& stream, const std::string& secretHex, const std::string& name);

    // Joins the group, but receives packets from the connection until changeOver(). Reports errors to the head's user;
    // the group is optional.
    void joinBeside(const std::string& stream, const std::string& secretHex, const std::string& name);
    // Switches to the group: the current packet is also in the group's stream, after `skipBytes` bytes. Errors: not a
    // member; data missing in the group's stream.
    Result<void> changeOver(uint64_t skipBytes);

    // Packets arrive in batches from now on, with an empty dictionary. Errors: out of memory; called within a batch.
    // `plant`: fault injection for tests.
    Result<void> decodeBatches(uint64_t cacheBytes, const std::string& plant);

    // Returns the next packet; its payload is valid until the next call. Errors: the head is gone; invalid data, which
    // has been reported to the head.
    Result<wire::PacketHeader> next(std::span<const std::byte>& payload);
    // The same, but returns nothing if no packet begins before the deadline.
    Result<std::optional<wire::PacketHeader>> nextBefore(std::span<const std::byte>& payload, Deadline deadline);

    // Sends one message in up to three parts, immediately. Thread-safe. Errors set `broken()`, which ends the node.
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    // Sends an empty message, unless another thread is sending.
    void sendIfFree(wire::NodeMessage type);
    void sendText(wire::NodeMessage type, const std::string& text);
    [[nodiscard]] bool broken() const { return broken_; }
    // The head's host, and the address that reaches it; empty: shared memory.
    [[nodiscard]] const std::string& headHost() const { return headHost_; }
    [[nodiscard]] std::string ownAddress() const { return connection_->path().ownAddress; }

private:
    [[nodiscard]] Result<rsp::GroupOptions> groupOptions(const std::string& stream, const std::string& secretHex,
                                                         const std::string& name) const;
    Result<void> endBatch();
    void sendLocked(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b);
    explicit HeadConnection(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

    const std::unique_ptr<Connection> connection_;
    std::string headHost_;               // empty: shared memory
    std::unique_ptr<Connection> stream_; // null: packets arrive on connection_
    [[nodiscard]] Connection& line() { return stream_ ? *stream_ : *connection_; } // the source of packets
    Result<wire::PacketHeader> readPacket(std::span<const std::byte>& payload);
    Result<delta::BatchHead> readBatch();
    Result<void> readFirst(std::span<std::byte> bytes);
    Result<bool> awaitFirst(Deadline deadline);
    std::optional<std::byte> first_; // of the next packet or batch, already read
    Result<void> readPayload(uint32_t sizeBytes, uint32_t maxBytes);
    Result<bool> nextOfBatch(wire::PacketHeader& header, std::span<const std::byte>& payload);
    Result<void> openBatch(delta::BatchHead head);

    std::vector<std::byte> payload_;
    std::unique_ptr<delta::BatchDecoder> batchDecoder_; // set together with deltaDecoder_
    std::unique_ptr<delta::DeltaDecoder> deltaDecoder_; // null: no batches
    bool inBatch_ = false;
    std::mutex sending_;
    std::atomic<bool> broken_{false};
    std::unique_ptr<StagedMulticastJoin> late_; // between joinBeside() and changeOver(); its thread sends messages
};

} // namespace mural
