// The node's end of the connection to the head: messages out, packets in.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "economy/batch_codec.hpp"
#include "economy/unpacker.hpp"
#include "nodes/node/late_stream.hpp"
#include "nodes/node/node.hpp"
#include "streamcodec/wire.hpp"
#include "transport/connection.hpp"

namespace mural {

class HeadLine {
public:
    static Result<std::unique_ptr<HeadLine>> open(const NodeOptions& options);

    // From now on packets come by this multicast group (rsp://…), no longer by the connection.
    Result<void> follow(const std::string& stream, const std::string& secretHex, const std::string& name);

    // The same, but packets still come by the connection, until changeOver(). What fails, the head's user is told: it is not needed.
    void joinBeside(const std::string& stream, const std::string& secretHex, const std::string& name);
    // The packet in hand has come by the group, too, behind `skipBytes` others. What follows it is read there. Errors: it is no
    // member, or does not get what it was promised.
    Result<void> changeOver(uint64_t skipBytes);

    // From now on packets come in batches, which refer to nothing that came before. Errors: no memory; called within a batch that has not ended. `plant`: a fault for tests to find, or nothing.
    Result<void> unpackBatches(uint64_t storeBytes, const std::string& plant);

    // The next packet; its payload lives until the next call. Error: the head is gone, or sends what makes no
    // sense, which it has been told.
    Result<wire::PacketHeader> next(std::span<const std::byte>& payload);

    // One message of up to three parts, sent at once, from any thread. Errors end the node: `broken()`.
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    // A message without contents; nothing when another is under way.
    void sendIfFree(wire::NodeMessage type);
    void sendText(wire::NodeMessage type, const std::string& text);
    [[nodiscard]] bool broken() const { return broken_; }
    // By which the head is reached, and the address that reaches it; empty: by shared memory.
    [[nodiscard]] const std::string& headHost() const { return headHost_; }
    [[nodiscard]] std::string ownAddress() const { return connection_->path().ownAddress; }

private:
    [[nodiscard]] Result<rsp::GroupOptions> groupOptions(const std::string& stream, const std::string& secretHex, const std::string& name) const;
    Result<void> endBatch();
    void sendLocked(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b);
    explicit HeadLine(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

    const std::unique_ptr<Connection> connection_;
    std::string headHost_; // empty: shared memory
    std::unique_ptr<Connection> stream_; // null: packets come by connection_
    [[nodiscard]] Connection& line() { return stream_ ? *stream_ : *connection_; } // by which packets come
    Result<wire::PacketHeader> readPacket(std::span<const std::byte>& payload);
    Result<economy::BatchHead> readBatch();
    Result<void> readPayload(uint32_t sizeBytes, uint32_t mostBytes);
    Result<bool> nextOfBatch(wire::PacketHeader& header, std::span<const std::byte>& payload);
    Result<void> openBatch(economy::BatchHead head);

    std::vector<std::byte> payload_;
    std::unique_ptr<economy::BatchDecoder> batchDecoder_; // with the unpacker
    std::unique_ptr<economy::Unpacker> unpacker_; // null: no batches come
    bool inBatch_ = false;
    std::mutex sending_;
    std::atomic<bool> broken_{false};
    std::unique_ptr<LateStream> late_; // between joinBeside() and changeOver(); its thread sends
};

} // namespace mural
