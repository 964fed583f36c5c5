// The application's line to the head: records of the stream out, messages of nodes in.
//
// Thread safety: any thread. A thread of its own takes the messages of nodes, so requests for objects, work items and
// barriers are answered while the application computes.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/base/clock.hpp"
#include "native/session/packet_writer.hpp"
#include "nodes/capture_link/capture_link.hpp"
#include "objects/core/message_sink.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/object_records.hpp"

namespace mural::native {

// Receives what nodes report. Called by the link's thread.
struct NodeReports {
    std::function<void(uint32_t node, std::span<const std::byte> message)> message; // about objects
    std::function<void(uint32_t node, const std::string& name)> came;
    std::function<void(uint32_t node)> lost;
    // Called about every 2 ms after messages, otherwise every 50 ms.
    std::function<void(int64_t nowNs)> tick;
};

class AppLink final : public objects::MessageSink {
public:
    static Result<std::unique_ptr<AppLink>> connect(const std::string& session, Deadline deadline);
    ~AppLink() override { stop(); }

    // Starts the link's thread, until stop(). The functions must stay valid until then.
    void start(NodeReports reports);
    void stop();
    // Makes the link's thread call tick() soon.
    void wake();

    [[nodiscard]] const capture::Welcome& welcome() const { return link_->welcome(); }
    [[nodiscard]] bool isAlive() { return !link_->headGone() && !link_->gone(0); }

    // Number of frames that all nodes have drawn.
    [[nodiscard]] uint32_t framesDone() const { return link_->framesWord().load(); }

    // Deadline of all waits until the next call. The link's thread does not wait.
    void setDeadline(Deadline deadline);

    // The records of objects. Nothing is dropped: what the nodes do not accept now is sent later.
    void toAll(std::span<const std::byte> message) override { sendObject(wire::kToAllNodes, message); }
    void toOne(objects::PeerId node, std::span<const std::byte> message) override;

    void sendWindow(const wire::WindowConfig& window);
    // Sends everything before the frame, and then the frame. Errors: the deadline; the session is over. The frame was
    // not sent then.
    Result<void> sendFrame(const wire::NativeFrame& frame, uint32_t number);
    // Sends everything so far.
    Result<void> flush();
    // Waits until the frame after this one may be sent.
    Result<void> awaitCredit(uint32_t frame);
    // Waits until all nodes have drawn this frame.
    Result<void> awaitDone(uint32_t frame);
    // Waits until the deadline, or the end of the session.
    void sleepUntil(Deadline deadline);

private:
    explicit AppLink(std::unique_ptr<CaptureLink> link) : link_(std::move(link)) {}
    void sendObject(uint16_t receivers, std::span<const std::byte> message);
    PacketWriter& writerFor(uint16_t receivers); // requires sending_
    Result<void> flushLocked();
    Result<void> send(uint16_t receivers, std::span<const std::byte> packet);
    void takeReports();
    void take(const NodeReports& reports, const wire::ReplyHeader& header, std::span<const std::byte> bytes);
    template <class Condition>
    Result<void> await(const std::atomic<uint32_t>& word, const char* what, Condition condition);

    const std::unique_ptr<CaptureLink> link_;
    std::mutex sending_;                       // guards the members below; locked after the mutexes of objects
    std::map<uint16_t, PacketWriter> writers_; // by receivers; these are independent of each other
    Deadline deadline_ = Deadline::never();

    std::thread reports_;
    NodeReports take_;
    std::atomic<std::thread::id> reporter_{};
    std::atomic<bool> isStopping_{false};
    bool hasTaken_ = false; // used by the link's thread
};

} // namespace mural::native
