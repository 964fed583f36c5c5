// A writing end alone: what it asks its readers, and when.
#include <gtest/gtest.h>

#include <vector>

#include "transport/rsp/sender.hpp"

namespace mural::rsp {
namespace {

class Kept : public Outbox {
public:
    std::span<std::byte> datagram(MemberId, size_t bytes) override { return kept_.emplace_back(bytes); }
    // Of all datagrams since the last call, those that want an answer at once.
    size_t takeAsking() {
        size_t asking = 0;
        for (const auto& d : kept_) asking += isUrgent(d, false);
        kept_.clear();
        return asking;
    }
    [[nodiscard]] size_t count() const { return kept_.size(); }

private:
    std::vector<std::vector<std::byte>> kept_;
};

// Answers cost both ends; what a writer goes on with needs none.
TEST(SenderAsks, AtTheEndOfAFlushAlone) {
    SenderSettings settings;
    settings.shape = {1000, 256};
    Sender sender(settings, Sequence(5));
    int64_t nowNs = 1'000'000'000;
    sender.addMember(1, nowNs);
    Feedback word; // the member has room
    word.from = 1;
    word.cumulative = word.highest = Sequence(5);
    word.edge = Sequence(5 + 256);
    sender.input(word, nowNs);
    Kept out;
    const std::vector<std::byte> groupful(1000 * kMostInGroup);
    for (int i = 0; i < 3; ++i) { // each time all of a whole group goes out, and nothing is left
        ASSERT_EQ(sender.write(groupful), groupful.size());
        (void)sender.tick(nowNs += 100'000, out);
        EXPECT_GE(out.count(), 32u);
        EXPECT_EQ(out.takeAsking(), 0u) << i;
    }
    ASSERT_EQ(sender.write(groupful), groupful.size());
    sender.flush();
    (void)sender.tick(nowNs += 100'000, out);
    EXPECT_EQ(out.takeAsking(), 1u);
    sender.write(std::span(groupful).first(10));
    sender.flush();
    (void)sender.tick(nowNs += 100'000, out);
    EXPECT_EQ(out.takeAsking(), 1u);
}

} // namespace
} // namespace mural::rsp
