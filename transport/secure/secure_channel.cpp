#include "transport/secure/secure_channel.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include <sodium.h>

#include "common/base/little_endian.hpp"

namespace mural {

namespace {

constexpr std::string_view kMagic = "MURALSC1";
constexpr size_t kPublicBytes = crypto_kx_PUBLICKEYBYTES;
constexpr size_t kProofBytes = 32;
constexpr size_t kHeaderBytes = crypto_secretstream_xchacha20poly1305_HEADERBYTES;
constexpr size_t kOverheadBytes = crypto_secretstream_xchacha20poly1305_ABYTES;
constexpr size_t kLengthBytes = 4;

using Bytes = std::vector<std::byte>;
using Hash = std::array<std::byte, kProofBytes>;

unsigned char* raw(std::byte* at) { return reinterpret_cast<unsigned char*>(at); }
const unsigned char* raw(const std::byte* at) { return reinterpret_cast<const unsigned char*>(at); }

Hash keyedHash(const ChannelSecret& secret, std::string_view what, std::span<const std::byte> a,
               std::span<const std::byte> b = {}) {
    Hash hash;
    crypto_generichash_state state;
    crypto_generichash_init(&state, raw(secret.data()), secret.size(), hash.size());
    crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(what.data()), what.size());
    crypto_generichash_update(&state, raw(a.data()), a.size());
    if (!b.empty()) crypto_generichash_update(&state, raw(b.data()), b.size());
    crypto_generichash_final(&state, raw(hash.data()), hash.size());
    return hash;
}

void append(Bytes& to, std::span<const std::byte> bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

} // namespace

struct SecureChannel::State {
    enum class Step { Hello, HostKey, MemberProof, Header, Records, Dead };

    Step step = Step::Hello;
    bool host = false;
    bool canSend = false;
    bool ended = false;    // by us
    bool finished = false; // the peer has finished
    std::string name;
    FindSecret find;
    ChannelSecret secret{};
    std::array<std::byte, kPublicBytes> publicKey{};
    std::array<std::byte, crypto_kx_SECRETKEYBYTES> secretKey{};
    Bytes transcript; // hello and both public keys: the authenticated data
    Bytes in;
    Bytes out;
    std::array<std::byte, crypto_kx_SESSIONKEYBYTES> receiveKey{};
    crypto_secretstream_xchacha20poly1305_state sending{};
    crypto_secretstream_xchacha20poly1305_state receiving{};

    ~State() {
        sodium_memzero(secret.data(), secret.size());
        sodium_memzero(secretKey.data(), secretKey.size());
        sodium_memzero(receiveKey.data(), receiveKey.size());
        sodium_memzero(&sending, sizeof sending);
        sodium_memzero(&receiving, sizeof receiving);
    }

