// Simulates schedules on all ranks, with the draws that each rank holds per row.
#include <algorithm>
#include <deque>
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "compositor/image/draw_order.hpp"
#include "compositor/strategies/schedule.hpp"

namespace mural::compositor {
namespace {

using Held = std::vector<DrawOrder>; // draws per row; empty: sent away

struct Message {
    RowRange rows;
    Held held;
    int waits = 0;
};

// Executes a schedule; returns the first error, or nothing.
class Simulation {
public:
    // order: the ranks, the first drawn first; empty: in the order of their numbers.
    Simulation(const Schedule& schedule, int32_t rows, const std::vector<int>& order = {})
        : schedule_(schedule), rows_(rows) {
        for (uint32_t rank = 0; rank < schedule.size(); ++rank) {
            const auto found = std::ranges::find(order, static_cast<int>(rank));
            const auto at = order.empty() ? rank : static_cast<uint32_t>(found - order.begin());
            held_.emplace_back(static_cast<size_t>(rows), DrawOrder{at, at + 1});
        }
    }

    std::string wrong() {
        std::vector<size_t> next(schedule_.size(), 0);
        std::vector<int> waits(schedule_.size(), 0);
        for (bool moved = true; moved;) {
            moved = false;
            for (size_t rank = 0; rank < schedule_.size(); ++rank) {
                while (next[rank] < schedule_[rank].size() && take(rank, schedule_[rank][next[rank]], waits[rank])) {
                    ++next[rank];
                    moved = true;
                }
                if (!wrong_.empty()) return wrong_;
            }
        }
        for (size_t rank = 0; rank < schedule_.size(); ++rank)
            if (next[rank] < schedule_[rank].size())
                return "rank " + std::to_string(rank) + " waits for ever in step " + std::to_string(next[rank]);
        for (const auto& [way, messages] : under_)
            if (!messages.empty())
                return "nobody takes what rank " + std::to_string(way.first) + " sends to " +
                       std::to_string(way.second);
        const DrawOrder all{0, static_cast<uint32_t>(schedule_.size())};
        for (int32_t y = 0; y < rows_; ++y)
            if (held_[0][static_cast<size_t>(y)] != all)
                return "row " + std::to_string(y) + " of the collector does not hold all";
        return {};
    }

private:
    // Returns false if the rank must wait.
    bool take(size_t rank, const Step& step, int& waits) {
        const auto peer = static_cast<size_t>(step.peer);
        if (peer >= schedule_.size() || peer == rank || step.rows.empty() || step.rows.first < 0 ||
            step.rows.end > rows_) {
            wrong_ = "rank " + std::to_string(rank) + " has a step of no sense";
            return false;
        }
        Held& own = held_[rank];
        if (!step.receives()) {
            Message m{step.rows, {}, waits};
            for (int32_t y = step.rows.first; y < step.rows.end; ++y) {
                DrawOrder& row = own[static_cast<size_t>(y)];
                if (row.empty())
                    wrong_ = "rank " + std::to_string(rank) + " sends row " + std::to_string(y) +
                             ", which it has given away";
                m.held.push_back(row);
                row = {0, 0};
            }
            under_[{rank, peer}].push_back(m);
            return wrong_.empty();
        }
        auto& coming = under_[{peer, rank}];
        if (coming.empty()) return false;
        const Message m = coming.front();
        coming.pop_front();
        if (m.rows != step.rows) wrong_ = "rank " + std::to_string(rank) + " expects other rows than come";
        if (m.waits != step.stage)
            wrong_ = "the stage is " + std::to_string(step.stage) + " and not " + std::to_string(m.waits);
        waits = std::max(waits, m.waits + 1);
        for (size_t i = 0; wrong_.empty() && i < m.held.size(); ++i)
            fold(own[static_cast<size_t>(step.rows.first) + i], m.held[i], step.kind);
        return wrong_.empty();
    }

    void fold(DrawOrder& own, const DrawOrder& received, Step::Kind kind) {
        const bool fits = kind == Step::Kind::Place         ? own.empty()
                          : kind == Step::Kind::FoldEarlier ? !own.empty() && received.end == own.first
                                                            : !own.empty() && own.end == received.first;
        if (!fits)
            wrong_ = "draws " + std::to_string(received.first) + " to " + std::to_string(received.end) +
                     " are no neighbours of " + std::to_string(own.first) + " to " + std::to_string(own.end);
        own = own.empty() ? received : joined(own, received);
    }

