// Sends the pictures of a session to one remote wall. A thread of its own connects, encodes and sends; a second one
// reads the wall's replies while there is a connection. A slow or absent wall delays nobody: the newest picture
// replaces the one that waits.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "nodes/input/input_event.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/remote_wall/retry_times.hpp"
#include "nodes/remote_wall/send_window.hpp"
#include "nodes/remote_wall/tile_encoder.hpp"
#include "nodes/remote_wall/wall_link.hpp"
#include "nodes/remote_wall/wall_target.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::remote {

struct WallSenderConfig {
    WallTarget target;
    ChannelSecret secret{};
    uint64_t session = 0;  // differs between sessions
    bool hasPairs = false; // pictures contain both eyes (stackEyes)
    // Takes an event of the wall's windows; called by the reading thread. Empty: events are dropped.
    std::function<void(const input::InputEvent& event)> onEvent;
    // The wall is gone; it may have held keys. May be empty.
    std::function<void()> onGone;
};

class WallSender {
public:
    explicit WallSender(WallSenderConfig config);
    WallSender(const WallSender&) = delete;
    WallSender& operator=(const WallSender&) = delete;
    ~WallSender(); // as end()

    // Offers the latest picture. Frames increase. Does not block; any thread.
    void offer(uint64_t frame, std::shared_ptr<const OwnedPicture> picture);
    // Waits until a connected wall has shown the latest picture. Returns false after the deadline.
    bool finish(Deadline deadline);
    // Requests the end. Later offers have no effect. Does not block.
    void requestEnd();
    // Ends connection and threads. A running attempt to connect may take some seconds.
    void end();
    [[nodiscard]] const WallTarget& target() const { return config_.target; }

private:
    struct Offered {
        uint64_t frame = 0;
        std::shared_ptr<const OwnedPicture> picture; // null: none
    };
    struct Failure {
        std::string reason;
        bool isFinal = false; // further attempts would end in the same way
    };
    struct Connected {
        std::unique_ptr<WallLink> link;
        Hello wall;
    };

    void run();
    std::optional<Connected> connect(Failure& failure);
    // Sends pictures until the connection ends, and returns the reason.
    Failure serve(Connected& connected);
    void read(WallLink& link);
    Result<void> take(const Message& message);
    Result<void> sendFrame(WallLink& link, TileEncoder& encoder, uint64_t number, const Offered& offered);
    std::vector<Picture> eyesOf(const OwnedPicture& picture);
    Picture reduced(const Picture& picture, OwnedPicture& memory) const;
    void report(const Failure& failure, int64_t nowNs);
    [[nodiscard]] std::string place() const;
    void endReading(Failure failure);
    [[nodiscard]] bool isStopping();

    const WallSenderConfig config_;
    RetryTimes retry_;                               // of thread_
    OwnedPicture eightBits_;                         // of thread_
    std::array<OwnedPicture, kMaxEyes> reducedEyes_; // of thread_
    Want limits_;                                    // of thread_: copy of want_

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    Offered latest_;
    uint64_t sentFrame_ = 0;  // of the session; 0: none on this connection
    uint64_t sentNumber_ = 0; // of the connection's frames
    bool isSending_ = false;
    SendWindow window_;
    Want want_;
    std::optional<SendWindow::Transfer> transfer_; // not yet reported to the encoder
    std::optional<Failure> ended_;                 // the reading thread has ended
    WallLink* link_ = nullptr;                     // null: no connection
    bool isConnected_ = false, hasShown_ = false;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural::remote
