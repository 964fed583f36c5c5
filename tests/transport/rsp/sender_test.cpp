// A single sender: when it requests replies, and when it sends.
#include <gtest/gtest.h>

#include <vector>

#include "transport/rsp/protocol/sender.hpp"

namespace mural::rsp {
namespace {

class RecordingSink : public DatagramSink {
public:
    std::span<std::byte> datagram(MemberId, size_t bytes) override { return datagrams_.emplace_back(bytes); }
    // The datagrams since the last call that request an immediate reply.
    size_t takeRequests() {
        size_t requests = 0;
        for (const auto& d : datagrams_) requests += isUrgent(d, false);
        datagrams_.clear();
        return requests;
    }
    [[nodiscard]] size_t count() const { return datagrams_.size(); }

private:
    std::vector<std::vector<std::byte>> datagrams_;
};

// Replies cost both ends; a writer that continues needs none.
TEST(Sender, requestsFeedbackOnlyAtTheEndOfAFlush) {
    SenderSettings settings;
    settings.shape = {1000, 256};
    Sender sender(settings, Sequence(5));
    int64_t nowNs = 1'000'000'000;
    sender.addMember(1, nowNs);
    Feedback word; // the member has space
    word.from = 1;
    word.cumulative = word.highest = Sequence(5);
    word.edge = Sequence(5 + 256);
    sender.input(word, nowNs);
    RecordingSink out;
    const std::vector<std::byte> groupful(1000 * kMaxInGroup);
    for (int i = 0; i < 3; ++i) { // each time a whole group is sent and nothing is left
        ASSERT_EQ(sender.write(groupful), groupful.size());
        (void)sender.tick(nowNs += 100'000, out);
        EXPECT_GE(out.count(), 32u);
        EXPECT_EQ(out.takeRequests(), 0u) << i;
    }
    ASSERT_EQ(sender.write(groupful), groupful.size());
    sender.flush();
    (void)sender.tick(nowNs += 100'000, out);
    EXPECT_EQ(out.takeRequests(), 1u);
    sender.write(std::span(groupful).first(10));
    sender.flush();
    (void)sender.tick(nowNs += 100'000, out);
    EXPECT_EQ(out.takeRequests(), 1u);
}

// A system call costs the same for few datagrams: while more wait than fit, each call is full.
TEST(Sender, sendsFullBatches) {
    SenderSettings settings;
    settings.shape = {1438, 1024};
    settings.rate.maxBytesPerS = 125e6;
    Sender sender(settings, Sequence(5));
    int64_t nowNs = 1'000'000'000;
    sender.addMember(1, nowNs);
    Feedback word;
    word.from = 1;
    word.cumulative = word.highest = Sequence(5);
    word.edge = Sequence(5 + 1024);
    sender.input(word, nowNs);
    RecordingSink out;
    const std::vector<std::byte> all(size_t{1438} * 900);
    ASSERT_EQ(sender.write(all), all.size());
    (void)sender.tick(nowNs, out); // the content of the bucket
    const auto maximum = static_cast<size_t>(maxInSend(1472));
    EXPECT_EQ(out.count() % maximum, 0u);
    size_t before = out.count();
    ASSERT_LT(before, 500u);
    for (int i = 0; i < 500 && out.count() < 800; ++i) { // called at any time
        (void)sender.tick(nowNs += 29'000, out);
        EXPECT_TRUE(out.count() == before || out.count() == before + maximum) << out.count() - before;
        before = out.count();
    }
    EXPECT_GE(out.count(), 800u);
    const int64_t whenNs = sender.tick(nowNs, out); // returns the time of the next call
    before = out.count();
    ASSERT_LT(before + maximum, 900u);
    (void)sender.tick(whenNs - 1000, out);
    EXPECT_EQ(out.count(), before);
    (void)sender.tick(whenNs, out);
    EXPECT_EQ(out.count(), before + maximum);
    for (int i = 0; i < 200; ++i) (void)sender.tick(nowNs += 29'000, out); // the rest is smaller than a batch
    EXPECT_GE(out.count(), 900u);
}

// A leader calls often; a sender only works when a time is due or something has happened.
TEST(Sender, doesNothingBeforeATimeIsDueOrAnEvent) {
    SenderSettings settings;
    settings.shape = {1000, 256};
    Sender sender(settings, Sequence(5));
    int64_t nowNs = 1'000'000'000;
    RecordingSink out;
    const auto sentBy = [&](int64_t atNs) {
        const size_t before = out.count();
        const int64_t dueNs = sender.tick(atNs, out);
        EXPECT_GT(dueNs, atNs);
        return out.count() - before;
    };
    EXPECT_EQ(sentBy(nowNs), 0u);
    const auto word = [&](MemberId from, Sequence cumulative) {
        Feedback f;
        f.from = from;
        f.cumulative = f.highest = cumulative;
        f.edge = Sequence(5 + 256);
        return f;
    };
    sender.addMember(1, nowNs);
    sender.addMember(2, nowNs);
    sender.input(word(1, Sequence(5)), nowNs);
    sender.input(word(2, Sequence(5)), nowNs);
    EXPECT_EQ(sentBy(nowNs), 0u) << "nothing is written";
    EXPECT_EQ(sender.tick(nowNs + 10, out), sender.tick(nowNs + 20, out)) << "one time, at which something is due";
    const std::vector<std::byte> two(2000);
    ASSERT_EQ(sender.write(two), two.size());
    EXPECT_EQ(sentBy(nowNs += 1000), 2u) << "written";
    EXPECT_EQ(sentBy(nowNs += 1000), 0u);
    sender.flush();
    EXPECT_EQ(sentBy(nowNs += 1000), 1u) << "flushed: asks whether all is there";
    sender.requestFeedback();
    EXPECT_EQ(sentBy(nowNs += 1000), 1u) << "asks";
    Feedback lacks = word(1, Sequence(5));
    lacks.highest = Sequence(7);
    lacks.entryCount = 1;
    lacks.entries[0] = {Sequence(5), 1, 0, 2};
    sender.input(lacks, nowNs += 1000);
    EXPECT_EQ(sentBy(nowNs += 1000), 1u) << "mends what is lacked";
    sender.input(word(1, Sequence(7)), nowNs += 1000);
    EXPECT_EQ(sentBy(nowNs += 1000), 0u);
    EXPECT_FALSE(sender.allArrived());
    sender.removeMember(2);
    EXPECT_TRUE(sender.allArrived()) << "nobody waits for it";
    const int64_t dueNs = sender.tick(nowNs += 1000, out);
    EXPECT_GE(dueNs, nowNs + settings.heartbeatNs / 2) << "no more polls";
    EXPECT_EQ(sentBy(dueNs), 1u) << "says that it lives";
}

// A shaper's bucket of 64 KiB accepts a batch with all headers.
TEST(Sender, limitsBatchesToABucket) {
    for (const size_t bytes : {100u, 576u, 1472u, 8972u, 65'000u}) {
        const size_t maximum = maxInSend(bytes);
        EXPECT_GE(maximum, 1u) << bytes;
        EXPECT_LE(maximum, 64u) << bytes;
        if (maximum > 1) {
            EXPECT_LE(maximum * (bytes + 62), 64u * 1024) << bytes; // Ethernet, IPv6, UDP
        }
    }
}

} // namespace
} // namespace mural::rsp
