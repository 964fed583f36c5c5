// The thread that sends pictures: messages sent, their order, and waits.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>

#include "nodes/frame_transfer/picture_sender.hpp"
#include "nodes/frame_transfer/picture_unpacker.hpp"
#include "nodes/frame_transfer/transfer_scale.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

using wire::NodeMessage;

constexpr int32_t kWidth = 70, kHeight = 40;
constexpr std::chrono::seconds kPatience{20};

// A gate that the test opens.
class Gate {
public:
    void open() {
        const std::lock_guard lock(mutex_);
        open_ = true;
        changed_.notify_all();
    }
    bool pass() {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, kPatience, [this] { return open_; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool open_ = false;
};

// Checks that `give` returns after the gate opens, and not earlier.
template <class Give> void waitsFor(Gate& gate, Give&& give) {
    std::atomic<bool> taken{false};
    std::thread giver([&] {
        EXPECT_TRUE(give());
        taken = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(taken);
    gate.open();
    giver.join();
}

std::vector<std::byte> rows(uint32_t frame) {
    std::vector<std::byte> all(size_t{kWidth} * kHeight * 4);
    for (size_t i = 0; i < all.size(); ++i)
        all[i] = static_cast<std::byte>(i % 4 == 3 ? 255 : (i / 4 + frame * 31) & 255);
    return all;
}

class TestPicture final : public PictureRead {
public:
    TestPicture(std::vector<std::byte> bytes, Gate* gate) : bytes_(std::move(bytes)), gate_(gate) {}
    Result<std::span<const std::byte>> bytes(Deadline) override {
        if (gate_) {
            EXPECT_TRUE(gate_->pass());
        }
        if (bytes_.empty()) return Error{"the card has gone"};
        return std::span<const std::byte>(bytes_);
    }

private:
    std::vector<std::byte> bytes_;
    Gate* gate_;
};

struct Sent {
    NodeMessage type;
    std::vector<std::byte> bytes;
    std::thread::id by;
    template <class T> T as() const {
        T value{};
        if (bytes.size() >= sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
        return value;
    }
};

class PictureSenderTest : public ::testing::Test {
protected:
    void start(PictureSenderConfig config = {}) {
        sender_ = std::make_unique<PictureSender>(
            std::move(config), [this](NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
                Sent one{type, {a.begin(), a.end()}, std::this_thread::get_id()};
                one.bytes.insert(one.bytes.end(), b.begin(), b.end());
                const std::lock_guard lock(mutex_);
                sent_.push_back(std::move(one));
            });
    }
    bool frame(uint32_t number, Gate* gate = nullptr, uint32_t window = 1, bool lost = false) {
        PictureSender::Frame f;
        f.header = {1, window, number, 0, 0, kWidth, kHeight, kWidth, kHeight, 0, 0};
        f.picture = std::make_unique<TestPicture>(lost ? std::vector<std::byte>() : rows(number), gate);
        f.done.client = 1;
        f.done.window = window;
        f.done.frame = number;
        f.done.busyNs = 5;
        return sender_->send(std::move(f));
    }
    bool enqueue(uint32_t number) {
        return sender_->enqueue(NodeMessage::ReplyPart, std::as_bytes(std::span(&number, 1)));
    }
    std::vector<NodeMessage> types() {
        const std::lock_guard lock(mutex_);
        std::vector<NodeMessage> all;
        for (const Sent& s : sent_) all.push_back(s.type);
        return all;
    }

    std::mutex mutex_;
    std::vector<Sent> sent_;
    RecordedLog log_;
    Gate gate_; // pictures wait here; the sender exists until all have passed
    std::unique_ptr<PictureSender> sender_;
};

TEST_F(PictureSenderTest, sendsPicturesUnchangedFollowedByTheirFrames) {
    start();
    for (uint32_t i = 1; i <= 5; ++i) ASSERT_TRUE(frame(i));
    ASSERT_TRUE(sender_->finish());
    ASSERT_EQ(sent_.size(), 10u);
    for (uint32_t i = 1; i <= 5; ++i) {
        const Sent& picture = sent_[2 * i - 2];
        const Sent& done = sent_[2 * i - 1];
        ASSERT_EQ(picture.type, NodeMessage::Picture);
        EXPECT_EQ(picture.as<wire::PictureHeader>().frame, i);
        const auto wanted = rows(i);
        ASSERT_EQ(picture.bytes.size(), sizeof(wire::PictureHeader) + wanted.size());
        EXPECT_EQ(std::memcmp(picture.bytes.data() + sizeof(wire::PictureHeader), wanted.data(), wanted.size()), 0);
        ASSERT_EQ(done.type, NodeMessage::FrameDone);
        EXPECT_EQ(done.as<wire::FrameDoneMessage>().frame, i);
        EXPECT_NE(done.by, std::this_thread::get_id());
        EXPECT_GT(done.as<wire::FrameDoneMessage>().readbackNs, 0u);
    }
}

TEST_F(PictureSenderTest, keepsTheOrderOfMessages) {
    start();
    ASSERT_TRUE(enqueue(1));
    EXPECT_EQ(sent_.back().by, std::this_thread::get_id()); // sent without waking the thread, because none was queued
    ASSERT_TRUE(frame(1, &gate_));
    ASSERT_TRUE(enqueue(2));
    ASSERT_TRUE(frame(2));
    ASSERT_TRUE(enqueue(3));
    EXPECT_EQ(types(), (std::vector{NodeMessage::ReplyPart})); // everything else waits for the first picture
    gate_.open();
    ASSERT_TRUE(sender_->finish());
    EXPECT_EQ(types(),
              (std::vector{NodeMessage::ReplyPart, NodeMessage::Picture, NodeMessage::FrameDone, NodeMessage::ReplyPart,
                           NodeMessage::Picture, NodeMessage::FrameDone, NodeMessage::ReplyPart}));
    EXPECT_EQ(sent_[3].as<uint32_t>(), 2u);
    EXPECT_EQ(sent_[6].as<uint32_t>(), 3u);
    ASSERT_TRUE(enqueue(4));
    EXPECT_EQ(sent_.back().as<uint32_t>(), 4u); // sent immediately again
}

TEST_F(PictureSenderTest, blocksAThirdPictureUntilThereIsRoom) {
    start();
    ASSERT_TRUE(frame(1, &gate_));
    ASSERT_TRUE(frame(2));
    waitsFor(gate_, [&] { return frame(3); });
    ASSERT_TRUE(sender_->finish());
    EXPECT_EQ(types().size(), 6u);
}

TEST_F(PictureSenderTest, limitsMessagesQueuedAfterAPicture) {
    PictureSenderConfig config;
    config.maxBytes = 6000;
    start(config);
    ASSERT_TRUE(frame(1, &gate_));
    const std::vector<std::byte> large(4000);
    ASSERT_TRUE(sender_->enqueue(NodeMessage::ReplyPart, large));
    waitsFor(gate_, [&] { return sender_->enqueue(NodeMessage::ReplyPart, large); }); // 8000 bytes would be queued
    ASSERT_TRUE(
        sender_->enqueue(NodeMessage::ReplyPart, std::vector<std::byte>(9000))); // above the limit: accepted alone
    ASSERT_TRUE(sender_->finish());
    EXPECT_EQ(types().size(), 5u);
}

TEST_F(PictureSenderTest, sendsNothingAfterAFailedSend) {
    PictureSenderConfig config;
    config.roomMs = 50;
    start(config);
    ASSERT_TRUE(frame(1, &gate_));
    ASSERT_TRUE(frame(2));
    EXPECT_FALSE(frame(3));
    EXPECT_FALSE(frame(4)); // fails immediately, without another wait
    EXPECT_FALSE(enqueue(1));
    EXPECT_FALSE(sender_->finish());
    ASSERT_EQ(log_.texts().size(), 1u) << log_.text();
    EXPECT_NE(log_.text().find("no picture could be sent"), std::string::npos) << log_.text();
    gate_.open();
}

TEST_F(PictureSenderTest, sendsQueuedMessagesAtTheEnd) {
    start();
    ASSERT_TRUE(frame(1, &gate_));
    ASSERT_TRUE(frame(2));
    ASSERT_TRUE(enqueue(9));
    std::thread opener([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        gate_.open();
    });
    sender_.reset();
    opener.join();
    EXPECT_EQ(types().size(), 5u);
    EXPECT_EQ(sent_.back().as<uint32_t>(), 9u);
}

TEST_F(PictureSenderTest, sendsALostPictureAsBlackAndReportsItOnce) {
    start();
    ASSERT_TRUE(frame(1, nullptr, 1, true));
    ASSERT_TRUE(frame(2, nullptr, 1, true));
    ASSERT_TRUE(frame(3));
    ASSERT_TRUE(sender_->finish());
    ASSERT_EQ(sent_.size(), 6u);
    const std::vector<std::byte> black(size_t{kWidth} * kHeight * 4);
    ASSERT_EQ(sent_[0].bytes.size(), sizeof(wire::PictureHeader) + black.size());
    EXPECT_EQ(std::memcmp(sent_[0].bytes.data() + sizeof(wire::PictureHeader), black.data(), black.size()), 0);
    ASSERT_EQ(log_.texts().size(), 1u) << log_.text();
    EXPECT_NE(log_.text().find("the card has gone"), std::string::npos) << log_.text();
}

// Closed windows are forgotten in message order: the receiver does so at the message that follows.
TEST_F(PictureSenderTest, restoresPackedPicturesAcrossClosedWindows) {
    PictureSenderConfig config;
    config.codec = "bitplane";
    start(config);
    std::vector<uint32_t> windows;
    for (uint32_t i = 1; i <= 40; ++i) {
        windows.push_back(1 + i % 3);
        ASSERT_TRUE(frame(i, nullptr, windows.back()));
        if (i % 5 != 0) continue;
        const wire::WindowGoneMessage gone{1, i % 15 == 0 ? wire::kAllWindows : windows.back()};
        if (i % 15 == 0)
            sender_->clientGone(1);
        else
            sender_->windowGone(1, windows.back());
        ASSERT_TRUE(sender_->enqueue(NodeMessage::WindowGone, std::as_bytes(std::span(&gone, 1))));
    }
    ASSERT_TRUE(sender_->finish());
    PictureUnpacker unpacker("bitplane");
    uint32_t pictures = 0;
    for (const Sent& s : sent_) {
        if (s.type == NodeMessage::WindowGone) {
            const auto gone = s.as<wire::WindowGoneMessage>();
            if (gone.window == wire::kAllWindows)
                unpacker.clientGone(1);
            else
                unpacker.windowGone(1, gone.window);
        }
        if (s.type != NodeMessage::PackedPicture) continue;
        const auto header = s.as<wire::PictureHeader>();
        std::vector<std::byte> got(rows(0).size());
        const auto done =
            unpacker.unpack(1, header.window, header.w, header.h, std::span(s.bytes).subspan(sizeof header), got);
        ASSERT_TRUE(done) << header.frame << ": " << done.error().message;
        EXPECT_EQ(got, rows(header.frame)) << header.frame;
        ++pictures;
    }
    EXPECT_EQ(pictures, 40u);
    EXPECT_EQ(sender_->rawBytes(), 40 * rows(0).size());
    EXPECT_LT(sender_->packedBytes(), sender_->rawBytes());
}

TEST_F(PictureSenderTest, sendsSmallerPicturesOnANarrowLink) {
    PictureSenderConfig config;
    config.transferScale = {0.5, 0.25};
    start(config);
    ASSERT_TRUE(frame(1));
    ASSERT_TRUE(sender_->finish());
    const ScaledSize size = scaledSizeOf(kWidth, kHeight, config.transferScale);
    std::vector<std::byte> wanted(size.bytes());
    resizePicture(rows(1).data(), kWidth, kHeight, wanted.data(), size.w, size.h);
    ASSERT_EQ(sent_[0].bytes.size(), sizeof(wire::PictureHeader) + wanted.size());
    EXPECT_EQ(std::memcmp(sent_[0].bytes.data() + sizeof(wire::PictureHeader), wanted.data(), wanted.size()), 0);
    EXPECT_EQ(sent_[0].as<wire::PictureHeader>().w, kWidth); // the size shown
}

TEST_F(PictureSenderTest, addsWorkOrTakesTheLonger) {
    for (const bool adds : {true, false}) {
        PictureSenderConfig config;
        config.codec = "zstd";
        config.addsCpu = adds;
        sent_.clear();
        start(config);
        ASSERT_TRUE(frame(1));
        ASSERT_TRUE(sender_->finish());
        EXPECT_GT(sender_->cpuNs(), 0);
        EXPECT_GT(sent_.back().as<wire::FrameDoneMessage>().busyNs, 5u);
    }
}

} // namespace
} // namespace mural
