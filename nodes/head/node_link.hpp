// The head's end of one render node: its connection, the thread that reads its messages, and the
// knowledge whether it lives.
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

#include "common/result.hpp"
#include "nodes/head/byte_buffer.hpp"
#include "nodes/head/node_process.hpp"
#include "nodes/pictures/picture_unpacker.hpp"
#include "nodes/pictures/picture_way.hpp"
#include "streamcodec/wire.hpp"
#include "transport/connection.hpp"

namespace mural {

// What comes from the nodes. Called by the reader thread of the node in question; an error loses the
// node. Sizes and headers are checked before, contents are not.
class NodeEvents {
public:
    virtual ~NodeEvents() = default;
    virtual Result<void> nodeReady(int node, const std::string& json) = 0;
    virtual Result<void> nodeAnswer(int node, const wire::AnswerHeader& header, ByteBuffer bytes) = 0;
    virtual Result<void> nodeFrameDone(int node, const wire::FrameDoneMessage& message) = 0;
    virtual Result<void> nodePicture(int node, const wire::PictureHeader& header, ByteBuffer rows) = 0;
    virtual Result<void> nodeWindowGone(int node, const wire::WindowGoneMessage& message) = 0;
    virtual Result<void> nodeNews(int node, const wire::News& news, const std::string& text) = 0;
    virtual Result<void> nodeLog(int node, const std::string& text) = 0;
    virtual Result<void> nodeBye(int node, const std::string& json) = 0;
    virtual Result<void> nodeInView(int node, uint32_t view, const std::vector<wire::ClientFrame>& frames) = 0;
    // Of all windows, where the TellTurns of that number came.
    virtual Result<void> nodeTurns(int node, uint32_t number, const std::vector<std::byte>& turns) = 0;
    virtual Result<void> nodeSynchronized(int node, const wire::SynchronizedMessage& message) = 0;
    // The last call for a node that did not say Bye; everything it had sent was handed on before.
    virtual void nodeLost(int node, const std::string& why) = 0;
};

struct NodePlace {
    int node = 0;
    std::string where = "local"; // or the host
};

// send(), flush() and setFeed() from one thread at a time (NodeSet's lock); the rest from any thread.
class NodeLink {
public:
    NodeLink(NodePlace place,
             std::unique_ptr<Connection> connection, // null: it has not come; it is as one that was lost
             std::unique_ptr<NodeProcess> process, // null: nothing of ours (tests)
             NodeEvents& events);
    ~NodeLink();

    // Where its packets go: to it; nowhere; into a queue that another thread sends by sendNow(), while it catches up.
    enum class Feed { Direct, Nothing, Queued };

    // How it packs its pictures (nodes/pictures), before startReading().
    // way: they come smaller by this (nodes/pictures/picture_way.hpp).
    void unpackBy(const std::string& codec, const Zoom& way) {
        way_ = way;
        if (codec != kRawCodec) pictures_ = std::make_unique<PictureUnpacker>(codec);
    }
    void startReading();

    // A write that fails loses the node; nothing to tell the caller.
    void send(std::span<const std::byte> header, std::span<const std::byte> payload);
    void flush();
    void setFeed(Feed feed) { feed_ = feed; }
    [[nodiscard]] Feed feed() const { return feed_; }
    // What is queued, packets with their headers, and the queue begins anew.
    std::vector<std::vector<std::byte>> takeQueue();
    [[nodiscard]] bool queueEmpty() const;
    // Whatever its feed is; by the only thread that does.
    void sendNow(std::span<const std::byte> header, std::span<const std::byte> payload);
    void flushNow();

    [[nodiscard]] NetworkPath path() const { return connection_->path(); }
    // Its packets come another way (NodeMulticast), all but its setup.
    void setByMulticast(bool by) { byMulticast_ = by; }
    [[nodiscard]] bool byMulticast() const { return byMulticast_; }
    // It is one of all: not one that was replaced, and has not caught up.
    void setMember(bool member) { member_ = member; }
    [[nodiscard]] bool member() const { return member_; }
    // Its packets come in batches; before the first.
    void setInBatches(bool in) { inBatches_ = in; }
    [[nodiscard]] bool inBatches() const { return inBatches_; }
    // They do once it is a member.
    void setJoinsBatches(bool joins) { joinsBatches_ = joins; }
    [[nodiscard]] bool joinsBatches() const { return joinsBatches_; }

