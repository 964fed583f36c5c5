#include <gtest/gtest.h>

#include <map>
#include <random>

#include "objects/barrier/object_barrier.hpp"
#include "tests/objects/recording_sink.hpp"

namespace mural::objects::test {
namespace {

class BarrierWorld {
public:
    BarrierWorld() : leader(fromLeader_, 1) {}

    void add(PeerId id, const std::string& name,
             ObjectBarrierLeader::Awaited awaited = ObjectBarrierLeader::Awaited::AtOnce) {
        members[id] = std::make_unique<End>();
        leader.join(id, name, awaited);
    }
    void lose(PeerId id) {
        members.erase(id);
        leader.leave(id);
    }
    ObjectBarrierMember& member(PeerId id) { return members.at(id)->member; }
    void exchange(int64_t nowNs) {
        for (auto& [id, end] : members)
            for (const auto& sent : end->sink.take()) {
                const Message message = *decode(sent.bytes);
                EXPECT_TRUE(leader.input(id, std::get<EnterMessage>(message), nowNs));
            }
        leader.tick(nowNs);
        for (const auto& sent : fromLeader_.take()) {
            const Message message = *decode(sent.bytes);
            const auto found = members.find(*sent.to);
            if (found == members.end()) continue;
            if (const auto* go = std::get_if<GoMessage>(&message)) found->second->member.input(*go);
            if (const auto* late = std::get_if<LateMessage>(&message)) found->second->member.input(*late);
        }
    }
    // Returns the number of members of the passed round; 0: waiting or late.
    uint32_t passed(PeerId id) {
        const auto result = member(id).result();
        return result && *result ? result->value() : 0;
    }

