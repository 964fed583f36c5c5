// The secure channel: handshake, encryption, changed bytes.
#include "transport/secure/secure_channel.hpp"

#include <gtest/gtest.h>

#include <random>

namespace mural {
namespace {

using Bytes = std::vector<std::byte>;

ChannelSecret secretOf(uint8_t value) {
    ChannelSecret s;
    s.fill(static_cast<std::byte>(value));
    return s;
}

Bytes bytesOf(std::string_view text) {
    const auto span = std::as_bytes(std::span(text));
    return {span.begin(), span.end()};
}

struct Pair {
    SecureChannel member;
    SecureChannel host;
    std::vector<Bytes> atMember;
    std::vector<Bytes> atHost;
    std::string error; // the first error

    explicit Pair(uint8_t secret = 1, uint8_t expected = 1)
        : member(SecureChannel::connecting("node-1", secretOf(secret))),
          host(SecureChannel::accepting([expected](const std::string& name) -> std::optional<ChannelSecret> {
              if (name != "node-1") return {};
              return secretOf(expected);
          })) {}

    // Exchanges data in pieces of pieceBytes until both ends are idle. `change` may modify data in transit.
    void talk(size_t pieceBytes = SIZE_MAX, const std::function<void(Bytes&)>& change = {}) {
        for (bool any = true; any && error.empty();) {
            any = move(member, host, atHost, pieceBytes, change);
            any |= move(host, member, atMember, pieceBytes, change);
        }
    }
    bool move(SecureChannel& from, SecureChannel& to, std::vector<Bytes>& messages, size_t pieceBytes,
              const std::function<void(Bytes&)>& change) {
        Bytes bytes = from.takeOutput();
        if (bytes.empty()) return false;
        if (change) change(bytes);
        for (size_t at = 0; at < bytes.size(); at += std::min(pieceBytes, bytes.size())) {
            const auto piece = std::span(bytes).subspan(at, std::min(pieceBytes, bytes.size() - at));
            if (auto r = to.input(piece, messages); !r) {
                if (error.empty()) error = r.error().message;
                return true;
            }
        }
        return true;
    }
};

TEST(SecureChannel, carriesMessagesInBothDirections) {
    for (const size_t pieceBytes : {size_t{1}, size_t{7}, SIZE_MAX}) {
        Pair p;
        p.talk(pieceBytes);
        ASSERT_TRUE(p.member.open() && p.host.open()) << p.error;
        EXPECT_EQ(p.host.name(), "node-1");
        ASSERT_TRUE(p.member.send(bytesOf("to the host")));
        ASSERT_TRUE(p.member.send({}));
        ASSERT_TRUE(p.host.send(bytesOf("to the member")));
        p.talk(pieceBytes);
        ASSERT_EQ(p.atHost.size(), 2u);
        EXPECT_EQ(p.atHost[0], bytesOf("to the host"));
        EXPECT_TRUE(p.atHost[1].empty());
        ASSERT_EQ(p.atMember.size(), 1u);
        EXPECT_EQ(p.atMember[0], bytesOf("to the member"));
        EXPECT_FALSE(p.host.finished());
        p.member.finish();
        p.talk(pieceBytes);
        EXPECT_TRUE(p.host.finished());
        EXPECT_FALSE(p.member.send(bytesOf("after the end")));
    }
}

TEST(SecureChannel, hidesItsContent) {
    Pair p;
    p.talk();
    const Bytes secret = bytesOf("a word that nobody may read");
    ASSERT_TRUE(p.member.send(secret));
    const Bytes wire = p.member.takeOutput();
    EXPECT_EQ(std::search(wire.begin(), wire.end(), secret.begin(), secret.end()), wire.end());
}

TEST(SecureChannel, rejectsWrongSecretsAndStrangers) {
    Pair wrong(1, 2);
    wrong.talk();
    EXPECT_NE(wrong.error.find("secret"), std::string::npos) << wrong.error;
    EXPECT_FALSE(wrong.host.open());
    EXPECT_FALSE(wrong.host.send(bytesOf("x")));

    Pair stranger;
    stranger.member = SecureChannel::connecting("node-2", secretOf(1));
    stranger.talk();
    EXPECT_NE(stranger.error.find("unknown peer name"), std::string::npos) << stranger.error;

    Pair other;
    std::vector<Bytes> none;
    const auto r = other.host.input(bytesOf("GET / HTTP/1.1\r\n"), none);
    ASSERT_FALSE(r);
    EXPECT_NE(r.error().message.find("version"), std::string::npos) << r.error().message;
}

// Records of another session with the same secret are useless: both ends create new keys.
TEST(SecureChannel, rejectsRecordsOfAnotherConnection) {
    Pair a;
    a.talk();
    ASSERT_TRUE(a.member.send(bytesOf("once")));
    const Bytes record = a.member.takeOutput();
    Pair b;
    b.talk();
    EXPECT_FALSE(b.host.input(record, b.atHost));
    EXPECT_TRUE(b.atHost.empty());
    ASSERT_TRUE(a.host.input(record, a.atHost));
    EXPECT_FALSE(a.host.input(record, a.atHost)) << "the same record again";
}

TEST(SecureChannel, detectsAnyChangedBit) {
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        Pair p;
        size_t turn = random() % 4; // index of the modified piece
        const auto spoil = [&](Bytes& bytes) {
            if (turn-- != 0) return;
            bytes[random() % bytes.size()] ^= static_cast<std::byte>(1u << random() % 8);
        };
        p.talk(SIZE_MAX, spoil);
        if (p.error.empty() && p.member.send(bytesOf("genuine"))) p.talk(SIZE_MAX, spoil);
        // A modified length may leave the host waiting, but a forged message never arrives.
        for (const Bytes& m : p.atHost) EXPECT_EQ(m, bytesOf("genuine"));
    }
}

TEST(SecureChannel, carriesLongMessagesAndRejectsLongerOnes) {
    Pair p;
    p.talk();
    const Bytes maximum(SecureChannel::kMaxMessageBytes, std::byte{3});
    ASSERT_TRUE(p.host.send(maximum));
    p.talk();
    ASSERT_EQ(p.atMember.size(), 1u);
    EXPECT_EQ(p.atMember[0], maximum);
    EXPECT_FALSE(p.host.send(Bytes(maximum.size() + 1)));
}

} // namespace
} // namespace mural
