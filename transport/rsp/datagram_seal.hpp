// The seal of datagrams: who has no key of the session can neither add, change nor (when encrypted) read one, and no one
// can send an old one again.
//
// The head (16 bytes) stays readable and is part of what the seal proves; what follows is encrypted. The counter is the
// nonce: each member counts its datagrams with a key of its own. Order of checks: length, version, session, member,
// counter, seal; what fails is counted and not looked at further.
#pragma once

#include <array>
#include <bitset>
#include <map>
#include <memory>
#include <span>

#include "transport/rsp/keys.hpp"

namespace mural::rsp {

// What seals need of the cipher: one key, used in place.
class DatagramCipher {
public:
    DatagramCipher(Seal seal, const Key& key);
    ~DatagramCipher();
    DatagramCipher(const DatagramCipher&) = delete;
    DatagramCipher& operator=(const DatagramCipher&) = delete;

    // The datagram's last tagBytes() are filled.
    void seal(std::span<std::byte> datagram) const;
    [[nodiscard]] bool open(std::span<std::byte> datagram) const;

private:
    struct Prepared;
    Seal seal_;
    Key key_;
    std::unique_ptr<Prepared> prepared_; // AES: the key's schedule
};

class DatagramSealer {
public:
    DatagramSealer(const SessionKeys& keys, MemberId self);
    // Fills in session and counter and seals. `datagram` has room for the tag at its end.
    void seal(std::span<std::byte> datagram);

private:
    DatagramCipher cipher_;
    uint32_t session_;
    uint64_t counter_ = 0;
};

// Which counters of one member have come: all within a window behind the newest are told apart.
class ReplayWindow {
public:
    [[nodiscard]] bool fresh(uint64_t counter) const;
    // One that is fresh.
    void came(uint64_t counter);

private:
    static constexpr uint64_t kSize = 8192;
    std::bitset<kSize> seen_;
    uint64_t newest_ = 0; // counters begin with 1
};

struct RefusedDatagrams {
    uint64_t tooShort = 0;
    uint64_t version = 0;
    uint64_t session = 0;
    uint64_t stranger = 0; // of no member
    uint64_t replayed = 0;
    uint64_t forged = 0;
    [[nodiscard]] uint64_t all() const { return tooShort + version + session + stranger + replayed + forged; }
};

class DatagramOpener {
public:
    explicit DatagramOpener(const SessionKeys& keys);

    [[nodiscard]] Seal seals() const { return keys_.seal; }
    void addMember(MemberId id);
    void removeMember(MemberId id);
    // The datagram without its tag, decrypted in place; empty when it is refused.
    std::span<const std::byte> open(std::span<std::byte> datagram);
    [[nodiscard]] const RefusedDatagrams& refused() const { return refused_; }

private:
    struct Member {
        DatagramCipher cipher;
        ReplayWindow window;
    };
    Member* member(MemberId id);

    SessionKeys keys_;
    std::map<MemberId, std::unique_ptr<Member>> members_;
    MemberId latestId_ = 0; // most datagrams are followed by another one of the same member
    Member* latest_ = nullptr;
    RefusedDatagrams refused_;
};

} // namespace mural::rsp