    const Schedule& schedule_;
    int32_t rows_;
    std::vector<Held> held_; // by rank
    std::map<std::pair<size_t, size_t>, std::deque<Message>> under_;
    std::string wrong_;
};

TEST(Schedule, deliversEveryRowOfEveryRankOnceAndInOrder) {
    for (const Strategy strategy : kEveryStrategy)
        for (int ranks = 1; ranks <= 33; ++ranks)
            for (const int32_t rows : {1, 2, 7, 64, 191, 1080}) {
                const Schedule schedule = makeSchedule(strategy, ranks, rows);
                ASSERT_EQ(schedule.size(), static_cast<size_t>(ranks));
                EXPECT_EQ(Simulation(schedule, rows).wrong(), "")
                    << nameOf(strategy) << ", " << ranks << " ranks, " << rows << " rows";
            }
}

TEST(Schedule, needsNoStepForPicturesWithoutRows) {
    for (const Strategy strategy : kEveryStrategy)
        for (const auto& steps : makeSchedule(strategy, 5, 0)) EXPECT_TRUE(steps.empty());
}

// The maximum sent by a rank, in whole pictures.
double maxSent(Strategy strategy, int ranks) {
    constexpr int32_t kRows = 6720;
    double maximum = 0;
    for (const auto& steps : makeSchedule(strategy, ranks, kRows)) {
        double sent = 0;
        for (const Step& s : steps)
            if (!s.receives()) sent += s.rows.count();
        maximum = std::max(maximum, sent / kRows);
    }
    return maximum;
}

int stagesOf(Strategy strategy, int ranks) {
    int maximum = 0;
    for (const auto& steps : makeSchedule(strategy, ranks, 6720))
        for (const Step& s : steps) maximum = std::max(maximum, s.receives() ? s.stage + 1 : 0);
    return maximum;
}

TEST(Schedule, sendsTheDocumentedAmountPerStrategy) {
    EXPECT_DOUBLE_EQ(maxSent(Strategy::Serial, 8), 1);
    EXPECT_EQ(stagesOf(Strategy::Serial, 8), 1);
    EXPECT_DOUBLE_EQ(maxSent(Strategy::DirectSend, 8), 1); // 7/8 swapped, 1/8 gathered
    EXPECT_EQ(stagesOf(Strategy::DirectSend, 8), 2);
    EXPECT_DOUBLE_EQ(maxSent(Strategy::BinarySwap, 8), 1); // 1/2 + 1/4 + 1/8 swapped, 1/8 gathered
    EXPECT_EQ(stagesOf(Strategy::BinarySwap, 8), 4);
    EXPECT_DOUBLE_EQ(maxSent(Strategy::TwoThreeSwap, 9), 1); // 2/3 + 2/9 swapped, 1/9 gathered
    EXPECT_EQ(stagesOf(Strategy::TwoThreeSwap, 9), 3);
    EXPECT_LT(maxSent(Strategy::TwoThreeSwap, 7), 1.5); // uneven cuts cost slightly more
    EXPECT_EQ(stagesOf(Strategy::RadixK, 16), 3);       // 8 x 2
    EXPECT_EQ(stagesOf(Strategy::RadixK, 7), 2);
    EXPECT_EQ(stagesOf(Strategy::RadixK, 31), 4); // one is folded, then 6 x 5
    EXPECT_DOUBLE_EQ(maxSent(Strategy::Streaming, 8), 1);
}

// The simulation must detect faults.
TEST(Schedule, isCheckedForFaults) {
    const auto broken = [](auto&& change) {
        Schedule s = makeSchedule(Strategy::BinarySwap, 4, 8);
        change(s);
        return Simulation(s, 8).wrong();
    };
    EXPECT_EQ(broken([](Schedule&) {}), "");
    EXPECT_NE(broken([](Schedule& s) { s[3].pop_back(); }), ""); // a band is not sent
    EXPECT_NE(broken([](Schedule& s) { s[0].pop_back(); }), ""); // or not received
    // both wait first
    EXPECT_NE(broken([](Schedule& s) {
                  std::swap(s[0][0], s[0][1]);
                  s[1] = {s[1][1], s[1][0]};
              }),
              "");
    EXPECT_NE(broken([](Schedule& s) { s[0][1].kind = Step::Kind::FoldEarlier; }), ""); // order swapped
    EXPECT_NE(broken([](Schedule& s) { s[2][0].peer = 1; }), "");
}

TEST(Strategy, parsesNames) {
    for (const Strategy s : kEveryStrategy) EXPECT_EQ(strategyNamed(nameOf(s)), s);
    EXPECT_FALSE(strategyNamed("swap"));
}

// Every permutation of few ranks, and random ones of more.
TEST(Schedule, compositesInAnyOrder) {
    for (const Strategy strategy : {Strategy::Serial, Strategy::DirectSend, Strategy::BinarySwap,
                                    Strategy::TwoThreeSwap, Strategy::RadixK, Strategy::Streaming})
        for (int ranks = 1; ranks <= 9; ++ranks) {
            std::vector<int> order(static_cast<size_t>(ranks));
            for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
            for (int tries = 0; tries < 130; ++tries) {
                for (const int32_t rows : {0, 1, 17}) {
                    const Schedule schedule = makeSchedule(strategy, order, rows);
                    const std::string wrong = Simulation(schedule, rows, order).wrong();
                    ASSERT_TRUE(wrong.empty()) << nameOf(strategy) << ", " << ranks << " ranks: " << wrong;
                }
                if (ranks <= 5)
                    std::ranges::next_permutation(order);
                else
                    for (size_t i = order.size() - 1; i > 0; --i) // Fisher-Yates by a fixed sequence
                        std::swap(order[i],
                                  order[static_cast<size_t>(tries * 7919 + static_cast<int>(i) * 104729) % (i + 1)]);
            }
        }
}

} // namespace
} // namespace mural::compositor
