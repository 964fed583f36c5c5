#include "transport/secure/secure_channel.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string_view>

#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include "common/base/little_endian.hpp"
#include "transport/secure/tls_records.hpp"

namespace mural {

namespace {

// Names the protocol within TLS (ALPN), so that a peer of another version is recognized.
constexpr std::string_view kProtocol = "mural-channel/2";
constexpr size_t kLengthBytes = 4;
constexpr size_t kPieceBytes = 16'384; // the largest plaintext of a TLS record

using Bytes = std::vector<std::byte>;

template <auto Free> struct FreeWith {
    template <class T> void operator()(T* object) const { Free(object); }
};
using Context = std::unique_ptr<SSL_CTX, FreeWith<SSL_CTX_free>>;
using Tls = std::unique_ptr<SSL, FreeWith<SSL_free>>;

std::string protocolList() { return std::string(1, static_cast<char>(kProtocol.size())) + std::string(kProtocol); }

// Makes the TLS session that represents an external key. SHA-256 is the hash of both permitted cipher suites.
SSL_SESSION* sessionOf(SSL* tls, const ChannelSecret& secret) {
    constexpr unsigned char aes128GcmSha256[] = {0x13, 0x01};
    SSL_SESSION* session = SSL_SESSION_new();
    if (session != nullptr &&
        SSL_SESSION_set1_master_key(session, reinterpret_cast<const unsigned char*>(secret.data()), secret.size()) ==
            1 &&
        SSL_SESSION_set_cipher(session, SSL_CIPHER_find(tls, aes128GcmSha256)) == 1 &&
        SSL_SESSION_set_protocol_version(session, TLS1_3_VERSION) == 1)
        return session;
    SSL_SESSION_free(session);
    return nullptr;
}

// The alerts by which a host rejects an identity or its key.
bool isRejection(int alert) {
    return alert == SSL3_AD_HANDSHAKE_FAILURE || alert == SSL3_AD_ILLEGAL_PARAMETER || alert == TLS1_AD_DECRYPT_ERROR ||
           alert == TLS1_AD_UNKNOWN_PSK_IDENTITY;
}

} // namespace

struct SecureChannel::State {
    mutable std::mutex mutex; // of `tls`: reader and writer share its state
    Tls tls;                  // null: OpenSSL could not create it
    bool host = false;
    std::atomic<bool> opened = false;
    std::atomic<bool> finished = false; // the peer has finished
    bool ended = false;                 // by us
    bool dead = false;
    bool unknownName = false;
    bool otherProtocol = false;
    std::string name;
    FindSecret find;
    ChannelSecret secret{};
    TlsRecords records;
    Bytes plain; // received bytes of incomplete messages
    Bytes framed;
    uint64_t recordsOfKey = 0;

    ~State() {
        OPENSSL_cleanse(secret.data(), secret.size());
        ERR_clear_error();
    }

    bool start(bool asHost);
    Result<void> shakeHands();
    Result<void> takePlain(std::vector<Bytes>& messages);
    Result<void> takeMessages(std::vector<Bytes>& messages);
    [[nodiscard]] Error handshakeError(unsigned long code) const;

