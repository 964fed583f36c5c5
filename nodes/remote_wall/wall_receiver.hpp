// The end of a remote wall that receives pictures: listens, assembles the frames of one sender, and keeps the newest.
// A thread accepts connections; one more per connection reads.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/clock.hpp"
#include "nodes/input/input_event.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/remote_wall/frame_assembly.hpp"
#include "nodes/remote_wall/tile_canvas.hpp"
#include "nodes/remote_wall/wall_link.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::remote {

struct WallReceiverConfig {
    std::string host; // empty: all addresses
    uint16_t port = 0;
    ChannelSecret secret{};
    std::string name; // of this machine, for the sender's lines
    Want limits;      // its isWhole has no meaning
};

struct ReceivedFrame {
    uint64_t number = 0, wallFrame = 0;
    uint64_t session = 0; // of the sender
    uint64_t epoch = 0;   // of the connection
    int eyes = 0;
    std::array<OwnedPicture, kMaxEyes> pictures; // by eye
    int64_t completeNs = 0;                      // monotonic clock
};

// next(), shown() and end() belong to one thread; sendEvent() may be called from any thread.
class WallReceiver {
public:
    // Errors: the port is taken, or the address is not of this machine.
    static Result<std::unique_ptr<WallReceiver>> open(WallReceiverConfig config);
    WallReceiver(const WallReceiver&) = delete;
    WallReceiver& operator=(const WallReceiver&) = delete;
    ~WallReceiver(); // as end()

    [[nodiscard]] std::string describe() const { return listener_->describe(); }
    // Waits for a newer frame, whose memory it exchanges with that of `into`. Sends queued events meanwhile. Returns
    // false after the deadline.
    bool next(ReceivedFrame& into, Deadline deadline);
    // Acknowledges the frame, if its sender is still connected.
    void shown(const ReceivedFrame& frame);
    // Queues an event for the sender. Does not block. Without a sender it is dropped.
    void sendEvent(const input::InputEvent& event);
    // Ends all connections; the sender receives the reason.
    void end(const std::string& reason);

private:
    static constexpr size_t kMaxConnections = 32;
    static constexpr size_t kMaxEvents = 1024;

    struct Sender {
        Hello hello;                                         // of its first connection
        std::map<uint32_t, std::shared_ptr<WallLink>> links; // by source
        FrameAssembly assembly;
        TileCanvas canvas;
        explicit Sender(const Hello& first) : hello(first), assembly(first.sources), canvas(first.codec) {}
    };
    struct Visit {
        std::thread thread;
        std::atomic<bool> isOver{false};
    };

    WallReceiver(WallReceiverConfig config, std::unique_ptr<Listener> listener);
    void acceptAll();
    void serve(std::unique_ptr<Connection> connection);
    // Returns the reason against a sender; nullopt: it is accepted.
    std::optional<Bye> objectionTo(const Hello& hello) const;
    std::optional<Bye> join(const Hello& hello, const std::shared_ptr<WallLink>& link);
    Result<void> readFrom(const Hello& hello, const std::shared_ptr<WallLink>& link);
    Result<void> take(const Hello& hello, const std::shared_ptr<WallLink>& link, const Message& message);
    void leave(const Hello& hello, const std::shared_ptr<WallLink>& link);
    Result<void> showComplete();            // requires mutex_
    void sendToAll(const Message& message); // not with mutex_
    void sendEvents();
    void refuse(const std::string& why);

    const WallReceiverConfig config_;
    const std::unique_ptr<Listener> listener_;
    std::atomic<bool> stop_{false};
    std::list<Visit> visits_; // of accepting_

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::optional<Sender> sender_;
    uint64_t epoch_ = 0;
    ReceivedFrame newest_;
    bool hasNewest_ = false;
    std::deque<input::InputEvent> events_;
    int64_t refusedNs_ = 0; // the latest line about a rejected connection

    std::thread accepting_;
};

} // namespace mural::remote
