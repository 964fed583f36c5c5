// The secure channel: handshake, encryption, changed bytes.
#include "transport/secure/secure_channel.hpp"

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <memory>
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

    Pair alerted(1, 2);
    ASSERT_FALSE(alerted.host.input(alerted.member.takeOutput(), alerted.atHost));
    const auto rejected = alerted.member.input(alerted.host.takeOutput(), alerted.atMember);
    ASSERT_FALSE(rejected) << "the member receives an alert";
    EXPECT_NE(rejected.error().message.find("the host rejects the secret"), std::string::npos)
        << rejected.error().message;
    EXPECT_FALSE(alerted.member.open());

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
    for (int i = 0; i < 1000; ++i) {
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

// A TLS host with a certificate but without the secret. It accepts the member's first message as any web server would.
struct CertifiedHost {
    std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context{SSL_CTX_new(TLS_server_method()), SSL_CTX_free};
    std::unique_ptr<SSL, decltype(&SSL_free)> tls{nullptr, SSL_free};
    CertifiedHost() {
        std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(EVP_EC_gen("P-256"), EVP_PKEY_free);
        std::unique_ptr<X509, decltype(&X509_free)> certificate(X509_new(), X509_free);
        X509_gmtime_adj(X509_getm_notBefore(certificate.get()), 0);
        X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
        X509_set_pubkey(certificate.get(), key.get());
        X509_sign(certificate.get(), key.get(), EVP_sha256());
        SSL_CTX_use_certificate(context.get(), certificate.get());
        SSL_CTX_use_PrivateKey(context.get(), key.get());
        tls.reset(SSL_new(context.get()));
        SSL_set_bio(tls.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
        SSL_set_accept_state(tls.get());
    }
    Bytes answer(const Bytes& question) {
        BIO_write(SSL_get_rbio(tls.get()), question.data(), static_cast<int>(question.size()));
        SSL_do_handshake(tls.get());
        Bytes bytes(BIO_ctrl_pending(SSL_get_wbio(tls.get())));
        BIO_read(SSL_get_wbio(tls.get()), bytes.data(), static_cast<int>(bytes.size()));
        return bytes;
    }
};

TEST(SecureChannel, rejectsACertificateInsteadOfTheSecret) {
    CertifiedHost stranger;
    SecureChannel member = SecureChannel::connecting("node-1", secretOf(1));
    const Bytes answer = stranger.answer(member.takeOutput());
    ASSERT_GT(answer.size(), 300u) << "it offers its certificate";
    std::vector<Bytes> none;
    EXPECT_FALSE(member.input(answer, none));
    EXPECT_FALSE(member.open());
}

TEST(SecureChannel, requestsNoByteBeyondTheCurrentRecord) {
    Pair p;
    p.talk();
    ASSERT_TRUE(p.member.send(Bytes(20'000, std::byte{1})));
    const Bytes wire = p.member.takeOutput();
    size_t at = 0;
    size_t reads = 0;
    while (p.atHost.empty()) {
        const size_t wanted = p.host.wantsBytes();
        ASSERT_LE(at + wanted, wire.size());
        ASSERT_TRUE(p.host.input(std::span(wire).subspan(at, wanted), p.atHost));
        at += wanted;
        ++reads;
    }
    EXPECT_EQ(at, wire.size());
    EXPECT_EQ(reads, 4u) << "a header and a body, for two records";
}

TEST(SecureChannel, changesItsKeyAndContinues) {
    Pair p;
    p.talk();
    const Bytes one{std::byte{1}};
    size_t usual = 0;
    size_t longer = 0;
    for (uint64_t i = 0; i < SecureChannel::kRecordsPerKey + 10; ++i) {
        ASSERT_TRUE(p.member.send(one));
        const Bytes wire = p.member.takeOutput();
        if (i == 0) usual = wire.size();
        if (wire.size() != usual) ++longer;
        ASSERT_TRUE(p.host.input(wire, p.atHost));
        ASSERT_EQ(p.atHost.size(), 1u);
        p.atHost.clear();
    }
    EXPECT_EQ(longer, 1u) << "one message also carries the update of the key";
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