    // Callbacks of OpenSSL, in the thread that calls input().
    static int useKey(SSL* tls, const EVP_MD* digest, const unsigned char** id, size_t* idBytes, SSL_SESSION** session);
    static int findKey(SSL* tls, const unsigned char* id, size_t idBytes, SSL_SESSION** session);
    static int selectProtocol(SSL* tls, const unsigned char** out, unsigned char* outBytes, const unsigned char* in,
                              unsigned inBytes, void*);
    static State& of(SSL* tls) { return *static_cast<State*>(SSL_get_app_data(tls)); }
    static SSL_CTX* context();
};

int SecureChannel::State::useKey(SSL* tls, const EVP_MD*, const unsigned char** id, size_t* idBytes,
                                 SSL_SESSION** session) {
    State& s = of(tls);
    *session = sessionOf(tls, s.secret);
    *id = reinterpret_cast<const unsigned char*>(s.name.data());
    *idBytes = s.name.size();
    return *session != nullptr ? 1 : 0;
}

int SecureChannel::State::findKey(SSL* tls, const unsigned char* id, size_t idBytes, SSL_SESSION** session) {
    State& s = of(tls);
    *session = nullptr;
    s.unknownName = true;
    if (idBytes > kMaxNameBytes) return 1; // without a session the handshake fails, because there is no certificate
    s.name.assign(reinterpret_cast<const char*>(id), idBytes);
    const auto found = s.find(s.name);
    if (!found) return 1;
    s.secret = *found;
    s.unknownName = false;
    *session = sessionOf(tls, s.secret);
    return *session != nullptr ? 1 : 0;
}

int SecureChannel::State::selectProtocol(SSL* tls, const unsigned char** out, unsigned char* outBytes,
                                         const unsigned char* in, unsigned inBytes, void*) {
    static const std::string ours = protocolList();
    unsigned char* selected = nullptr;
    if (SSL_select_next_proto(&selected, outBytes, reinterpret_cast<const unsigned char*>(ours.data()),
                              static_cast<unsigned>(ours.size()), in, inBytes) != OPENSSL_NPN_NEGOTIATED) {
        of(tls).otherProtocol = true;
        return SSL_TLSEXT_ERR_ALERT_FATAL;
    }
    *out = selected;
    return SSL_TLSEXT_ERR_OK;
}

// Returns the settings of all channels of the process, or null.
SSL_CTX* SecureChannel::State::context() {
    static const Context shared = [] {
        Context c(SSL_CTX_new(TLS_method()));
        const std::string protocols = protocolList();
        if (c == nullptr || SSL_CTX_set_min_proto_version(c.get(), TLS1_3_VERSION) != 1 ||
            SSL_CTX_set_max_proto_version(c.get(), TLS1_3_VERSION) != 1 ||
            SSL_CTX_set_ciphersuites(c.get(), "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256") != 1 ||
            SSL_CTX_set1_groups_list(c.get(), "X25519") != 1 || SSL_CTX_set_num_tickets(c.get(), 0) != 1 ||
            SSL_CTX_set_alpn_protos(c.get(), reinterpret_cast<const unsigned char*>(protocols.data()),
                                    static_cast<unsigned>(protocols.size())) != 0)
            return Context();
        SSL_CTX_set_session_cache_mode(c.get(), SSL_SESS_CACHE_OFF);
        SSL_CTX_set_mode(c.get(), SSL_MODE_RELEASE_BUFFERS);
        SSL_CTX_set_psk_use_session_callback(c.get(), useKey);
        SSL_CTX_set_psk_find_session_callback(c.get(), findKey);
        SSL_CTX_set_alpn_select_cb(c.get(), selectProtocol, nullptr);
        return c;
    }();
    return shared.get();
}

bool SecureChannel::State::start(bool asHost) {
    host = asHost;
    if (context() == nullptr) return false;
    tls.reset(SSL_new(context()));
    BIO* in = BIO_new(BIO_s_mem());
    BIO* out = BIO_new(BIO_s_mem());
    if (tls == nullptr || in == nullptr || out == nullptr) {
        BIO_free(in);
        BIO_free(out);
        tls.reset();
        return false;
    }
    BIO_set_mem_eof_return(in, -1); // an empty buffer means "later", not "ended"
    SSL_set_bio(tls.get(), in, out);
    SSL_set_app_data(tls.get(), this);
    if (host) {
        SSL_set_accept_state(tls.get());
    } else {
        SSL_set_connect_state(tls.get());
        // A host that does not know the secret could offer a certificate; no authority is trusted.
        SSL_set_verify(tls.get(), SSL_VERIFY_PEER, nullptr);
    }
    return true;
}

Error SecureChannel::State::handshakeError(unsigned long code) const {
    if (otherProtocol)
        return Error{
            "the peer does not use Mural's secure channel, version 2; check that both ends run the same version"};
    if (host && unknownName) return Error{"unknown peer name"};
    const int reason = ERR_GET_REASON(code);
    if (host && reason == SSL_R_BINDER_DOES_NOT_VERIFY)
        return Error{"\"" + name + "\" has another secret; use the same secret at both ends"};
    if (!host && (reason == SSL_AD_REASON_OFFSET + TLS1_AD_NO_APPLICATION_PROTOCOL ||
                  reason == SSL_AD_REASON_OFFSET + TLS1_AD_PROTOCOL_VERSION))
        return Error{"the host uses another version of Mural's secure channel; run the same version at both ends"};
    if (!host && isRejection(reason - SSL_AD_REASON_OFFSET))
        return Error{"the host rejects the secret of \"" + name + "\"; use the same secret at both ends"};
    const char* text = ERR_reason_error_string(code);
    return Error{std::string("the handshake failed: ") + (text != nullptr ? text : "the peer's data is invalid")};
}

Result<void> SecureChannel::State::shakeHands() {
    if (opened) return {};
    ERR_clear_error();
    const int done = SSL_do_handshake(tls.get());
    if (done != 1) {
        if (SSL_get_error(tls.get(), done) == SSL_ERROR_WANT_READ) return {};
        return handshakeError(ERR_peek_error());
    }
    // "Reused" means that the key authenticated both ends.
    if (SSL_session_reused(tls.get()) != 1) return Error{"the peer did not prove that it knows the secret"};
    opened = true;
    return {};
}

// Splits the received plaintext into messages.
Result<void> SecureChannel::State::takeMessages(std::vector<Bytes>& messages) {
    size_t at = 0;
    while (plain.size() - at >= kLengthBytes) {
        const size_t bytes = loadLittle<uint32_t>(plain.data() + at);
        if (bytes > kMaxMessageBytes) return Error{"the peer sent a message of more than 1 MiB"};
        if (plain.size() - at - kLengthBytes < bytes) break;
        const auto first = plain.begin() + static_cast<std::ptrdiff_t>(at + kLengthBytes);
        messages.emplace_back(first, first + static_cast<std::ptrdiff_t>(bytes));
        at += kLengthBytes + bytes;
    }
    plain.erase(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(at));
    return {};
}

Result<void> SecureChannel::State::takePlain(std::vector<Bytes>& messages) {
    std::array<std::byte, kPieceBytes> piece;
    while (true) {
        size_t got = 0;
        ERR_clear_error();
        const int read = SSL_read_ex(tls.get(), piece.data(), piece.size(), &got);
        if (read == 1) {
            plain.insert(plain.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(got));
            continue;
        }
        const auto split = takeMessages(messages);
        switch (SSL_get_error(tls.get(), read)) {
        case SSL_ERROR_WANT_READ: return split;
        case SSL_ERROR_ZERO_RETURN: finished = true; return split;
        default: return split.ok() ? Result<void>(Error{"a record was changed in transit"}) : split;
        }
    }
}

SecureChannel::SecureChannel(std::unique_ptr<State> state) : state_(std::move(state)) {}
SecureChannel::SecureChannel(SecureChannel&&) noexcept = default;
SecureChannel& SecureChannel::operator=(SecureChannel&&) noexcept = default;
SecureChannel::~SecureChannel() = default;

SecureChannel SecureChannel::connecting(const std::string& name, const ChannelSecret& secret) {
    auto s = std::make_unique<State>();
    s->name = name.substr(0, kMaxNameBytes);
    s->secret = secret;
    s->dead = !s->start(false) || !s->shakeHands();
    return SecureChannel(std::move(s));
}

SecureChannel SecureChannel::accepting(FindSecret find) {
    auto s = std::make_unique<State>();
    s->find = std::move(find);
    s->dead = !s->start(true);
    return SecureChannel(std::move(s));
}

Result<void> SecureChannel::input(std::span<const std::byte> bytes, std::vector<Bytes>& messages) {
    State& s = *state_;
    const std::lock_guard lock(s.mutex);
    if (s.dead) return Error{"the channel failed earlier"};
    const auto failed = [&s](Error why) {
        s.dead = true;
        return why;
    };
    if (!s.records.advance(bytes)) {
        s.otherProtocol = !s.opened;
        return failed(s.opened ? Error{"a record was changed in transit"} : s.handshakeError(0));
    }
    size_t taken = 0;
    if (!bytes.empty() && BIO_write_ex(SSL_get_rbio(s.tls.get()), bytes.data(), bytes.size(), &taken) != 1)
        return failed(Error{"the memory for received bytes is exhausted"});
    if (auto good = s.shakeHands(); !good) return failed(good.error());
    if (!s.opened) return {};
    if (auto good = s.takePlain(messages); !good) return failed(good.error());
    return {};
}

Result<void> SecureChannel::send(std::span<const std::byte> message) {
    State& s = *state_;
    const std::lock_guard lock(s.mutex);
    if (!s.opened || s.ended || s.dead) return Error{"the channel is not open"};
    if (message.size() > kMaxMessageBytes) return Error{"a message exceeds the maximum of 1 MiB"};
    s.framed.resize(kLengthBytes);
    storeLittle(s.framed.data(), static_cast<uint32_t>(message.size()));
    s.framed.insert(s.framed.end(), message.begin(), message.end());
    s.recordsOfKey += 1 + s.framed.size() / kPieceBytes;
    if (s.recordsOfKey > kRecordsPerKey && SSL_key_update(s.tls.get(), SSL_KEY_UPDATE_NOT_REQUESTED) == 1)
        s.recordsOfKey = 0;
    ERR_clear_error();
    size_t written = 0;
    if (SSL_write_ex(s.tls.get(), s.framed.data(), s.framed.size(), &written) != 1) {
        s.dead = true;
        return Error{"a message cannot be encrypted"};
    }
    return {};
}

void SecureChannel::finish() {
    State& s = *state_;
    const std::lock_guard lock(s.mutex);
    if (!s.opened || s.ended || s.dead) return;
    s.ended = true;
    ERR_clear_error();
    static_cast<void>(SSL_shutdown(s.tls.get())); // close_notify; an error leaves no output
}

std::vector<std::byte> SecureChannel::takeOutput() {
    State& s = *state_;
    const std::lock_guard lock(s.mutex);
    if (s.tls == nullptr) return {};
    BIO* out = SSL_get_wbio(s.tls.get());
    Bytes bytes(BIO_ctrl_pending(out));
    size_t got = 0;
    if (!bytes.empty() && BIO_read_ex(out, bytes.data(), bytes.size(), &got) != 1) got = 0;
    bytes.resize(got);
    return bytes;
}

size_t SecureChannel::wantsBytes() const { return state_->records.missingBytes(); }
bool SecureChannel::open() const { return state_->opened; }
bool SecureChannel::finished() const { return state_->finished; }
const std::string& SecureChannel::name() const { return state_->name; }

} // namespace mural
