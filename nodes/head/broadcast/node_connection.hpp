// The head's end of one render node: its connection, the thread that reads its messages, and its liveness.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/head/results/byte_buffer.hpp"
#include "nodes/input/input_event.hpp"
#include "nodes/launch/launchers/running_node.hpp"
#include "nodes/frame_transfer/picture_unpacker.hpp"
#include "nodes/frame_transfer/transfer_scale.hpp"
#include "streamcodec/wire/frame_spans.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/output_proof.hpp"
#include "streamcodec/wire/preview_tile.hpp"
#include "streamcodec/wire/replies.hpp"
#include "transport/connection.hpp"

namespace mural {

// Receives the messages of all nodes. Called by the node's reader thread; an error loses the node. Sizes and headers
// have been validated, contents have not.
class NodeEvents {
public:
    virtual ~NodeEvents() = default;
    virtual Result<void> nodeReady(int node, const std::string& json) = 0;
    virtual Result<void> nodeAnswer(int node, const wire::ReplyPartHeader& header, ByteBuffer bytes) = 0;
    virtual Result<void> nodeFrameDone(int node, const wire::FrameDoneMessage& message) = 0;
    virtual Result<void> nodePicture(int node, const wire::PictureHeader& header, ByteBuffer rows) = 0;
    virtual Result<void> nodeWindowGone(int node, const wire::WindowGoneMessage& message) = 0;
    virtual Result<void> nodeDriverEvent(int node, const wire::DriverEvent& event, const std::string& text) = 0;
    // A message about distributed objects to a program with the native API.
    virtual Result<void> nodeObjectRequest(int node, uint32_t client, ByteBuffer message) = 0;
    virtual Result<void> nodeLog(int node, const std::string& text) = 0;
    virtual Result<void> nodeGoodbye(int node, const std::string& json) = 0;
    virtual Result<void> nodeInView(int node, uint32_t view, const std::vector<wire::ClientFrame>& frames) = 0;
    // The node reports the phases and areas of all windows, at the position of the RequestPhase command with that
    // number.
    virtual Result<void> nodeTurns(int node, uint32_t number, const std::vector<std::byte>& turns) = 0;
    virtual Result<void> nodeSynchronized(int node, const wire::SynchronizedMessage& message) = 0;
    // Precedes the nodeFrameDone of the frame, while statistics are on. The spans have been validated (checkSpans).
    virtual Result<void> nodeFrameSpans(int node, const wire::FrameSpansHeader& header,
                                        const std::vector<wire::FrameSpan>& spans) = 0;
    virtual Result<void> nodeClock(int node, const wire::ClockReplyMessage& message) = 0;
    virtual Result<void> nodeOutputProof(int node, const wire::OutputProofMessage& message) = 0;
    virtual Result<void> nodePreviewTile(int node, const wire::PreviewTileHeader& header,
                                         const std::vector<std::byte>& jpeg) = 0;
    virtual Result<void> nodeWindowInput(int node, const input::InputEvent& event) = 0;
    // The last call for a node that ended without Goodbye, after all of its messages.
    virtual void nodeLost(int node, const std::string& why) = 0;
};

struct NodeLocation {
    int node = 0;
    std::string where = "local"; // or the host
};

// send(), flush() and setFeed() need StreamBroadcaster's lock. All other calls are thread-safe.
class NodeConnection {
public:
    NodeConnection(NodeLocation location,
                   std::unique_ptr<Connection> connection, // null: the node has not connected and counts as lost
                   std::unique_ptr<RunningNode> process,   // null: not a child of this process (tests)
                   NodeEvents& events);
    ~NodeConnection();

    // The destination of the node's packets: the connection, none, or a queue that another thread sends during resync.
    enum class Feed { Direct, Nothing, Queued };

    // Sets the decoder of the node's pictures (nodes/frame_transfer). Call before startReading(). transferScale: the
    // scale of its pictures in transfer (nodes/frame_transfer/transfer_scale.hpp).
    void unpackBy(const std::string& codec, const Zoom& transferScale) {
        transferScale_ = transferScale;
        if (codec != kRawCodec) pictures_ = std::make_unique<PictureUnpacker>(codec);
    }
    void startReading();

    // A failed write loses the node and is not reported to the caller.
    void send(std::span<const std::byte> header, std::span<const std::byte> payload);
    void flush();
    void setFeed(Feed feed) { feed_ = feed; }
    [[nodiscard]] Feed feed() const { return feed_; }
    // Takes all queued packets with their headers, and leaves an empty queue.
    std::vector<std::vector<std::byte>> takeQueue();
    [[nodiscard]] bool queueEmpty() const;
    // Writes to the connection regardless of the feed. One thread only.
    void sendNow(std::span<const std::byte> header, std::span<const std::byte> payload);
    void flushNow();

    [[nodiscard]] NetworkPath path() const { return connection_->path(); }
    // All packets except the setup arrive by multicast (NodeMulticast).
    void setByMulticast(bool by) { byMulticast_ = by; }
    [[nodiscard]] bool byMulticast() const { return byMulticast_; }
    // A restarted node is not a member until its resync has finished.
    // The node sends Goodbye and ends. The end of its multicast membership is then no loss.
    void setLeaves() { leaves_ = true; }
    [[nodiscard]] bool leaves() const { return leaves_; }
    void setMember(bool member) { member_ = member; }
    [[nodiscard]] bool member() const { return member_; }
    // The node receives delta-coded batches. Call before the first one.
    void setInBatches(bool in) { inBatches_ = in; }
    [[nodiscard]] bool inBatches() const { return inBatches_; }
    // Sets whether the node receives batches once it is a member.
    void setJoinsBatches(bool joins) { joinsBatches_ = joins; }
    [[nodiscard]] bool joinsBatches() const { return joinsBatches_; }