    void makeKeys() { crypto_kx_keypair(raw(publicKey.data()), raw(secretKey.data())); }
    bool agree(std::span<const std::byte> peerKey);
    void startSending(const std::array<std::byte, crypto_kx_SESSIONKEYBYTES>& key);
    [[nodiscard]] size_t stepBytes() const;
    Result<size_t> takeHello(std::vector<Bytes>& messages);
    Result<size_t> takeHostKey();
    Result<size_t> takeMemberProof();
    Result<size_t> takeHeader();
    Result<size_t> takeRecord(std::vector<Bytes>& messages);
    Result<size_t> takeNext(std::vector<Bytes>& messages);
};

// Derives the keys of both directions. Returns false for an invalid peer key (a point of low order).
bool SecureChannel::State::agree(std::span<const std::byte> peerKey) {
    std::array<std::byte, crypto_kx_SESSIONKEYBYTES> receive;
    std::array<std::byte, crypto_kx_SESSIONKEYBYTES> send;
    const auto exchange = host ? crypto_kx_server_session_keys : crypto_kx_client_session_keys;
    if (exchange(raw(receive.data()), raw(send.data()), raw(publicKey.data()), raw(secretKey.data()),
                 raw(peerKey.data())) != 0)
        return false;
    receiveKey = keyedHash(secret, "record", receive, transcript);
    startSending(keyedHash(secret, "record", send, transcript));
    sodium_memzero(receive.data(), receive.size());
    sodium_memzero(send.data(), send.size());
    return true;
}

void SecureChannel::State::startSending(const std::array<std::byte, crypto_kx_SESSIONKEYBYTES>& key) {
    static_assert(kProofBytes == crypto_secretstream_xchacha20poly1305_KEYBYTES);
    std::array<std::byte, kHeaderBytes> header;
    crypto_secretstream_xchacha20poly1305_init_push(&sending, raw(header.data()), raw(key.data()));
    // The member sends its proof first here; the host has already sent its own.
    if (!host) append(out, keyedHash(secret, "member", transcript));
    append(out, header);
    canSend = true;
}

Result<size_t> SecureChannel::State::takeHello(std::vector<Bytes>&) {
    const size_t known = std::min(in.size(), kMagic.size());
    if (std::memcmp(in.data(), kMagic.data(), known) != 0)
        return Error{
            "the peer does not use Mural's secure channel, version 1; check that both ends run the same version"};
    if (in.size() < kMagic.size() + 1) return size_t{0};
    const auto nameBytes = std::to_integer<size_t>(in[kMagic.size()]);
    if (nameBytes > kMaxNameBytes) return Error{"the peer's name is too long; it is not a member of this session"};
    const size_t bytes = kMagic.size() + 1 + nameBytes + kPublicBytes;
    if (in.size() < bytes) return size_t{0};
    name.assign(reinterpret_cast<const char*>(in.data()) + kMagic.size() + 1, nameBytes);
    const auto found = find(name);
    if (!found) return Error{"unknown peer name"};
    secret = *found;
    makeKeys();
    transcript.assign(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(bytes));
    append(transcript, publicKey);
    append(out, publicKey);
    append(out, keyedHash(secret, "host", transcript));
    step = Step::MemberProof;
    return bytes;
}

Result<size_t> SecureChannel::State::takeHostKey() {
    constexpr size_t bytes = kPublicBytes + kProofBytes;
    if (in.size() < bytes) return size_t{0};
    append(transcript, std::span(in).first(kPublicBytes));
    const Hash expected = keyedHash(secret, "host", transcript);
    if (sodium_memcmp(expected.data(), in.data() + kPublicBytes, kProofBytes) != 0)
        return Error{"the host's secret differs; use the same secret at both ends"};
    if (!agree(std::span(in).first(kPublicBytes)))
        return Error{"the host's key is invalid; the connection is rejected"};
    step = Step::Header;
    return bytes;
}

Result<size_t> SecureChannel::State::takeMemberProof() {
    if (in.size() < kProofBytes) return size_t{0};
    const Hash expected = keyedHash(secret, "member", transcript);
    if (sodium_memcmp(expected.data(), in.data(), kProofBytes) != 0)
        return Error{"\"" + name + "\" has another secret; use the same secret at both ends"};
    const auto peerKey = std::span(transcript).subspan(transcript.size() - 2 * kPublicBytes, kPublicBytes);
    if (!agree(peerKey)) return Error{"the key of \"" + name + "\" is invalid; the connection is rejected"};
    step = Step::Header;
    return kProofBytes;
}

Result<size_t> SecureChannel::State::takeHeader() {
    if (in.size() < kHeaderBytes) return size_t{0};
    if (crypto_secretstream_xchacha20poly1305_init_pull(&receiving, raw(in.data()), raw(receiveKey.data())) != 0)
        return Error{"the peer's stream begins with an invalid header"};
    step = Step::Records;
    return kHeaderBytes;
}

Result<size_t> SecureChannel::State::takeRecord(std::vector<Bytes>& messages) {
    if (in.size() < kLengthBytes) return size_t{0};
    const size_t bytes = loadLittle<uint32_t>(in.data());
    if (bytes < kOverheadBytes || bytes > kMaxMessageBytes + kOverheadBytes || finished)
        return Error{"the peer sent an invalid record; it was changed in transit"};
    if (in.size() < kLengthBytes + bytes) return size_t{0};
    Bytes message(bytes - kOverheadBytes);
    unsigned char tag = 0;
    if (crypto_secretstream_xchacha20poly1305_pull(&receiving, raw(message.data()), nullptr, &tag,
                                                   raw(in.data()) + kLengthBytes, bytes, nullptr, 0) != 0)
        return Error{"a record was changed in transit"};
    if (tag == crypto_secretstream_xchacha20poly1305_TAG_FINAL)
        finished = true;
    else
        messages.push_back(std::move(message));
    return kLengthBytes + bytes;
}

Result<size_t> SecureChannel::State::takeNext(std::vector<Bytes>& messages) {
    switch (step) {
    case Step::Hello: return takeHello(messages);
    case Step::HostKey: return takeHostKey();
    case Step::MemberProof: return takeMemberProof();
    case Step::Header: return takeHeader();
    case Step::Records: return takeRecord(messages);
    case Step::Dead: break;
    }
    return Error{"the channel failed earlier"};
}

// Returns the size of the next protocol step, as far as the received data determines it.
size_t SecureChannel::State::stepBytes() const {
    constexpr size_t kHelloHeadBytes = kMagic.size() + 1;
    switch (step) {
    case Step::Hello:
        return in.size() < kHelloHeadBytes
                   ? kHelloHeadBytes
                   : kHelloHeadBytes + std::to_integer<size_t>(in[kMagic.size()]) + kPublicBytes;
    case Step::HostKey: return kPublicBytes + kProofBytes;
    case Step::MemberProof: return kProofBytes;
    case Step::Header: return kHeaderBytes;
    case Step::Records: return in.size() < kLengthBytes ? kLengthBytes : kLengthBytes + loadLittle<uint32_t>(in.data());
    case Step::Dead: break;
    }
    return 1;
}

SecureChannel::SecureChannel(std::unique_ptr<State> state) : state_(std::move(state)) {}
SecureChannel::SecureChannel(SecureChannel&&) noexcept = default;
SecureChannel& SecureChannel::operator=(SecureChannel&&) noexcept = default;
SecureChannel::~SecureChannel() = default;

SecureChannel SecureChannel::connecting(const std::string& name, const ChannelSecret& secret) {
    auto s = std::make_unique<State>();
    s->step = sodium_init() < 0 ? State::Step::Dead : State::Step::HostKey;
    s->name = name.substr(0, kMaxNameBytes);
    s->secret = secret;
    s->makeKeys();
    append(s->transcript, std::as_bytes(std::span(kMagic)));
    s->transcript.push_back(static_cast<std::byte>(s->name.size()));
    append(s->transcript, std::as_bytes(std::span(s->name)));
    append(s->transcript, s->publicKey);
    s->out = s->transcript;
    return SecureChannel(std::move(s));
}

SecureChannel SecureChannel::accepting(FindSecret find) {
    auto s = std::make_unique<State>();
    if (sodium_init() < 0) s->step = State::Step::Dead;
    s->host = true;
    s->find = std::move(find);
    return SecureChannel(std::move(s));
}

Result<void> SecureChannel::input(std::span<const std::byte> bytes, std::vector<Bytes>& messages) {
    State& s = *state_;
    append(s.in, bytes);
    size_t used = 1;
    while (used > 0 && !s.in.empty()) {
        auto taken = s.takeNext(messages);
        if (!taken) {
            s.step = State::Step::Dead;
            s.in.clear();
            return taken.error();
        }
        used = *taken;
        s.in.erase(s.in.begin(), s.in.begin() + static_cast<std::ptrdiff_t>(used));
    }
    return {};
}

Result<void> SecureChannel::send(std::span<const std::byte> message) {
    State& s = *state_;
    if (!s.canSend || s.ended) return Error{"the channel is not open"};
    if (message.size() > kMaxMessageBytes) return Error{"a message exceeds the maximum of 1 MiB"};
    std::array<std::byte, kLengthBytes> length;
    storeLittle(length.data(), static_cast<uint32_t>(message.size() + kOverheadBytes));
    append(s.out, length);
    const size_t at = s.out.size();
    s.out.resize(at + message.size() + kOverheadBytes);
    crypto_secretstream_xchacha20poly1305_push(&s.sending, raw(s.out.data() + at), nullptr, raw(message.data()),
                                               message.size(), nullptr, 0,
                                               crypto_secretstream_xchacha20poly1305_TAG_MESSAGE);
    return {};
}

void SecureChannel::finish() {
    State& s = *state_;
    if (!s.canSend || s.ended) return;
    s.ended = true;
    std::array<std::byte, kLengthBytes + kOverheadBytes> record;
    storeLittle(record.data(), static_cast<uint32_t>(kOverheadBytes));
    crypto_secretstream_xchacha20poly1305_push(&s.sending, raw(record.data() + kLengthBytes), nullptr, nullptr, 0,
                                               nullptr, 0, crypto_secretstream_xchacha20poly1305_TAG_FINAL);
    append(s.out, record);
}

std::vector<std::byte> SecureChannel::takeOutput() { return std::exchange(state_->out, {}); }
size_t SecureChannel::wantsBytes() const {
    return state_->stepBytes() - std::min(state_->in.size(), state_->stepBytes() - 1);
}
bool SecureChannel::open() const { return state_->step == State::Step::Records; }
bool SecureChannel::finished() const { return state_->finished; }
const std::string& SecureChannel::name() const { return state_->name; }

} // namespace mural
