#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "objects/queue/queue_master.hpp"
#include "objects/queue/queue_reader.hpp"
#include "tests/objects/recording_sink.hpp"

namespace mural::objects::test {
namespace {

std::vector<std::byte> item(unsigned value) {
    return {static_cast<std::byte>(value), static_cast<std::byte>(value >> 8)};
}
unsigned valueOf(const std::vector<std::byte>& bytes) {
    return std::to_integer<unsigned>(bytes[0]) | std::to_integer<unsigned>(bytes[1]) << 8;
}

// A queue and readers on lines with a delay.
class QueueWorld {
public:
    explicit QueueWorld(int64_t delayNs = 0) : master(fromMaster_, 1), delayNs_(delayNs) {}

    ObjectQueueReader& add(PeerId id) {
        auto& end = readers_[id];
        end = std::make_unique<End>();
        return end->reader;
    }
    void lose(PeerId id) {
        readers_.erase(id);
        master.leave(id);
    }
    ObjectQueueReader& reader(PeerId id) { return readers_.at(id)->reader; }

    // Delivers messages whose delay has passed.
    void advanceTo(int64_t nowNs) {
        nowNs_ = nowNs;
        for (bool moved = true; moved;) {
            moved = false;
            for (auto& [id, end] : readers_) {
                for (auto& sent : end->sink.take()) toMaster_.push_back({nowNs_ + delayNs_, id, std::move(sent.bytes)});
            }
            for (auto& sent : fromMaster_.take())
                toReaders_.push_back({nowNs_ + delayNs_, *sent.to, std::move(sent.bytes)});
            while (!toMaster_.empty() && toMaster_.front().atNs <= nowNs_) {
                const Message message = *decode(toMaster_.front().bytes);
                const PeerId id = toMaster_.front().peer;
                const auto* const ask = std::get_if<AskMessage>(&message);
                if (ask && readers_.contains(id)) {
                    EXPECT_TRUE(master.input(id, *ask));
                }
                const auto* const done = std::get_if<DoneMessage>(&message);
                if (done && readers_.contains(id)) {
                    EXPECT_TRUE(master.input(id, *done));
                }
                toMaster_.pop_front();
                moved = true;
            }
            while (!toReaders_.empty() && toReaders_.front().atNs <= nowNs_) {
                const Message message = *decode(toReaders_.front().bytes);
                if (const auto found = readers_.find(toReaders_.front().peer); found != readers_.end()) {
                    if (const auto* one = std::get_if<ItemMessage>(&message)) found->second->reader.input(*one, nowNs_);
                    if (const auto* end = std::get_if<ClosedMessage>(&message)) found->second->reader.input(*end);
                }
                toReaders_.pop_front();
                moved = true;
            }
        }
    }

