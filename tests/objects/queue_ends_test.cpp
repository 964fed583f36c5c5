#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <set>
#include <thread>

#include <mural/objects.hpp>

#include "objects/ends/barrier_ends.hpp"
#include "objects/ends/queue_ends.hpp"
#include "tests/objects/test_types.hpp"

namespace mural::objects::test {
namespace {

// Passes each message on at once. A queue or barrier may be called while another one holds its lock, so the messages
// are delivered by a thread.
class DeliveryThread {
public:
    ~DeliveryThread() {
        isEnding_ = true;
        thread_.join();
    }
    void post(std::function<void()> delivery) {
        const std::lock_guard lock(mutex_);
        deliveries_.push_back(std::move(delivery));
    }

private:
    void run() {
        while (!isEnding_) {
            std::vector<std::function<void()>> deliveries;
            {
                const std::lock_guard lock(mutex_);
                deliveries.swap(deliveries_);
            }
            for (const auto& delivery : deliveries) delivery();
            if (deliveries.empty()) std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
    }
    std::mutex mutex_;
    std::vector<std::function<void()>> deliveries_;
    std::atomic<bool> isEnding_ = false;
    std::thread thread_{[this] { run(); }};
};

class PostingSink : public MessageSink {
public:
    using Receive = std::function<void(PeerId, std::span<const std::byte>)>;
    PostingSink(DeliveryThread& thread, Receive receive) : thread_(thread), receive_(std::move(receive)) {}
    void toAll(std::span<const std::byte> message) override { toOne(0, message); }
    void toOne(PeerId peer, std::span<const std::byte> message) override {
        thread_.post([this, peer, bytes = std::vector(message.begin(), message.end())] { receive_(peer, bytes); });
    }

private:
    DeliveryThread& thread_;
    Receive receive_;
};

TEST(QueueEnds, distributeTypedItemsToThreads) {
    constexpr size_t kReaders = 3;
    std::vector<std::unique_ptr<QueueLine>> lines;
    std::unique_ptr<QueueHub> hub;
    std::vector<std::unique_ptr<PostingSink>> sinks;
    DeliveryThread delivery;
    PostingSink toReaders(
        delivery, [&](PeerId peer, auto message) { EXPECT_TRUE(lines[peer - 1]->input(message, monotonicNowNs())); });
    hub = std::make_unique<QueueHub>(toReaders);
    for (PeerId peer = 1; peer <= kReaders; ++peer) {
        sinks.push_back(std::make_unique<PostingSink>(
            delivery, [&hub, peer](PeerId, auto message) { EXPECT_TRUE(hub->input(peer, message)); }));
        lines.push_back(std::make_unique<QueueLine>(*sinks.back()));
    }
    auto queue = hub->open<mural::test::Material>("tiles");
    std::mutex mutex;
    std::multiset<std::string> seen;
    std::vector<std::thread> threads;
    for (auto& line : lines)
        threads.emplace_back([&] {
            auto reader = line->open<mural::test::Material>("tiles");
            for (;;) {
                const auto item = reader.pop();
                ASSERT_TRUE(item) << item.error().message;
                if (!item.value()) return;
                const std::lock_guard lock(mutex);
                seen.insert(item.value()->name);
            }
        });
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(queue.push({std::to_string(i), {}}));
    queue.close();
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(seen.size(), 60U);
    EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 60U);
    EXPECT_FALSE(queue.push({}));
}

TEST(QueueEnds, refuseItemsOfAnotherType) {
    std::unique_ptr<QueueLine> line;
    std::unique_ptr<QueueHub> hub;
    DeliveryThread delivery;
    PostingSink toReader(delivery, [&](PeerId, auto message) { EXPECT_TRUE(line->input(message, 0)); });
    PostingSink toHub(delivery, [&](PeerId, auto message) { EXPECT_TRUE(hub->input(1, message)); });
    hub = std::make_unique<QueueHub>(toReader);
    line = std::make_unique<QueueLine>(toHub);
    auto queue = hub->open<int32_t>("tiles");
    ASSERT_TRUE(queue.push(5));
    auto reader = line->open<float>("tiles");
    const auto item = reader.pop();
    ASSERT_FALSE(item);
    EXPECT_NE(item.error().message.find("queue \"tiles\" as float"), std::string::npos) << item.error().message;
    const auto late = reader.pop(Deadline::inMs(1));
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().message.find("within the deadline"), std::string::npos);
}

// Two processes that enter barriers, and their leader.
struct BarrierEndsWorld {
    std::vector<std::unique_ptr<BarrierLine>> lines;
    std::unique_ptr<BarrierHub> hub;
    std::vector<std::unique_ptr<PostingSink>> sinks;
    DeliveryThread delivery;
    PostingSink toMembers{delivery,
                          [this](PeerId peer, auto message) { EXPECT_TRUE(lines[peer - 1]->input(message)); }};
    std::atomic<bool> isEnding = false;
    std::thread clock;

    BarrierEndsWorld() {
        hub = std::make_unique<BarrierHub>(toMembers);
        for (PeerId peer = 1; peer <= 2; ++peer) {
            hub->join(peer, peer == 1 ? "left" : "right");
            sinks.push_back(std::make_unique<PostingSink>(delivery, [this, peer](PeerId, auto message) {
                EXPECT_TRUE(hub->input(peer, message, monotonicNowNs()));
            }));
            lines.push_back(std::make_unique<BarrierLine>(*sinks.back()));
        }
    }
    ~BarrierEndsWorld() {
        isEnding = true;
        if (clock.joinable()) clock.join();
    }
    void startClock() {
        clock = std::thread([this] {
            while (!isEnding) {
                hub->tick(monotonicNowNs());
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        });
    }
};

TEST(BarrierEnds, releaseThreadsTogetherAndNameTheMissing) {
    BarrierEndsWorld world;
    auto& lines = world.lines;
    std::atomic<int> inside = 0;
    const auto pass = [&](size_t member) {
        Barrier barrier = lines[member]->open("start");
        for (int round = 1; round <= 20; ++round) {
            ++inside;
            const auto entered = barrier.enter();
            ASSERT_TRUE(entered) << entered.error().message;
            EXPECT_EQ(entered.value(), 2U);
            EXPECT_GE(inside, 2 * round);
        }
    };
    std::thread other([&] { pass(1); });
    pass(0);
    other.join();
    world.startClock();
    Barrier barrier = lines[0]->open("start");
    const auto late = barrier.enter(Deadline::inMs(10));
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().message.find("right did not enter"), std::string::npos) << late.error().message;
    world.hub->leave(2);
    EXPECT_EQ(barrier.enter().value(), 1U);
    lines[0]->close();
    EXPECT_FALSE(barrier.enter());
}

TEST(BarrierEnds, enterTheSameRoundOfAFrameAgain) {
    BarrierEndsWorld world;
    world.startClock();
    for (auto& line : world.lines) line->countByFrames([] { return uint64_t{7}; });
    Barrier left = world.lines[0]->open("start");
    Barrier right = world.lines[1]->open("start");
    ASSERT_FALSE(left.enter(Deadline::inMs(10)));
    std::thread other([&] {
        const auto passed = right.enter(Deadline::inMs(20'000));
        EXPECT_TRUE(passed && passed.value() == 2U);
    });
    const auto again = left.enter(Deadline::inMs(20'000));
    other.join();
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again.value(), 2U);
}

} // namespace
} // namespace mural::objects::test
