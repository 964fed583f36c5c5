#include "transport/rsp/wire/datagram_cipher.hpp"

#include <sodium.h>

#include "common/base/little_endian.hpp"

namespace mural::rsp {

namespace {

unsigned char* raw(std::span<std::byte> b) { return reinterpret_cast<unsigned char*>(b.data()); }
constexpr size_t kNonceBytes = 12;
static_assert(crypto_aead_aes256gcm_NPUBBYTES == kNonceBytes &&
              crypto_aead_chacha20poly1305_ietf_NPUBBYTES == kNonceBytes);
static_assert(crypto_aead_aes256gcm_ABYTES == 16 && crypto_aead_chacha20poly1305_ietf_ABYTES == 16);
static_assert(crypto_shorthash_BYTES == 8 && crypto_shorthash_KEYBYTES <= kKeyBytes);

// Returns the nonce: the datagram's counter, which is the last eight bytes of its header, and zeros.
std::array<unsigned char, kNonceBytes> nonceOf(std::span<const std::byte> datagram) {
    std::array<unsigned char, kNonceBytes> nonce{};
    std::memcpy(nonce.data(), datagram.data() + 8, 8);
    return nonce;
}

} // namespace

struct DatagramCipher::Prepared {
    crypto_aead_aes256gcm_state state;
};

DatagramCipher::DatagramCipher(Seal seal, const Key& key) : seal_(seal), key_(key) {
    if (seal != Seal::AesGcm) return;
    prepared_ = std::make_unique<Prepared>();
    crypto_aead_aes256gcm_beforenm(&prepared_->state, reinterpret_cast<const unsigned char*>(key.data()));
}

DatagramCipher::~DatagramCipher() {
    sodium_memzero(key_.data(), key_.size());
    if (prepared_) sodium_memzero(prepared_.get(), sizeof *prepared_);
}

void DatagramCipher::seal(std::span<std::byte> datagram) const {
    const auto* key = reinterpret_cast<const unsigned char*>(key_.data());
    const auto covered = datagram.first(datagram.size() - tagBytes(seal_));
    unsigned char* tag = raw(datagram) + covered.size();
    unsigned char* body = raw(datagram) + kHeaderBytes;
    const size_t bodyBytes = covered.size() - kHeaderBytes;
    const auto nonce = nonceOf(datagram);
    switch (seal_) {
    case Seal::None: return;
    case Seal::Tag: crypto_shorthash(tag, raw(datagram), covered.size(), key); return;
    case Seal::AesGcm:
        crypto_aead_aes256gcm_encrypt_detached_afternm(body, tag, nullptr, body, bodyBytes, raw(datagram), kHeaderBytes,
                                                       nullptr, nonce.data(), &prepared_->state);
        return;
    case Seal::ChaCha:
        crypto_aead_chacha20poly1305_ietf_encrypt_detached(body, tag, nullptr, body, bodyBytes, raw(datagram),
                                                           kHeaderBytes, nullptr, nonce.data(), key);
        return;
    }
}

bool DatagramCipher::open(std::span<std::byte> datagram) const {
    if (seal_ == Seal::None) return true;
    const auto* key = reinterpret_cast<const unsigned char*>(key_.data());
    const auto covered = datagram.first(datagram.size() - tagBytes(seal_));
    const unsigned char* tag = raw(datagram) + covered.size();
    unsigned char* body = raw(datagram) + kHeaderBytes;
    const size_t bodyBytes = covered.size() - kHeaderBytes;
    const auto nonce = nonceOf(datagram);
    switch (seal_) {
    case Seal::None: return true;
    case Seal::Tag: {
        std::array<unsigned char, crypto_shorthash_BYTES> expected;
        crypto_shorthash(expected.data(), raw(datagram), covered.size(), key);
        return sodium_memcmp(expected.data(), tag, expected.size()) == 0;
    }
    case Seal::AesGcm:
        return crypto_aead_aes256gcm_decrypt_detached_afternm(body, nullptr, body, bodyBytes, tag, raw(datagram),
                                                              kHeaderBytes, nonce.data(), &prepared_->state) == 0;
    case Seal::ChaCha:
        return crypto_aead_chacha20poly1305_ietf_decrypt_detached(body, nullptr, body, bodyBytes, tag, raw(datagram),
                                                                  kHeaderBytes, nonce.data(), key) == 0;
    }
    return false;
}

DatagramSealer::DatagramSealer(const SessionKeys& keys, MemberId self)
    : cipher_(keys.seal, memberKey(keys, self)), session_(static_cast<uint32_t>(keys.session)) {}

void DatagramSealer::seal(std::span<std::byte> datagram) {
    storeLittle(datagram.data() + 4, session_);
    storeLittle(datagram.data() + 8, ++counter_);
    cipher_.seal(datagram);
}

bool ReplayWindow::fresh(uint64_t counter) const {
    if (counter > newest_) return true;
    return newest_ - counter < kSize && counter != 0 && !seen_[counter % kSize];
}

void ReplayWindow::came(uint64_t counter) {
    if (counter > newest_) {
        if (counter - newest_ >= kSize) {
            seen_.reset();
        } else {
            for (uint64_t c = newest_ + 1; c < counter; ++c) seen_.reset(c % kSize);
        }
        newest_ = counter;
    }
    seen_.set(counter % kSize);
}

DatagramOpener::DatagramOpener(const SessionKeys& keys) : keys_(keys) {}

void DatagramOpener::addMember(MemberId id) {
    if (members_.contains(id)) return; // keeps the replay window
    auto member = std::unique_ptr<Member>(new Member{{keys_.seal, memberKey(keys_, id)}, {}});
    members_.emplace(id, std::move(member));
}

void DatagramOpener::removeMember(MemberId id) {
    latest_ = nullptr;
    members_.erase(id);
}

DatagramOpener::Member* DatagramOpener::member(MemberId id) {
    if (latest_ && latestId_ == id) return latest_;
    const auto found = members_.find(id);
    latestId_ = id;
    latest_ = found == members_.end() ? nullptr : found->second.get();
    return latest_;
}

std::span<const std::byte> DatagramOpener::open(std::span<std::byte> datagram) {
    const size_t tag = tagBytes(keys_.seal);
    if (datagram.size() < kHeaderBytes + tag) return ++refused_.tooShort, std::span<const std::byte>{};
    const auto header = readHeader(datagram);
    if (!header) return ++refused_.version, std::span<const std::byte>{};
    if (header->session != static_cast<uint32_t>(keys_.session))
        return ++refused_.session, std::span<const std::byte>{};
    Member* const m = member(header->from);
    if (!m) return ++refused_.stranger, std::span<const std::byte>{};
    if (!m->window.fresh(header->counter)) return ++refused_.replayed, std::span<const std::byte>{};
    if (!m->cipher.open(datagram)) return ++refused_.forged, std::span<const std::byte>{};
    m->window.came(header->counter);
    return datagram.first(datagram.size() - tag);
}

} // namespace mural::rsp
