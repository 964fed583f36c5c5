// The byte ring: wrap-around, sleeping ends, invalid positions.
#include "transport/shm/byte_ring.hpp"

#include <array>
#include <atomic>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "tests/transport/linked_pair.hpp"

namespace mural::test {

namespace {

struct Ring {
    explicit Ring(size_t capacityBytes)
        : bytes(capacityBytes),
          writer(control, bytes.data(), capacityBytes),
          reader(control, bytes.data(), capacityBytes) {}
    RingControl control{};
    std::vector<std::byte> bytes;
    RingWriter writer;
    RingReader reader;
};

} // namespace

TEST(ByteRing, acceptsNoMoreThanItsCapacity) {
    Ring ring(64);
    const std::vector<std::byte> bytes(100, std::byte{7});
    EXPECT_EQ(ring.writer.write(bytes), 64U);
    EXPECT_FALSE(ring.writer.hasRoom());
    EXPECT_EQ(ring.writer.write(bytes), 0U);
    std::array<std::byte, 10> some{};
    EXPECT_EQ(ring.reader.read(some), 10U);
    EXPECT_EQ(ring.writer.write(bytes), 10U);
}

TEST(ByteRing, preservesBytesOverManyWraps) {
    for (const size_t capacityBytes : {64U, 128U, 4096U}) {
        Ring ring(capacityBytes);
        ByteStream written(1);
        ByteStream expected(1);
        std::mt19937_64 random(testSeed());
        for (int i = 0; i < 5000; ++i) {
            std::vector<std::byte> out(randomSize(random, capacityBytes));
            written.fill(out);
            ASSERT_EQ(ring.writer.write(out), out.size());
            std::vector<std::byte> in(out.size());
            std::vector<std::byte> right(out.size());
            const size_t cut = randomSize(random, out.size());
            ASSERT_EQ(ring.reader.read(std::span(in).first(cut)), cut);
            ASSERT_EQ(ring.reader.read(std::span(in).subspan(cut)), out.size() - cut);
            expected.fill(right);
            ASSERT_EQ(in, right) << "capacity " << capacityBytes << ", round " << i;
        }
    }
}

TEST(ByteRing, makesNoSystemCallWhenNoThreadSleeps) {
    Ring ring(4096);
    std::array<std::byte, 48> record{};
    for (int i = 0; i < 100000; ++i) {
        ASSERT_EQ(ring.writer.write(record), record.size());
        ASSERT_EQ(ring.reader.read(record), record.size());
    }
    ring.writer.announce();
    EXPECT_EQ(ring.writer.wakeUps(), 0U);
    EXPECT_EQ(ring.reader.wakeUps(), 0U);
}

TEST(ByteRing, wakesASleeperOnce) {
    Ring ring(4096);
    const std::array<std::byte, 4> record{};
    ring.control.readerWaiting = 1;
    ring.writer.write(record);
    EXPECT_EQ(ring.writer.wakeUps(), 0U) << "a small write waits for announce()";
    ring.writer.announce();
    ring.writer.announce();
    EXPECT_EQ(ring.writer.wakeUps(), 1U);
    ring.control.readerWaiting = 1;
    const std::vector<std::byte> much(2048);
    ring.writer.write(much);
    EXPECT_EQ(ring.writer.wakeUps(), 2U) << "a big write does not";
}

TEST(ByteRing, returnsFromSleepAtOnceWhenDataIsAvailable) {
    Ring ring(64);
    const std::array<std::byte, 4> record{};
    ring.writer.write(record);
    const int64_t beginNs = monotonicNowNs();
    ring.reader.sleepUntilData(10 * kNsPerS);
    ring.writer.sleepUntilRoom(10 * kNsPerS);
    EXPECT_LT(monotonicNowNs() - beginNs, 5 * kNsPerS);
}

// A sleep of 60 s that ends early proves the wake-up.
TEST(ByteRing, wakesASleepingReaderAndASleepingWriter) {
    Ring ring(4096);
    std::vector<std::byte> bytes(4096);
    const auto untilAsleep = [](const std::atomic<pid_t>& id) {
        while (id == 0) std::this_thread::yield();
        ASSERT_TRUE(waitUntilAsleep(id, Deadline::inMs(20000)));
    };
    const int64_t beginNs = monotonicNowNs();
    std::atomic<pid_t> id = 0;
    std::thread reader([&] {
        id = currentThread();
        while (!ring.reader.hasData()) ring.reader.sleepUntilData(60 * kNsPerS);
    });
    untilAsleep(id);
    ring.writer.write(bytes);
    ring.writer.announce();
    reader.join();
    id = 0;
    std::thread writer([&] {
        id = currentThread();
        while (!ring.writer.hasRoom()) ring.writer.sleepUntilRoom(60 * kNsPerS);
    });
    untilAsleep(id);
    EXPECT_EQ(ring.reader.read(bytes), bytes.size());
    ring.reader.announce();
    writer.join();
    EXPECT_LT(monotonicNowNs() - beginNs, 50 * kNsPerS);
    EXPECT_EQ(ring.writer.wakeUps(), 1U);
    EXPECT_EQ(ring.reader.wakeUps(), 1U);
}

TEST(ByteRing, detectsInvalidPositions) {
    Ring ring(64);
    ring.control.tail = 65;
    EXPECT_FALSE(ring.reader.hasData());
    EXPECT_TRUE(ring.reader.damaged());
    const std::vector<std::byte> bytes(64);
    ring.control.head = 1; // ahead of the writer
    EXPECT_EQ(ring.writer.write(bytes), 64U) << "it need not look";
    EXPECT_EQ(ring.writer.write(bytes), 1U) << "that is plausible";
    ring.control.head = 1000;
    EXPECT_EQ(ring.writer.write(bytes), 0U);
    EXPECT_TRUE(ring.writer.damaged());
}

} // namespace mural::test