    RecordingSink fromMaster_;
    ObjectQueueMaster master;

private:
    struct End {
        RecordingSink sink;
        ObjectQueueReader reader{sink, 1};
    };
    struct Travelling {
        int64_t atNs;
        PeerId peer;
        std::vector<std::byte> bytes;
    };
    const int64_t delayNs_;
    int64_t nowNs_ = 0;
    std::map<PeerId, std::unique_ptr<End>> readers_;
    std::deque<Travelling> toMaster_, toReaders_;
};

TEST(ObjectQueue, givesEachItemToOneReader) {
    QueueWorld world;
    world.add(1);
    world.add(2);
    for (unsigned i = 0; i < 100; ++i) ASSERT_TRUE(world.master.push(item(i)));
    world.master.close();
    std::multiset<unsigned> seen;
    for (int64_t now = 1; !world.reader(1).hasEnded() || !world.reader(2).hasEnded(); ++now) {
        ASSERT_LT(now, 1000);
        for (const PeerId id : {1U, 2U})
            if (const auto one = world.reader(id).pop(now)) seen.insert(valueOf(one->bytes));
        world.advanceTo(now);
    }
    EXPECT_EQ(seen.size(), 100U);
    EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 100U);
    EXPECT_EQ(world.master.unfinished(), 0U);
}

TEST(ObjectQueue, requestsAsManyItemsAsARoundTripTakes) {
    QueueWorld world(5'000'000);
    ObjectQueueReader& reader = world.add(1);
    for (unsigned i = 0; i < 1000; ++i) ASSERT_TRUE(world.master.push(item(i)));
    int idle = 0;
    for (int64_t now = 0; now < 300'000'000; now += 2'000'000) { // an item takes 2 ms, a round trip 10 ms
        idle += !reader.pop(now) && now > 100'000'000;
        world.advanceTo(now);
    }
    EXPECT_GE(reader.mark(), 4U);
    EXPECT_LE(reader.mark(), 7U);
    EXPECT_LE(idle, 3);
}

TEST(ObjectQueue, givesItemsOfALostReaderToOthers) {
    QueueWorld world;
    world.add(1);
    world.add(2);
    for (unsigned i = 0; i < 3; ++i) ASSERT_TRUE(world.master.push(item(i)));
    (void)world.reader(1).pop(1);
    world.advanceTo(1);
    const auto first = world.reader(1).pop(2);
    world.advanceTo(2);
    ASSERT_TRUE(first);
    world.lose(1);
    world.master.close();
    std::vector<unsigned> seen;
    for (int64_t now = 3; !world.reader(2).hasEnded(); ++now) {
        ASSERT_LT(now, 100);
        if (const auto one = world.reader(2).pop(now)) seen.push_back(valueOf(one->bytes));
        world.advanceTo(now);
    }
    EXPECT_EQ(seen, (std::vector<unsigned>{0, 1, 2}));
}

TEST(ObjectQueue, keepsAClosedQueueOpenUntilTheLastItemIsFinished) {
    QueueWorld world;
    world.add(1);
    world.add(2);
    ASSERT_TRUE(world.master.push(item(7)));
    world.master.close();
    (void)world.reader(1).pop(1);
    (void)world.reader(2).pop(1);
    world.advanceTo(1);
    ASSERT_TRUE(world.reader(1).pop(2));
    world.advanceTo(2);
    EXPECT_FALSE(world.reader(2).hasEnded());
    world.reader(1).finish(3);
    world.advanceTo(3);
    EXPECT_TRUE(world.reader(2).hasEnded());
    EXPECT_FALSE(world.master.push(item(8)));
}

TEST(ObjectQueue, dropsItemsOfOldFrames) {
    QueueWorld world;
    ObjectQueueReader& reader = world.add(1);
    for (unsigned i = 0; i < 6; ++i) ASSERT_TRUE(world.master.push(item(i), 1 + i / 2));
    (void)reader.pop(1);
    world.advanceTo(1);
    world.master.dropBefore(3);
    reader.dropBefore(3);
    std::vector<unsigned> seen;
    for (int64_t now = 2; now < 20; ++now) {
        if (const auto one = reader.pop(now)) seen.push_back(valueOf(one->bytes));
        world.advanceTo(now);
    }
    EXPECT_EQ(seen, (std::vector<unsigned>{4, 5}));
}

TEST(ObjectQueue, finishesAllItemsInRandomSchedules) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        std::mt19937_64 random(seed);
        QueueWorld world(static_cast<int64_t>(random() % 4) * 1000);
        std::set<PeerId> alive;
        PeerId next = 1;
        unsigned pushed = 0;
        std::map<PeerId, unsigned> current; // item in use
        std::set<unsigned> finished;
        for (int64_t now = 1; now < 400'000; now += 1 + static_cast<int64_t>(random() % 300)) {
            if (pushed < 200 && random() % 4 == 0) {
                ASSERT_TRUE(world.master.push(item(pushed++)));
            }
            if (alive.size() < 4 && random() % 50 == 0) world.add(*alive.insert(next++).first);
            if (alive.size() > 1 && random() % 150 == 0) {
                const PeerId lost = *alive.begin();
                current.erase(lost);
                alive.erase(lost);
                world.lose(lost);
            }
            for (const PeerId id : alive) {
                if (random() % 2) continue;
                const auto one = world.reader(id).pop(now);
                if (const auto used = current.find(id); used != current.end()) {
                    finished.insert(used->second);
                    current.erase(used);
                }
                if (one) current[id] = valueOf(one->bytes);
            }
            world.advanceTo(now);
        }
        for (int64_t now = 400'000; now < 2'000'000 && finished.size() < pushed; now += 5000) {
            if (alive.empty()) world.add(*alive.insert(next++).first);
            for (const PeerId id : alive) {
                const auto one = world.reader(id).pop(now);
                if (const auto used = current.find(id); used != current.end()) {
                    finished.insert(used->second);
                    current.erase(used);
                }
                if (one) current[id] = valueOf(one->bytes);
            }
            world.advanceTo(now);
        }
        EXPECT_EQ(finished.size(), pushed) << "seed " << seed;
    }
}

TEST(ObjectQueue, refusesForeignReports) {
    QueueWorld world;
    ASSERT_TRUE(world.master.push(item(1)));
    EXPECT_FALSE(world.master.input(1, DoneMessage{1, 1}));
    EXPECT_TRUE(world.master.input(1, AskMessage{1, 1}));
    EXPECT_FALSE(world.master.input(2, DoneMessage{1, 1}));
    EXPECT_TRUE(world.master.input(1, DoneMessage{1, 1}));
    EXPECT_FALSE(world.master.input(1, AskMessage{1, 100'000}));
}

} // namespace
} // namespace mural::objects::test
