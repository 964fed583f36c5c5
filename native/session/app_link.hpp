// The application's line to the head: records of the stream out, messages of nodes in. Used by the application's
// thread.
#pragma once

#include <memory>
#include <string>

#include "common/base/clock.hpp"
#include "native/session/packet_writer.hpp"
#include "nodes/capture_link/capture_link.hpp"
#include "objects/core/message_sink.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/object_records.hpp"

namespace mural::native {

class AppLink final : public objects::MessageSink {
public:
    // Receives the messages of nodes about objects.
    using TakeRequest = std::function<void(uint32_t node, std::span<const std::byte> message)>;
    static Result<std::unique_ptr<AppLink>> connect(const std::string& session, TakeRequest takeRequest,
                                                    Deadline deadline);

    [[nodiscard]] const capture::Welcome& welcome() const { return link_->welcome(); }
    [[nodiscard]] bool isAlive() { return !link_->headGone() && !link_->gone(0); }

    // Number of frames that all nodes have drawn.
    [[nodiscard]] uint32_t framesDone() const { return link_->framesWord().load(); }

    // Deadline of all waits until the next call.
    void setDeadline(Deadline deadline) { deadline_ = deadline; }

    // Called whenever messages of nodes were taken.
    void onServed(std::function<void()> served) { served_ = std::move(served); }

    // The records of objects. Nothing is dropped: what the nodes do not accept now is sent later.
    void toAll(std::span<const std::byte> message) override { sendObject(wire::kAllNodes, message); }
    void toOne(objects::PeerId node, std::span<const std::byte> message) override { sendObject(node, message); }

    void sendWindow(const wire::WindowConfig& window);
    // Sends everything before the frame, and then the frame. Errors: the deadline; the session is over. The frame was
    // not sent then.
    Result<void> sendFrame(const wire::NativeFrame& frame, uint32_t number);
    // Sends everything so far.
    Result<void> flush();
    // Waits until the frame after this one may be sent. Serves requests meanwhile.
    Result<void> awaitCredit(uint32_t frame);
    // Waits until all nodes have drawn this frame. Serves requests meanwhile.
    Result<void> awaitDone(uint32_t frame);
    // Serves requests until the deadline.
    void serveUntil(Deadline deadline);

private:
    explicit AppLink(std::unique_ptr<CaptureLink> link);
    void sendObject(uint32_t node, std::span<const std::byte> message);
    Result<void> send(std::span<const std::byte> packet);
    void serve();
    template <class Condition>
    Result<void> await(const std::atomic<uint32_t>& word, const char* what, Condition condition);

    std::unique_ptr<CaptureLink> link_;
    PacketWriter writer_;
    Deadline deadline_ = Deadline::never();
    std::function<void()> served_;
};

} // namespace mural::native
