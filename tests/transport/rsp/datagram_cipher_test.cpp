// The datagram cipher: replays, forgeries, foreign keys.
#include "transport/rsp/wire/datagram_cipher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace mural::rsp {
namespace {

using Bytes = std::vector<std::byte>;

class DatagramCiphers : public testing::TestWithParam<Seal> {
protected:
    void SetUp() override {
        if (!available(GetParam())) GTEST_SKIP() << "this processor has no instructions for " << nameOf(GetParam());
        keys_ = makeSessionKeys(GetParam());
    }
    Bytes datagram(uint8_t value, size_t payloadBytes = 100) const {
        Bytes d(kStreamHeaderBytes + payloadBytes + tagBytes(keys_.seal), static_cast<std::byte>(value));
        StreamDatagram header;
        header.from = 3;
        writeStreamHeader(header, d);
        return d;
    }
    SessionKeys keys_;
};

TEST_P(DatagramCiphers, opensEachDatagramOnce) {
    DatagramSealer sealer(keys_, 3);
    DatagramOpener opener(keys_);
    opener.addMember(3);
    for (int i = 0; i < 100; ++i) {
        const Bytes plain = datagram(static_cast<uint8_t>(i));
        Bytes sealed = plain;
        sealer.seal(sealed);
        Bytes again = sealed;
        const auto opened = opener.open(sealed);
        ASSERT_EQ(opened.size(), plain.size() - tagBytes(keys_.seal));
        EXPECT_TRUE(std::equal(opened.begin() + kHeaderBytes, opened.end(), plain.begin() + kHeaderBytes));
        EXPECT_TRUE(opener.open(again).empty()) << "the same datagram again";
    }
    EXPECT_EQ(opener.refused().replayed, 100u);
    EXPECT_EQ(opener.refused().all(), 100u);
}

TEST_P(DatagramCiphers, hidesThePayload) {
    DatagramSealer sealer(keys_, 3);
    Bytes sealed = datagram(0x5a);
    sealer.seal(sealed);
    const auto same =
        std::count(sealed.begin() + kStreamHeaderBytes, sealed.begin() + kStreamHeaderBytes + 100, std::byte{0x5a});
    if (keys_.seal == Seal::None || keys_.seal == Seal::Tag)
        EXPECT_EQ(same, 100);
    else
        EXPECT_LT(same, 20);
}

TEST_P(DatagramCiphers, rejectsOtherSessionsMembersAndKeys) {
    DatagramOpener opener(keys_);
    opener.addMember(3);
    SessionKeys other = makeSessionKeys(keys_.seal);
    Bytes d = datagram(1);
    DatagramSealer(other, 3).seal(d);
    EXPECT_TRUE(opener.open(d).empty());
    EXPECT_EQ(opener.refused().session, 1u);
    d = datagram(1);
    DatagramSealer(keys_, 3).seal(d);
    DatagramOpener empty(keys_);
    EXPECT_TRUE(empty.open(d).empty());
    EXPECT_EQ(empty.refused().stranger, 1u);
    if (keys_.seal == Seal::None) return;
    other.session = keys_.session; // knows everything except the secret
    d = datagram(1);
    DatagramSealer(other, 3).seal(d);
    EXPECT_TRUE(opener.open(d).empty());
    EXPECT_EQ(opener.refused().forged, 1u);
    // Member 4 has the session's secret, but no valid datagram of member 3.
    d = datagram(1);
    DatagramSealer(keys_, 4).seal(d);
    EXPECT_TRUE(opener.open(d).empty());
    EXPECT_EQ(opener.refused().forged, 2u);
}

TEST_P(DatagramCiphers, rejectsAMemberAfterItHasLeft) {
    DatagramSealer sealer(keys_, 3);
    DatagramOpener opener(keys_);
    opener.addMember(3);
    Bytes d = datagram(1);
    sealer.seal(d);
    EXPECT_FALSE(opener.open(d).empty());
    opener.removeMember(3);
    d = datagram(2);
    sealer.seal(d);
    EXPECT_TRUE(opener.open(d).empty());
    EXPECT_EQ(opener.refused().stranger, 1u);
}

class DatagramForgery : public DatagramCiphers {};

TEST_P(DatagramForgery, isRejectedEachTime) {
    std::mt19937 random(5);
    DatagramSealer sealer(keys_, 3);
    DatagramOpener opener(keys_);
    opener.addMember(3);
    Bytes sealed = datagram(9, 20);
    sealer.seal(sealed);
    size_t accepted = 0;
    constexpr int kTries = 350'000; // for each of three seals
    for (int i = 0; i < kTries; ++i) {
        Bytes d = sealed;
        if (random() % 16 == 0) d.resize(random() % d.size());
        if (random() % 4 == 0)
            for (auto& b : d) b = static_cast<std::byte>(random());
        else if (!d.empty())
            d[random() % d.size()] ^= static_cast<std::byte>(1 + random() % 255);
        accepted += !opener.open(d).empty();
    }
    EXPECT_EQ(accepted, 0u);
    EXPECT_EQ(opener.refused().all(), static_cast<uint64_t>(kTries));
    EXPECT_FALSE(opener.open(sealed).empty()) << "the true one still counts";
}

std::string testName(const testing::TestParamInfo<Seal>& info) {
    constexpr std::array names{"None", "Tag", "AesGcm", "ChaCha"};
    return names[static_cast<size_t>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Seals, DatagramCiphers, testing::Values(Seal::None, Seal::Tag, Seal::AesGcm, Seal::ChaCha),
                         testName);
INSTANTIATE_TEST_SUITE_P(Seals, DatagramForgery, testing::Values(Seal::Tag, Seal::AesGcm, Seal::ChaCha), testName);

TEST(SessionKeys, differBetweenMembers) {
    const SessionKeys keys = makeSessionKeys(Seal::Tag);
    EXPECT_NE(memberKey(keys, 1), memberKey(keys, 2));
    EXPECT_EQ(memberKey(keys, 1), memberKey(keys, 1));
    EXPECT_NE(makeSessionKeys(Seal::Tag).secret, keys.secret);
}

// The published test vector: key 00 to 0f, message 00 to 0e.
TEST(DatagramCipher, matchesSipHash24) {
    Key key{};
    for (size_t i = 0; i < 16; ++i) key[i] = static_cast<std::byte>(i);
    Bytes d(15 + 8);
    for (size_t i = 0; i < 15; ++i) d[i] = static_cast<std::byte>(i);
    const DatagramCipher cipher(Seal::Tag, key);
    cipher.seal(std::span(d));
    const std::array<uint8_t, 8> expected{0xe5, 0x45, 0xbe, 0x49, 0x61, 0xca, 0x29, 0xa1};
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<uint8_t>(d[15 + i]), expected[i]);
}

TEST(ReplayWindow, acceptsEachCounterOnce) {
    ReplayWindow w;
    EXPECT_FALSE(w.fresh(0));
    std::mt19937 random(4);
    std::vector<uint64_t> counters;
    for (uint64_t i = 1; i <= 50'000; ++i) counters.push_back(i);
    // Reordered within the window.
    for (size_t i = 0; i + 4000 < counters.size(); i += 4000)
        std::shuffle(counters.begin() + static_cast<std::ptrdiff_t>(i),
                     counters.begin() + static_cast<std::ptrdiff_t>(i + 4000), random);
    for (const uint64_t c : counters) {
        ASSERT_TRUE(w.fresh(c)) << c;
        w.came(c);
        ASSERT_FALSE(w.fresh(c)) << c;
    }
    EXPECT_FALSE(w.fresh(50'000 - 8192));
    w.came(1'000'000);
    EXPECT_FALSE(w.fresh(50'000));
    EXPECT_TRUE(w.fresh(1'000'000 - 8191));
}

} // namespace
} // namespace mural::rsp