    struct End {
        RecordingSink sink;
        ObjectBarrierMember member{sink, 1, "swap"};
    };
    RecordingSink fromLeader_;
    ObjectBarrierLeader leader;
    std::map<PeerId, std::unique_ptr<End>> members;
};

TEST(ObjectBarrier, releasesAllMembersTogether) {
    BarrierWorld world;
    for (const PeerId id : {1U, 2U, 3U}) world.add(id, "wall " + std::to_string(id));
    for (int round = 1; round <= 3; ++round) {
        world.member(1).enter(0);
        world.member(3).enter(0);
        world.exchange(0);
        EXPECT_FALSE(world.member(1).result());
        world.member(2).enter(0);
        world.exchange(0);
        for (const PeerId id : {1U, 2U, 3U}) EXPECT_EQ(world.passed(id), 3U) << round;
    }
    EXPECT_EQ(world.leader.round(), 4U);
}

TEST(ObjectBarrier, doesNotWaitForLostMembers) {
    BarrierWorld world;
    for (const PeerId id : {1U, 2U}) world.add(id, "wall");
    world.member(1).enter(0);
    world.exchange(0);
    world.lose(2);
    world.exchange(0);
    EXPECT_EQ(world.passed(1), 1U);
}

TEST(ObjectBarrier, waitsForNewcomersFromTheirFirstRoundOn) {
    BarrierWorld world;
    for (const PeerId id : {1U, 2U}) world.add(id, "wall");
    world.add(3, "newcomer", ObjectBarrierLeader::Awaited::FromItsFirstRound);
    const auto enter = [&](std::initializer_list<PeerId> ids, uint64_t round) {
        for (const PeerId id : ids) world.member(id).enter(0, round);
        world.exchange(0);
    };
    enter({1, 2}, 10);
    for (const PeerId id : {1U, 2U}) EXPECT_EQ(world.passed(id), 2U);
    enter({3}, 10); // the others have gone on
    EXPECT_EQ(world.passed(3), 3U);
    enter({1, 2}, 11);
    EXPECT_FALSE(world.member(1).result());
    enter({3}, 11);
    for (const PeerId id : {1U, 2U, 3U}) EXPECT_EQ(world.passed(id), 3U);
}

// Members that take part in every second round only.
TEST(ObjectBarrier, releasesMembersThatWaitForLaterRounds) {
    BarrierWorld world;
    for (const PeerId id : {1U, 2U}) world.add(id, "wall");
    world.member(1).enter(0, 2);
    world.exchange(0);
    EXPECT_FALSE(world.member(1).result());
    world.member(2).enter(0, 3);
    world.exchange(0);
    EXPECT_EQ(world.passed(1), 2U);
    EXPECT_FALSE(world.member(2).result());
    world.member(1).enter(0, 4);
    world.exchange(0);
    EXPECT_EQ(world.passed(2), 2U);
    EXPECT_FALSE(world.member(1).result());
}

TEST(ObjectBarrier, namesTheMissingMembersAtTheDeadline) {
    BarrierWorld world;
    world.add(1, "left");
    world.add(2, "middle");
    world.add(3, "right");
    world.member(1).enter(100);
    world.exchange(0);
    world.exchange(99'000'000);
    EXPECT_FALSE(world.member(1).result());
    world.exchange(100'000'000);
    ASSERT_TRUE(world.member(1).result());
    EXPECT_NE(world.member(1).result()->error().message.find("middle, right did not enter"), std::string::npos)
        << world.member(1).result()->error().message;
    // The round stays open: no member passes without the late one.
    world.member(2).enter(0);
    world.member(3).enter(0);
    world.exchange(101'000'000);
    EXPECT_FALSE(world.member(2).result());
    world.member(1).enter(0);
    world.exchange(102'000'000);
    for (const PeerId id : {1U, 2U, 3U}) EXPECT_EQ(world.passed(id), 3U);
}

TEST(ObjectBarrier, acceptsNewcomersInTheOpenRound) {
    BarrierWorld world;
    world.add(1, "left");
    world.member(1).enter(0);
    world.exchange(0);
    EXPECT_EQ(world.passed(1), 1U);
    world.member(1).enter(0);
    world.add(2, "right");
    world.exchange(0);
    EXPECT_EQ(world.passed(1), 0U);
    world.member(2).enter(0);
    world.exchange(0);
    EXPECT_EQ(world.passed(1), 2U);
    EXPECT_EQ(world.passed(2), 2U);
}

TEST(ObjectBarrier, refusesStrangers) {
    BarrierWorld world;
    world.add(1, "left");
    EXPECT_FALSE(world.leader.input(9, {1, 0, 0}, 0));
}

TEST(ObjectBarrier, keepsMembersInTheSameRoundInRandomSchedules) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        std::mt19937_64 random(seed);
        BarrierWorld world;
        PeerId next = 1;
        std::map<PeerId, uint64_t> rounds; // passed since the leader's first round
        std::map<PeerId, bool> isWaiting;
        const auto add = [&] {
            world.add(next, "wall");
            rounds[next] = world.leader.round() - 1;
            isWaiting[next++] = false;
        };
        add();
        add();
        for (int step = 0; step < 600; ++step) {
            if (world.members.size() < 5 && random() % 40 == 0) add();
            if (world.members.size() > 1 && random() % 60 == 0) {
                const PeerId lost = world.members.begin()->first;
                world.lose(lost);
                rounds.erase(lost);
                isWaiting.erase(lost);
            }
            for (auto& [id, waits] : isWaiting) {
                if (waits || random() % 3 != 0) continue;
                world.member(id).enter(random() % 4 == 0 ? 5 : 0);
                waits = true;
            }
            world.exchange(step * 1'000'000);
            for (auto& [id, waits] : isWaiting) {
                if (!waits || !world.member(id).result()) continue;
                waits = false;
                if (world.passed(id) > 0) ++rounds[id];
            }
            for (const auto& [id, round] : rounds) ASSERT_EQ(round, world.leader.round() - 1) << "seed " << seed;
        }
        EXPECT_GT(world.leader.round(), 20U) << "seed " << seed;
    }
}

} // namespace
} // namespace mural::objects::test
