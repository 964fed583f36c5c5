#include "transport/rsp/wire/keys.hpp"

#include <sodium.h>

namespace mural::rsp {

namespace {
// crypto_kdf's context: eight letters that separate these keys from all others.
constexpr char kContext[crypto_kdf_CONTEXTBYTES + 1] = "muralrsp";
static_assert(kKeyBytes == crypto_kdf_KEYBYTES);
} // namespace

const char* nameOf(Seal seal) {
    switch (seal) {
    case Seal::None: return "none";
    case Seal::Tag: return "siphash";
    case Seal::AesGcm: return "aes-256-gcm";
    case Seal::ChaCha: return "chacha20-poly1305";
    }
    return "?";
}

bool available(Seal seal) {
    if (sodium_init() < 0) return seal == Seal::None;
    return seal != Seal::AesGcm || crypto_aead_aes256gcm_is_available() != 0;
}

Seal bestEncryption() { return available(Seal::AesGcm) ? Seal::AesGcm : Seal::ChaCha; }

SessionKeys makeSessionKeys(Seal seal) {
    SessionKeys keys;
    keys.seal = seal;
    if (sodium_init() < 0) return keys;
    randombytes_buf(&keys.session, sizeof keys.session);
    randombytes_buf(keys.secret.data(), keys.secret.size());
    return keys;
}

Key memberKey(const SessionKeys& keys, MemberId member) {
    Key key;
    crypto_kdf_derive_from_key(reinterpret_cast<unsigned char*>(key.data()), key.size(), member, kContext,
                               reinterpret_cast<const unsigned char*>(keys.secret.data()));
    return key;
}

} // namespace mural::rsp