    // It joins the multicast group once it is a member.
    void setJoinsGroup(bool joins) { joinsGroup_ = joins; }
    [[nodiscard]] bool joinsGroup() const { return joinsGroup_; }

    // Ends the connection; the reader thread then reports the first reason given.
    void lose(const std::string& why);
    // Called often: loses a node that says nothing for so long. Nodes say that they are alive even while
    // they draw (nodes/node/heartbeat.hpp); one that does not is stopped or hangs.
    void watch(int64_t nowNs, int64_t patienceNs);

    [[nodiscard]] bool alive() const { return alive_.load(std::memory_order_acquire); }
    [[nodiscard]] bool saidBye() const { return saidBye_.load(std::memory_order_acquire); }
    [[nodiscard]] bool readerEnded() const { return readerEnded_.load(std::memory_order_acquire); }
    // When the node last gave or took something; now while the head itself is at work on it.
    [[nodiscard]] int64_t lastProgressNs(int64_t nowNs) const {
        return handlingSinceNs_ != 0 ? nowNs : lastMessageNs_.load();
    }
    // Of its pictures that came packed, and of what was in them.
    [[nodiscard]] int64_t pictureBytes() const { return pictureBytes_.load(std::memory_order_relaxed); }
    [[nodiscard]] int64_t pictureRawBytes() const { return pictureRawBytes_.load(std::memory_order_relaxed); }
    // Since when nothing has come from it.
    [[nodiscard]] int64_t silentNs(int64_t nowNs) const { return nowNs - std::min(nowNs, heardNs_.load()); }
    [[nodiscard]] const NodePlace& place() const { return place_; }
    [[nodiscard]] NodeProcess* process() { return process_.get(); }
    [[nodiscard]] std::string describe() const; // "node 2 (local, pid 77)"

    // Joins the reader, ends the process.
    void end();

private:
    void readMessages();
    Result<bool> readHeader(wire::MessageHeader& header);
    Result<void> readMessage(const wire::MessageHeader& header);
    Result<ByteBuffer> readBytes(size_t sizeBytes);
    template <class Header> Result<void> readStruct(Header& header);
    Result<void> readNews(uint32_t sizeBytes);
    Result<void> readAnswer(uint32_t sizeBytes);
    Result<void> readPicture(uint32_t sizeBytes);
    Result<void> readPackedPicture(uint32_t sizeBytes);
    void forgetPictures(const wire::WindowGoneMessage& gone);
    Result<void> readText(const wire::MessageHeader& header);
    Result<void> readInView(uint32_t sizeBytes);
    Result<void> readTurns(uint32_t sizeBytes);
    // A number and a list, as long as the message.
    template <class Entry> Result<void> readList(uint32_t sizeBytes, uint32_t& first, std::vector<Entry>& entries, const char* what);
    template <class Handler> Result<void> handle(Handler&& handler);
    std::string reasonOfEnd();

    const NodePlace place_;
    const std::unique_ptr<Connection> connection_;
    const std::unique_ptr<NodeProcess> process_;
    NodeEvents& events_;
    Zoom way_; // of its pictures
    std::unique_ptr<PictureUnpacker> pictures_; // null: they come as they are
    std::atomic<int64_t> pictureBytes_{0}, pictureRawBytes_{0};
    std::thread reader_;
    std::atomic<bool> alive_;
    std::atomic<bool> saidBye_{false};
    std::atomic<bool> byMulticast_{false};
    std::atomic<bool> joinsGroup_{false};
    bool member_ = true;
    bool inBatches_ = false;
    bool joinsBatches_ = false;
    std::atomic<Feed> feed_{Feed::Direct};
    mutable std::mutex queueMutex_; // what follows
    std::vector<std::vector<std::byte>> queue_;
    size_t queueBytes_ = 0;
    std::atomic<bool> readerEnded_;
    int64_t watchedNs_ = 0; // the last watch()
    int64_t excusedNs_ = 0; // silence before does not count
    std::atomic<bool> inMessage_{false};      // the reader is between a message's header and its end
    std::atomic<int64_t> heardNs_{0};         // when any message had been read
    std::atomic<int64_t> handlingSinceNs_{0}; // 0: the reader waits for the node, not the node for us
    std::atomic<int64_t> lastMessageNs_{0};   // when the last one but Alive had been handled
    std::mutex reasonMutex_;
    std::string reason_;
};

} // namespace mural
