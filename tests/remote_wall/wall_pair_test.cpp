// A sender and a receiver of one process, over TCP.
#include <gtest/gtest.h>

#include <charconv>
#include <mutex>

#include "common/log/log.hpp"
#include "nodes/remote_wall/wall_receiver.hpp"
#include "nodes/remote_wall/wall_sender.hpp"
#include "tests/remote_wall/test_pictures.hpp"

namespace mural::remote {
namespace {

using testing::pictureOf;

constexpr int64_t kPatienceMs = 10'000;

ChannelSecret secretOf(uint8_t byte) {
    ChannelSecret secret;
    secret.fill(std::byte{byte});
    return secret;
}

std::unique_ptr<WallReceiver> receiverAt(uint16_t port, uint8_t secret = 1) {
    WallReceiverConfig config;
    config.host = "127.0.0.1";
    config.port = port;
    config.secret = secretOf(secret);
    config.name = "wall";
    auto opened = WallReceiver::open(config);
    EXPECT_TRUE(opened) << opened.error().message;
    return opened ? std::move(*opened) : nullptr;
}

uint16_t portOf(const WallReceiver& receiver) {
    const std::string text = receiver.describe();
    uint16_t port = 0;
    std::from_chars(text.data() + text.rfind(':') + 1, text.data() + text.size(), port);
    return port;
}

WallSenderConfig senderTo(uint16_t port, uint8_t secret = 1, uint64_t session = 1) {
    WallSenderConfig config;
    config.target.name = "test";
    config.target.host = "127.0.0.1";
    config.target.port = port;
    config.target.codec = "lz4";
    config.target.rate = 240;
    config.secret = secretOf(secret);
    config.session = session;
    return config;
}

std::shared_ptr<const OwnedPicture> shared(int step) {
    return std::make_shared<const OwnedPicture>(pictureOf(300, 200, step));
}

// Shows frames until one of this number arrives.
bool showUntil(WallReceiver& receiver, uint64_t wallFrame, ReceivedFrame& frame) {
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    while (receiver.next(frame, deadline)) {
        receiver.shown(frame);
        if (frame.wallFrame == wallFrame) return true;
    }
    return false;
}

TEST(WallPair, showsPictures) {
    const auto receiver = receiverAt(0);
    WallSender sender(senderTo(portOf(*receiver)));
    ReceivedFrame frame;
    for (const uint64_t number : {1, 2, 5}) {
        sender.offer(number, shared(static_cast<int>(number)));
        ASSERT_TRUE(showUntil(*receiver, number, frame));
        EXPECT_TRUE(comparePictures(shared(static_cast<int>(number))->view(), frame.pictures[0].view()).same());
    }
    EXPECT_TRUE(sender.finish(Deadline::inMs(kPatienceMs)));
}

TEST(WallPair, replacesOthersByTheNewestPicture) {
    const auto receiver = receiverAt(0);
    WallSender sender(senderTo(portOf(*receiver)));
    ReceivedFrame frame;
    sender.offer(1, shared(1));
    ASSERT_TRUE(showUntil(*receiver, 1, frame));
    for (uint64_t number = 2; number <= 40; ++number) sender.offer(number, shared(static_cast<int>(number % 10)));
    uint64_t shown = 0;
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    while (frame.wallFrame < 40 && receiver->next(frame, deadline)) {
        receiver->shown(frame);
        ++shown;
    }
    EXPECT_EQ(frame.wallFrame, 40U);
    EXPECT_LE(shown, 4U); // two in flight, one of them replaced, and the newest
}

TEST(WallPair, delaysNobodyForAWallThatShowsNothing) {
    const auto receiver = receiverAt(0);
    WallSender sender(senderTo(portOf(*receiver)));
    const int64_t beganNs = monotonicNowNs();
    for (uint64_t number = 1; number <= 100; ++number) sender.offer(number, shared(static_cast<int>(number % 10)));
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS); // the pictures themselves take most of it
    EXPECT_FALSE(sender.finish(Deadline::inMs(500)));
}

TEST(WallPair, returnsToARestartedWall) {
    auto receiver = receiverAt(0);
    const uint16_t port = portOf(*receiver);
    WallSender sender(senderTo(port));
    ReceivedFrame frame;
    sender.offer(1, shared(1));
    ASSERT_TRUE(showUntil(*receiver, 1, frame));
    receiver.reset();
    receiver = receiverAt(port);
    ASSERT_TRUE(receiver);
    ASSERT_TRUE(showUntil(*receiver, 1, frame)); // the same picture again
    EXPECT_TRUE(comparePictures(shared(1)->view(), frame.pictures[0].view()).same());
}

TEST(WallPair, takesTheNextSender) {
    const auto receiver = receiverAt(0);
    ReceivedFrame frame;
    {
        WallSender first(senderTo(portOf(*receiver)));
        first.offer(9, shared(1));
        ASSERT_TRUE(showUntil(*receiver, 9, frame));
    }
    WallSender second(senderTo(portOf(*receiver), 1, 2));
    second.offer(3, shared(2));
    ASSERT_TRUE(showUntil(*receiver, 3, frame));
    EXPECT_EQ(frame.session, 2U);
}

TEST(WallPair, rejectsAWrongSecret) {
    const auto receiver = receiverAt(0);
    WallSender sender(senderTo(portOf(*receiver), 2));
    sender.offer(1, shared(1));
    ReceivedFrame frame;
    EXPECT_FALSE(receiver->next(frame, Deadline::inMs(500)));
}

TEST(WallPair, sendsEventsBack) {
    const auto receiver = receiverAt(0);
    std::mutex mutex;
    std::vector<input::InputEvent> events;
    WallSenderConfig config = senderTo(portOf(*receiver));
    config.onEvent = [&](const input::InputEvent& event) {
        const std::lock_guard lock(mutex);
        events.push_back(event);
    };
    WallSender sender(std::move(config));
    ReceivedFrame frame;
    sender.offer(1, shared(1));
    ASSERT_TRUE(showUntil(*receiver, 1, frame));
    input::InputEvent event;
    event.kind = input::InputKind::Down;
    event.hasPlace = true;
    event.x = 0.5, event.y = 0.25;
    event.button = 3;
    receiver->sendEvent(event);
    const auto isThere = [&] {
        const std::lock_guard lock(mutex);
        return !events.empty();
    };
    for (const Deadline deadline = Deadline::inMs(kPatienceMs); !isThere() && !deadline.passed();)
        (void)receiver->next(frame, Deadline::inMs(10));
    ASSERT_TRUE(isThere());
    EXPECT_EQ(events[0].kind, input::InputKind::Down);
    EXPECT_EQ(events[0].button, 3);
    EXPECT_EQ(events[0].x, 0.5);
}

TEST(WallPair, reportsATakenPort) {
    const auto receiver = receiverAt(0);
    WallReceiverConfig config;
    config.host = "127.0.0.1";
    config.port = portOf(*receiver);
    const auto second = WallReceiver::open(config);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("choose another port"), std::string::npos) << second.error().message;
}

} // namespace
} // namespace mural::remote
