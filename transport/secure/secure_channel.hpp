// Messages over a byte stream, readable and writable only for the two owners of a shared secret. Has no sockets: bytes
// in, bytes out.
//
//   member to host  "MURALSC1", u8 length and name of the member, an ephemeral X25519 key (32 bytes)
//   host to member  its key (32), proof (32): BLAKE2b keyed with the secret, of "host" and everything before
//   member to host  proof (32): of "member" and everything before
//   both            stream header (24), then records: u32 little-endian length, XChaCha20-Poly1305 secretstream
//
// The keys of the records come from the exchange and the secret, which gives forward secrecy. The name selects the
// secret at the host and is not hidden.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

constexpr size_t kChannelSecretBytes = 32;
using ChannelSecret = std::array<std::byte, kChannelSecretBytes>;

class SecureChannel {
public:
    using FindSecret = std::function<std::optional<ChannelSecret>(const std::string& name)>;
    static constexpr size_t kMaxMessageBytes = size_t{1} << 20;
    static constexpr size_t kMaxNameBytes = 64;

    // The member's end, and the host's end.
    static SecureChannel connecting(const std::string& name, const ChannelSecret& secret);
    static SecureChannel accepting(FindSecret find);
    SecureChannel(SecureChannel&&) noexcept;
    SecureChannel& operator=(SecureChannel&&) noexcept;
    ~SecureChannel();

    // Processes bytes of the peer, in pieces of any size, and appends complete messages. After an error the channel is
    // unusable; earlier messages are authentic.
    Result<void> input(std::span<const std::byte> bytes, std::vector<std::vector<std::byte>>& messages);
    // Errors: the message is too long; the channel is not open, or has ended.
    Result<void> send(std::span<const std::byte> message);
    // Returns the number of bytes required for the next message or step.
    [[nodiscard]] size_t wantsBytes() const;
    // Sends the final message, which distinguishes an orderly end from a broken connection.
    void finish();
    // Returns the bytes to write to the peer now.
    [[nodiscard]] std::vector<std::byte> takeOutput();

    // Returns true after the peer has proven that it knows the secret.
    [[nodiscard]] bool open() const;
    [[nodiscard]] bool finished() const;           // the peer has finished
    [[nodiscard]] const std::string& name() const; // name of the member, at both ends

private:
    struct State;
    explicit SecureChannel(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace mural
