// Authenticated encryption of datagrams, with replay protection. An attacker without a session key cannot inject,
// change or (with encryption) read a datagram.
//
// The header (16 bytes) is readable and authenticated; the body is encrypted. The counter is the nonce: each member
// counts its datagrams with its own key. Checks run in this order: length, version, session, member, counter, tag. A
// failed check is counted and ends the processing.
#pragma once

#include <array>
#include <bitset>
#include <map>
#include <memory>
#include <span>

#include "transport/rsp/wire/keys.hpp"

namespace mural::rsp {

// The cipher with one key; operates in place.
class DatagramCipher {
public:
    DatagramCipher(Seal seal, const Key& key);
    ~DatagramCipher();
    DatagramCipher(const DatagramCipher&) = delete;
    DatagramCipher& operator=(const DatagramCipher&) = delete;

    // Fills the datagram's last tagBytes().
    void seal(std::span<std::byte> datagram) const;
    [[nodiscard]] bool open(std::span<std::byte> datagram) const;

private:
    struct Prepared;
    Seal seal_;
    Key key_;
    std::unique_ptr<Prepared> prepared_; // AES: key schedule
};

class DatagramSealer {
public:
    DatagramSealer(const SessionKeys& keys, MemberId self);
    // Sets session and counter, and seals. Requires room for the tag at the end of `datagram`.
    void seal(std::span<std::byte> datagram);

private:
    DatagramCipher cipher_;
    uint32_t session_;
    uint64_t counter_ = 0;
};

// Replay window of one member: tracks single counters within a window below the newest.
class ReplayWindow {
public:
    [[nodiscard]] bool fresh(uint64_t counter) const;
    // Records a counter that is not a replay.
    void came(uint64_t counter);

private:
    static constexpr uint64_t kSize = 8192;
    std::bitset<kSize> seen_;
    uint64_t newest_ = 0; // counters start at 1
};

struct RefusedDatagrams {
    uint64_t tooShort = 0;
    uint64_t version = 0;
    uint64_t session = 0;
    uint64_t stranger = 0; // unknown member
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
    // Returns the datagram without its tag, decrypted in place; empty if it is rejected.
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
    MemberId latestId_ = 0; // cache: the next datagram is usually from the same member
    Member* latest_ = nullptr;
    RefusedDatagrams refused_;
};

} // namespace mural::rsp