    // Sets whether the node joins the multicast group once it is a member.
    void setJoinsGroup(bool joins) { joinsGroup_ = joins; }
    [[nodiscard]] bool joinsGroup() const { return joinsGroup_; }

    // Closes the connection. The reader thread then reports the first reason given.
    void lose(const std::string& why);
    // Called periodically: loses a node that has been silent for patienceNs. Nodes send heartbeats even while they draw
    // (nodes/render/heartbeat.hpp), so a silent node is stopped or hangs.
    void watch(int64_t nowNs, int64_t patienceNs);

    [[nodiscard]] bool alive() const { return alive_.load(std::memory_order_acquire); }
    // True after the node's first message: it accepts the head's version.
    [[nodiscard]] bool isHeard() const { return isHeard_.load(std::memory_order_relaxed); }
    [[nodiscard]] bool goodbyeReceived() const { return goodbyeReceived_.load(std::memory_order_acquire); }
    [[nodiscard]] bool readerEnded() const { return readerEnded_.load(std::memory_order_acquire); }
    // Returns the time of the last message or packet; the current time while the head processes a message.
    [[nodiscard]] int64_t lastProgressNs(int64_t nowNs) const {
        return handlingSinceNs_ != 0 ? nowNs : lastMessageNs_.load();
    }
    // Encoded and decoded size of the node's pictures.
    [[nodiscard]] int64_t pictureBytes() const { return pictureBytes_.load(std::memory_order_relaxed); }
    [[nodiscard]] int64_t pictureRawBytes() const { return pictureRawBytes_.load(std::memory_order_relaxed); }
    // Time since the last message.
    [[nodiscard]] int64_t silentNs(int64_t nowNs) const { return nowNs - std::min(nowNs, receivedNs_.load()); }
    [[nodiscard]] const NodeLocation& location() const { return location_; }
    [[nodiscard]] RunningNode* process() { return process_.get(); }
    [[nodiscard]] std::string describe() const; // "node 2 (local, pid 77)"

    // Closes the connection of a node that has sent Goodbye, and waits for the end of its process until the deadline.
    void endAfterGoodbye(Deadline deadline);
    // Joins the reader thread and ends the process.
    void end();
    // Frees the memory of the connection and of packets that wait. Call after end(), while no thread sends.
    void release() {
        takeQueue();
        const std::lock_guard lock(reasonMutex_);
        connection_.reset();
        pictures_.reset();
    }

private:
    void readMessages();
    Result<bool> readHeader(wire::MessageHeader& header);
    Result<void> readMessage(const wire::MessageHeader& header);
    Result<ByteBuffer> readBytes(size_t sizeBytes);
    template <class Header> Result<void> readStruct(Header& header);
    Result<void> readDriverEvent(uint32_t sizeBytes);
    Result<void> readObjectRequest(uint32_t sizeBytes);
    Result<void> readAnswer(uint32_t sizeBytes);
    Result<void> readPicture(uint32_t sizeBytes);
    Result<void> readPackedPicture(uint32_t sizeBytes);
    void forgetPictures(const wire::WindowGoneMessage& gone);
    Result<void> readText(const wire::MessageHeader& header);
    Result<void> readInView(uint32_t sizeBytes);
    Result<void> readTurns(uint32_t sizeBytes);
    Result<void> readFrameSpans(uint32_t sizeBytes);
    Result<void> readWindowInput(uint32_t sizeBytes);
    Result<void> readPreviewTile(uint32_t sizeBytes);
    // Reads a number followed by a list that fills the message.
    template <class Entry>
    Result<void> readList(uint32_t sizeBytes, uint32_t& first, std::vector<Entry>& entries, const char* what);
    template <class Handler> Result<void> handle(Handler&& handler);
    std::string reasonOfEnd();

    const NodeLocation location_;
    std::unique_ptr<Connection> connection_;
    const std::unique_ptr<RunningNode> process_;
    NodeEvents& events_;
    Zoom transferScale_;                        // scale of its pictures in transfer
    std::unique_ptr<PictureUnpacker> pictures_; // null: pictures are not encoded
    std::atomic<int64_t> pictureBytes_{0}, pictureRawBytes_{0};
    std::thread reader_;
    std::atomic<bool> alive_;
    std::atomic<bool> isHeard_{false};
    std::atomic<bool> goodbyeReceived_{false};
    std::atomic<bool> byMulticast_{false};
    std::atomic<bool> joinsGroup_{false};
    std::atomic<bool> leaves_{false};
    bool member_ = true;
    bool inBatches_ = false;
    bool joinsBatches_ = false;
    std::atomic<Feed> feed_{Feed::Direct};
    mutable std::mutex queueMutex_; // guards the members below
    std::vector<std::vector<std::byte>> queue_;
    size_t queueBytes_ = 0;
    std::atomic<bool> readerEnded_;
    int64_t watchedNs_ = 0;                   // time of the last watch()
    int64_t excusedNs_ = 0;                   // silence before this time does not count
    std::atomic<bool> inMessage_{false};      // the reader is inside a message
    std::atomic<int64_t> receivedNs_{0};      // time of the last complete message
    std::atomic<int64_t> handlingSinceNs_{0}; // 0: the reader is waiting for the node
    std::atomic<int64_t> lastMessageNs_{0};   // time of the last processed message other than Alive
    std::mutex reasonMutex_;
    std::string reason_;
};

} // namespace mural
