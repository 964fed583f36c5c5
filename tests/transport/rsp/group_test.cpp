// Groups over this machine's own network: real sockets, threads and keys.
#include "transport/rsp/group.hpp"

#include <gtest/gtest.h>

#include <semaphore>
#include <thread>

namespace mural::rsp {
namespace {

std::byte byteAt(uint64_t place) { return static_cast<std::byte>((place * 0x9e3779b97f4a7c15u) >> 56); }

GroupOptions options(Seal seal) {
    GroupOptions o;
    // Any free port: tests run concurrently.
    o.group = "239.255.77.86:" + std::to_string(20'000 + ::getpid() % 20'000);
    o.interface = "lo";
    o.control = "127.0.0.1:0";
    o.secret.fill(std::byte{42});
    o.seal = seal;
    // Generous limits for busy machines: speed is not tested here.
    o.silentMs = o.stalledMs = 30'000;
    o.probeMs = 10'000;
    return o;
}

// A host, and the options to join it.
struct Hosted {
    std::unique_ptr<Group> host;
    GroupOptions join;
};
void startHost(Hosted& h, Seal seal) {
    auto host = Group::host(options(seal));
    ASSERT_TRUE(host) << host.error().message;
    h.host = std::move(*host);
    h.join = options(seal);
    h.join.control = h.host->controlAddress();
}
#define HOSTED(name, seal)                                                                                             \
    Hosted name;                                                                                                       \
    ASSERT_NO_FATAL_FAILURE(startHost(name, seal))

class GroupTest : public ::testing::TestWithParam<Seal> {};

TEST_P(GroupTest, deliversALargeStreamToThreeMembers) {
    HOSTED(hosted, GetParam());
    auto& [host, join] = hosted;
    std::vector<std::unique_ptr<Group>> members;
    for (int i = 0; i < 3; ++i) {
        auto member = Group::join(join, Deadline::inMs(10'000));
        ASSERT_TRUE(member) << member.error().message;
        members.push_back(std::move(*member));
    }
    ASSERT_TRUE(host->waitForMembers(3, Deadline::inMs(10'000)));
    constexpr uint64_t kBytes = 8 << 20;
    std::vector<std::thread> readers;
    std::array<uint64_t, 3> read{};
    std::array<uint64_t, 3> wrong{};
    for (size_t i = 0; i < members.size(); ++i) {
        readers.emplace_back([&, i] {
            std::vector<std::byte> piece(65'536);
            while (read[i] < kBytes) {
                auto count = members[i]->read(kHost, piece, Deadline::inMs(30'000));
                if (!count || *count == 0) return;
                for (size_t b = 0; b < *count; ++b) wrong[i] += piece[b] != byteAt(read[i] + b);
                read[i] += *count;
            }
        });
    }
    std::vector<std::byte> piece(50'000);
    for (uint64_t at = 0; at < kBytes; at += piece.size()) {
        const size_t count = std::min<uint64_t>(piece.size(), kBytes - at);
        for (size_t b = 0; b < count; ++b) piece[b] = byteAt(at + b);
        const auto written = host->write(std::span(piece).first(count), Deadline::inMs(30'000));
        ASSERT_TRUE(written) << written.error().message;
    }
    host->flush();
    EXPECT_TRUE(host->waitArrived(Deadline::inMs(30'000)));
    for (auto& r : readers) r.join();
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read[i], kBytes) << i;
        EXPECT_EQ(wrong[i], 0u) << i;
    }
    for (const auto& m : host->report().members) EXPECT_TRUE(m.info.multicast) << m.id;
}

std::string sealName(const ::testing::TestParamInfo<Seal>& tested) {
    return tested.param == Seal::None ? "None" : tested.param == Seal::Tag ? "Tag" : "ChaCha";
}
INSTANTIATE_TEST_SUITE_P(Seals, GroupTest, ::testing::Values(Seal::None, Seal::Tag, Seal::ChaCha), sealName);

TEST(Group, deliversWritesOfMembers) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto a = Group::join(join, Deadline::inMs(10'000));
    join.multicast = false; // tunnelled by the host
    auto b = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(a && b);
    ASSERT_TRUE(host->waitForMembers(2, Deadline::inMs(10'000)) && (*a)->waitForMembers(2, Deadline::inMs(10'000)) &&
                (*b)->waitForMembers(2, Deadline::inMs(10'000)));
    std::array<Group*, 3> all{host.get(), a->get(), b->get()};
    for (Group* g : all) {
        const std::array<std::byte, 3> word{std::byte{1}, std::byte{2}, static_cast<std::byte>(g->self())};
        ASSERT_TRUE(g->write(word, Deadline::inMs(5000)));
        g->flush();
    }
    for (Group* reader : all) {
        for (const MemberId from : reader->members()) {
            std::array<std::byte, 3> word{};
            size_t count = 0;
            while (count < word.size()) {
                auto n = reader->read(from, std::span(word).subspan(count), Deadline::inMs(5000));
                ASSERT_TRUE(n) << n.error().message;
                ASSERT_GT(*n, 0u);
                count += *n;
            }
            EXPECT_EQ(word[2], static_cast<std::byte>(from));
        }
    }
}

// The reader processes data in the window, a few bytes at a time, while more arrives than the window holds.
TEST(Group, letsAReaderWorkInPlace) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto member = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(member) << member.error().message;
    ASSERT_TRUE(host->waitForMembers(1, Deadline::inMs(10'000)));
    constexpr uint64_t kBytes = uint64_t{12} << 20;
    uint64_t seen = 0, wrong = 0;
    std::string failure;
    std::thread reader([&] {
        for (size_t maximum = 1;; maximum = maximum % 99'991 * 3 + 1) {
            std::array<std::span<const std::byte>, 7> pieces;
            auto found = (*member)->view(kHost, pieces, Deadline::inMs(20'000));
            if (!found) failure = found.error().message;
            if (!found || *found == 0) return;
            size_t count = 0;
            for (const auto piece : std::span(pieces).first(*found)) {
                const auto part = piece.first(std::min(piece.size(), maximum - count));
                for (size_t i = 0; i < part.size(); ++i) wrong += part[i] != byteAt(seen + i);
                seen += part.size();
                count += part.size();
            }
            (*member)->consume(kHost, count);
        }
    });
    std::vector<std::byte> bytes(kBytes);
    for (uint64_t i = 0; i < kBytes; ++i) bytes[i] = byteAt(i);
    const auto written = host->write(bytes, Deadline::inMs(20'000));
    host->flush();
    const auto arrived = host->waitArrived(Deadline::inMs(20'000));
    host->leave();
    reader.join();
    EXPECT_TRUE(written && arrived);
    EXPECT_EQ(failure, "");
    EXPECT_EQ(seen, kBytes);
    EXPECT_EQ(wrong, 0u);
}

// Reads one word of a member's stream.
Result<void> readWord(Group& group, MemberId from, Deadline deadline) {
    std::array<std::byte, 64> word{};
    for (size_t have = 0; have < word.size();) {
        auto count = group.read(from, std::span(word).subspan(have), deadline);
        if (!count) return count.error();
        if (*count == 0) return Error{"the stream ended"};
        have += *count;
    }
    return {};
}

Result<void> writeWord(Group& group, Deadline deadline) {
    if (auto r = group.write(std::array<std::byte, 64>{}, deadline); !r) return r;
    group.flush();
    return {};
}

// All ends wait for each other: the host has three threads, and one of the three serves the sockets.
TEST(Group, exchangesWordsWhicheverThreadLeads) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    constexpr int kRounds = 300;
    auto direct = Group::join(join, Deadline::inMs(10'000));
    join.multicast = false;
    auto tunnelled = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(direct && tunnelled);
    ASSERT_TRUE(host->waitForMembers(2, Deadline::inMs(10'000)));
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(host->accept(Deadline::inMs(10'000)));
    const Deadline deadline = Deadline::inMs(20'000);
    std::array<std::string, 4> failures;
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 2; ++i) {
        Group& member = i == 0 ? **direct : **tunnelled;
        threads.emplace_back([&failures, &member, i, deadline] {
            for (int round = 0; round < kRounds && failures[i].empty(); ++round) {
                auto r = readWord(member, kHost, deadline);
                if (r) r = writeWord(member, deadline);
                if (!r) failures[i] = r.error().message;
            }
        });
    }
    for (size_t i = 0; i < 2; ++i) {
        const MemberId from = (i == 0 ? *direct : *tunnelled)->self();
        threads.emplace_back([&failures, &host = *host, from, i, deadline] {
            for (int round = 0; round < kRounds && failures[2 + i].empty(); ++round) {
                if (auto r = readWord(host, from, deadline); !r) failures[2 + i] = r.error().message;
            }
        });
    }
    Result<void> written;
    for (int round = 0; round < kRounds && written; ++round) {
        written = writeWord(*host, deadline);
        if (written) written = host->waitArrived(deadline);
    }
    for (auto& t : threads) t.join();
    EXPECT_TRUE(written) << written.error().message;
    for (const std::string& failure : failures) EXPECT_EQ(failure, "");
}

// Writes each word after the previous one was read. A lost wake-up costs 100 ms, and many of them the deadline.
void expectEachWordWakes(Group& writer, Group& reader, MemberId from) {
    constexpr int kRounds = 200;
    const Deadline deadline = Deadline::inMs(8'000);
    std::counting_semaphore<kRounds> wordsRead(0);
    std::thread thread([&] {
        for (int i = 0; i < kRounds; ++i) {
            const auto r = readWord(reader, from, deadline);
            EXPECT_TRUE(r) << r.error().message;
            if (!r) return;
            wordsRead.release();
        }
    });
    bool inTime = true;
    for (int i = 0; i < kRounds && inTime; ++i) {
        EXPECT_TRUE(writeWord(writer, deadline));
        inTime = wordsRead.try_acquire_for(std::chrono::nanoseconds(deadline.leftNs()));
    }
    EXPECT_TRUE(inTime);
    thread.join();
}

// A tunnelled reader waits at idle sockets. The group's thread receives the data and wakes it.
TEST(Group, wakesTheLeaderWhenTunnelledDataArrives) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    join.multicast = false;
    auto member = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(member);
    ASSERT_TRUE(host->waitForMembers(1, Deadline::inMs(10'000)));
    expectEachWordWakes(*host, **member, kHost);
}

// A thread that waits for a silent member serves the sockets for one that waits for another member.
TEST(Group, wakesOtherThreadsFromTheLeader) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto silent = Group::join(join, Deadline::inMs(10'000));
    auto member = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(silent && member);
    ASSERT_TRUE(host->waitForMembers(2, Deadline::inMs(10'000)));
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(host->accept(Deadline::inMs(10'000)));
    std::thread leader(
        [&silent, &host = host] { EXPECT_TRUE(readWord(*host, (*silent)->self(), Deadline::inMs(30'000))); });
    // the thread probably waits by then; the test does not depend on it
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    expectEachWordWakes(**member, *host, (*member)->self());
    EXPECT_TRUE(writeWord(**silent, Deadline::inMs(10'000)));
    leader.join();
}

// The member's reader has served its sockets and now computes: the group's thread replies.
TEST(Group, repliesWhileNoThreadReads) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto member = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(member);
    ASSERT_TRUE(host->waitForMembers(1, Deadline::inMs(10'000)));
    std::thread reader([&] { EXPECT_TRUE(readWord(**member, kHost, Deadline::inMs(10'000))); });
    // the thread probably waits by then; the test does not depend on it
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_TRUE(writeWord(*host, Deadline::inMs(10'000)));
    reader.join();
    constexpr int kWords = 50;
    for (int i = 0; i < kWords; ++i) {
        ASSERT_TRUE(writeWord(*host, Deadline::inMs(10'000)));
        const auto arrived = host->waitArrived(Deadline::inMs(10'000));
        ASSERT_TRUE(arrived) << arrived.error().message;
    }
    for (int i = 0; i < kWords; ++i) EXPECT_TRUE(readWord(**member, kHost, Deadline::inMs(10'000)));
}

// Without data a wait ends at its deadline, and when another thread leaves the group.
TEST(Group, endsWaitsAtTheDeadlineAndWhenItIsLeft) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto member = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(member);
    const auto late = readWord(**member, kHost, Deadline::inMs(30));
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().message.find("deadline"), std::string::npos) << late.error().message;
    std::thread reader([&] {
        const auto ended = readWord(**member, kHost, Deadline::inMs(60'000));
        ASSERT_FALSE(ended);
        EXPECT_NE(ended.error().message.find("left the group"), std::string::npos) << ended.error().message;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    (*member)->leave();
    reader.join();
}

TEST(Group, endsTheStreamOfALeavingMember) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto a = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(a);
    const MemberId id = (*a)->self();
    ASSERT_TRUE(host->waitForMembers(1, Deadline::inMs(5000)));
    auto accepted = host->accept(Deadline::inMs(5000));
    ASSERT_TRUE(accepted);
    EXPECT_EQ(*accepted, id);
    ASSERT_TRUE((*a)->write(std::array{std::byte{9}}, Deadline::inMs(5000)));
    (*a)->flush();
    ASSERT_TRUE((*a)->waitArrived(Deadline::inMs(5000)));
    a->reset();
    std::array<std::byte, 8> word{};
    auto count = host->read(id, word, Deadline::inMs(5000));
    ASSERT_TRUE(count);
    EXPECT_EQ(*count, 1u) << "what it wrote stays";
    count = host->read(id, word, Deadline::inMs(5000));
    ASSERT_TRUE(count);
    EXPECT_EQ(*count, 0u);
}

TEST(Group, reportsAWrongSecretAndAMissingHostInOneLine) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    join.secret.fill(std::byte{1});
    const auto wrong = Group::join(join, Deadline::inMs(5000));
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("secret"), std::string::npos) << wrong.error().message;
    host.reset();
    const auto none = Group::join(join, Deadline::inMs(5000));
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find(join.control), std::string::npos) << none.error().message;
}

TEST(Group, endsTheStreamOfALeavingHost) {
    HOSTED(hosted, Seal::Tag);
    auto& [host, join] = hosted;
    auto a = Group::join(join, Deadline::inMs(10'000));
    ASSERT_TRUE(a);
    host.reset();
    std::array<std::byte, 8> word{};
    auto count = (*a)->read(kHost, word, Deadline::inMs(5000));
    ASSERT_TRUE(count) << count.error().message;
    EXPECT_EQ(*count, 0u);
    EXPECT_FALSE((*a)->write(word, Deadline::inMs(5000))) << "nobody is left to write to";
}

} // namespace
} // namespace mural::rsp
