// Messages over a byte stream that only the two who share a secret can read or write. Without sockets: bytes come in and
// go out.
//
//   member → host   "MURALSC1", u8 length and name of the member, an X25519 key for this once (32 bytes)
//   host → member   its key (32), proof (32): BLAKE2b keyed with the secret, of "host" and all before
//   member → host   proof (32): of "member" and all before
//   both            stream header (24), then records: u32 little-endian length, XChaCha20-Poly1305 of a secretstream
//
// Keys of the records come from the exchange and the secret: who learns the secret later can't read what was recorded.
// A name tells the host which secret to expect; it is not hidden.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace mural {

constexpr size_t kChannelSecretBytes = 32;
using ChannelSecret = std::array<std::byte, kChannelSecretBytes>;

class SecureChannel {
public:
    using FindSecret = std::function<std::optional<ChannelSecret>(const std::string& name)>;
    static constexpr size_t kMostMessageBytes = size_t{1} << 20;
    static constexpr size_t kMostNameBytes = 64;

    // The member's end, and the host's.
    static SecureChannel connecting(const std::string& name, const ChannelSecret& secret);
    static SecureChannel accepting(FindSecret find);
    SecureChannel(SecureChannel&&) noexcept;
    SecureChannel& operator=(SecureChannel&&) noexcept;
    ~SecureChannel();

    // Takes bytes of the peer, in pieces of any size, and appends the messages that are whole. After an error the
    // channel is dead; what came before it was genuine.
    Result<void> input(std::span<const std::byte> bytes, std::vector<std::vector<std::byte>>& messages);
    // Errors: the message is too long, the channel is not open, or ended.
    Result<void> send(std::span<const std::byte> message);
    // How many more bytes of the peer it can't do without: less make no message whole, and bring no step further.
    [[nodiscard]] size_t wantsBytes() const;
    // The last that is sent; the peer can tell it from a connection that was cut.
    void finish();
    // What is to be written to the peer now.
    [[nodiscard]] std::vector<std::byte> takeOutput();

    // The peer has shown that it knows the secret.
    [[nodiscard]] bool open() const;
    [[nodiscard]] bool finished() const; // by the peer
    [[nodiscard]] const std::string& name() const; // of the member, at both ends

private:
    struct State;
    explicit SecureChannel(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace mural
