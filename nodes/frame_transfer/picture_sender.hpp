// Waits for pictures, encodes and sends them on its own thread, while the node draws the next frame. Other messages of
// the node keep their order relative to pictures.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/geometry/zoom.hpp"
#include "nodes/frame_spans/thread_spans.hpp"
#include "nodes/frame_transfer/picture_packer.hpp"
#include "nodes/frame_transfer/picture_read.hpp"
#include "nodes/frame_transfer/transfer_scale.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

struct PictureSenderConfig {
    std::string codec = "raw"; // a name for PlaneEncoder; raw: no encoding
    PictureAlpha alpha = PictureAlpha::Preserved;
    Zoom transferScale; // reduction for the transfer (transfer_scale.hpp)
    // nodes share cores: adds this thread's CPU time to the frame's work. Otherwise the longer of the two counts,
    // because both run in parallel
    bool addsCpu = false;
    size_t maxBytes = size_t{64} << 20; // limit of messages queued after pictures
    int64_t readMs = 60'000;            // limit for GL to complete a picture
    int64_t roomMs = 120'000;           // limit of the wait for queue space, without sending time; must exceed readMs
};

// Thread safety: all calls must come from one thread.
class PictureSender {
public:
    // Sends one message of up to two parts. Called by the caller's thread or the sender's, never by both at a time.
    // Blocks while the head reads nothing, and returns when the head ends.
    using Send = std::function<void(wire::NodeMessage, std::span<const std::byte>, std::span<const std::byte>)>;
    struct Frame {
        wire::PictureHeader header{};
        std::unique_ptr<PictureRead> picture;
        wire::FrameDoneMessage done{}; // sent after the picture; the sender adds the time of readback and encoding
        // of the replay thread, sent before `done`; the sender adds its own. Empty: no statistics
        std::vector<wire::FrameSpan> spans = {};
    };

    PictureSender(PictureSenderConfig config, Send send);
    // Completes all queued jobs.
    ~PictureSender();
    PictureSender(const PictureSender&) = delete;
    PictureSender& operator=(const PictureSender&) = delete;

    // Queues a frame. Waits while two others are queued or in work. Returns false if sending has failed.
    bool send(Frame frame);
    // Sends a message after all queued jobs. The calling thread sends it if the sender is idle.
    bool enqueue(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    // Forgets the last pictures of the window, or of all windows of the client. Later pictures do not refer to them.
    void windowGone(uint32_t client, uint32_t window);
    void clientGone(uint32_t client);
    // Waits until all jobs are sent. Returns false after roomMs without progress, or if sending has failed.
    bool finish();

    // Returns the CPU time of the sender's thread.
    [[nodiscard]] int64_t cpuNs() const;
    // Size of all encoded pictures before encoding. Requires finish().
    [[nodiscard]] uint64_t rawBytes() const { return packer_ ? packer_->rawBytes() : 0; }
    [[nodiscard]] uint64_t packedBytes() const { return packer_ ? packer_->packedBytes() : 0; }
    [[nodiscard]] bool packs() const { return packer_ != nullptr; }

private:
    struct Message {
        wire::NodeMessage type;
        std::vector<std::byte> bytes;
    };
    struct Forgotten {
        uint32_t client;
        std::optional<uint32_t> window; // nullopt: all windows
    };
    struct Job { // exactly one member is set
        std::optional<Frame> frame;
        std::optional<Message> message;
        std::optional<Forgotten> forgotten;
    };

    void run();
    void work(Job& job);
    void sendFrame(Frame& frame);
    void sendPicture(const wire::PictureHeader& header, const ScaledSize& size, std::span<const std::byte> pixels,
                     int64_t& packedNs);
    [[nodiscard]] Result<std::span<const std::byte>> bytesOf(PictureRead& picture) const;
    void sendSpans(Frame& frame);
    void forget(const Forgotten& forgotten);
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b); // called by thread_
    bool give(Job job, size_t bytes, bool isFrame);
    template <class Condition> bool await(std::unique_lock<std::mutex>& lock, Condition condition);
    [[nodiscard]] bool idle() const { return jobs_.empty() && !working_; } // requires mutex_

    const PictureSenderConfig config_;
    const Send send_;
    const std::unique_ptr<PicturePacker> packer_; // null: no encoding; used by thread_
    std::vector<std::byte> black_, inTransfer_;
    ThreadSpans spans_; // of thread_, while statistics are on
    bool lossReported_ = false;
    std::atomic<bool> sending_{false}; // thread_ is in send_

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    size_t frames_ = 0, waitingBytes_ = 0; // frames, and bytes of messages, that are queued or in work
    bool working_ = false, stop_ = false, stuck_ = false;
    std::thread thread_;
    clockid_t clock_{};
};

} // namespace mural
