// The node's end of the connection to the head: receives packets and sends messages.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
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
    ~HeadConnection();
    HeadConnection(const HeadConnection&) = delete;
    HeadConnection& operator=(const HeadConnection&) = delete;

    // Receives packets from this multicast group (rsp://…) from now on. Packets to this node only still arrive on the
    // connection.
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

    // Returns the next packet; packets to this node only come in any order with the others. Its payload is valid until
    // the next call. Errors: the head is gone; invalid data, which has been reported to the head.
    Result<wire::PacketHeader> next(std::span<const std::byte>& payload);
    // The same, but returns nothing if no packet begins before the deadline.
    Result<std::optional<wire::PacketHeader>> nextBefore(std::span<const std::byte>& payload, Deadline deadline);

    // Sends one message in up to three parts, immediately; FrameSpans goes with the next message. Thread-safe. Errors
    // set `broken()`, which ends the node.
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    // Sends an empty message, unless another thread is sending.
    void sendIfFree(wire::NodeMessage type);
    void sendText(wire::NodeMessage type, const std::string& text);
    [[nodiscard]] bool broken() const { return broken_; }
    // The head's host, and the address that reaches it; empty: shared memory.
    [[nodiscard]] const std::string& headHost() const { return headHost_; }
    [[nodiscard]] std::string ownAddress() const { return connection_->path().ownAddress; }
    [[nodiscard]] uint64_t receivedBytes() const {
        return connection_->bytesRead() + (stream_ ? stream_->bytesRead() : 0);
    }

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
    void receiveBeside();
    bool takeBeside(wire::PacketHeader& header, std::span<const std::byte>& payload);

    std::vector<std::byte> payload_;
    std::unique_ptr<delta::BatchDecoder> batchDecoder_; // set together with deltaDecoder_
    std::unique_ptr<delta::DeltaDecoder> deltaDecoder_; // null: no batches
    bool inBatch_ = false;
    std::mutex sending_;
    std::atomic<bool> broken_{false};
    // Packets to this node only, which arrive beside the group's.
    struct OwnPacket {
        wire::PacketHeader header{};
        std::vector<std::byte> payload;
    };
    std::thread beside_; // reads connection_ while stream_ exists
    std::mutex besideMutex_;
    std::deque<OwnPacket> own_;                 // guarded by besideMutex_
    std::atomic<bool> hasOwn_{false};           // a packet has arrived at any time
    std::unique_ptr<StagedMulticastJoin> late_; // between joinBeside() and changeOver(); its thread sends messages
};

} // namespace mural
