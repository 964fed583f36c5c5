// Waits for pictures, packs and sends them by a thread of its own, so that the next frame is drawn meanwhile. What else a node tells the head keeps its place among them.
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

#include "common/zoom.hpp"
#include "nodes/pictures/picture_packer.hpp"
#include "nodes/pictures/picture_read.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

struct PictureSenderConfig {
    std::string codec = "raw"; // as of PlaneEncoder; raw: pictures go as they are
    PictureAlpha alpha = PictureAlpha::Kept;
    Zoom way;                  // they go smaller by this (picture_way.hpp)
    bool addsCpu = false;      // what a picture takes here is added to its frame's work: nodes share cores. Else the longer one counts, for both go on at once
    size_t mostBytes = size_t{64} << 20; // of messages behind pictures
    int64_t readMs = 60'000;   // until GL has drawn a picture
    int64_t roomMs = 120'000;  // until there is room for another, without the time of sending: longer than a picture may take to be read
};

// All calls from one thread.
class PictureSender {
public:
    // One message of up to two parts; called by either thread, one at a time. It lasts as long as the head takes nothing, and ends with it.
    using Send = std::function<void(wire::NodeMessage, std::span<const std::byte>, std::span<const std::byte>)>;
    using Log = std::function<void(const std::string&)>;
    struct Frame {
        wire::PictureHeader header{};
        std::unique_ptr<PictureRead> picture;
        wire::FrameDoneMessage done{}; // sent behind it; time that reading and packing take is added here
    };

    PictureSender(PictureSenderConfig config, Send send, Log log);
    // What was given still goes out.
    ~PictureSender();
    PictureSender(const PictureSender&) = delete;
    PictureSender& operator=(const PictureSender&) = delete;

    // Waits while two others are on their way. False: nothing goes out any more.
    bool send(Frame frame);
    // Behind all that was given; by the calling thread where nothing is under way.
    bool tell(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b = {});
    // Of pictures that come later: nothing builds on those of this window, or of this program's.
    void windowGone(uint32_t client, uint32_t window);
    void clientGone(uint32_t client);
    // Until all has gone out. False: it did not, in time.
    bool finish();

    // CPU time of the thread so far.
    [[nodiscard]] int64_t cpuNs() const;
    // Of all packed pictures; after finish().
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
        std::optional<uint32_t> window; // nothing: all of them
    };
    struct Job { // one of them
        std::optional<Frame> frame;
        std::optional<Message> message;
        std::optional<Forgotten> forgotten;
    };

    void run();
    void work(Job& job);
    void sendFrame(Frame& frame);
    void forget(const Forgotten& forgotten);
    void send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b); // by the thread
    bool give(Job job, size_t bytes, bool isFrame);
    template <class Condition> bool await(std::unique_lock<std::mutex>& lock, Condition condition);
    [[nodiscard]] bool idle() const { return jobs_.empty() && !working_; } // mutex_ is held

    const PictureSenderConfig config_;
    const Send send_;
    const Log log_;
    const std::unique_ptr<PicturePacker> packer_; // null: pictures go as they are. Used by whoever works
    std::vector<std::byte> black_, onWay_;
    bool saidLost_ = false;
    std::atomic<bool> sending_{false}; // the thread is in send_

    std::mutex mutex_; // of all below
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    size_t frames_ = 0, waitingBytes_ = 0; // given and not done: frames; bytes of messages
    bool working_ = false, stop_ = false, stuck_ = false;
    std::thread thread_;
    clockid_t clock_{};
};

} // namespace mural
