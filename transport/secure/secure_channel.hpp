// Messages over a byte stream, readable and writable only for the two owners of a shared secret. The protocol is
// TLS 1.3 (RFC 8446) with an external pre-shared key and an ephemeral X25519 exchange (psk_dhe_ke). OpenSSL implements
// it. Has no sockets: bytes in, bytes out.
//
// The member is the TLS client, and its name is the identity of the key. The name selects the secret at the host and is
// not hidden. Certificates are not used. Within TLS a message is a u32 little-endian length and its bytes.
//
// Thread safety: one thread may call input() and wantsBytes() while another calls send(), finish() and takeOutput().
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
    // RFC 8446 section 5.5 limits a key of AES-GCM to 2^24.5 records. The sender changes its key long before.
    static constexpr uint64_t kRecordsPerKey = uint64_t{1} << 18;

    // The member's end, and the host's end. The name must not be empty; it is cut at kMaxNameBytes.
    static SecureChannel connecting(const std::string& name, const ChannelSecret& secret);
    static SecureChannel accepting(FindSecret find);
    SecureChannel(SecureChannel&&) noexcept;
    SecureChannel& operator=(SecureChannel&&) noexcept;
    ~SecureChannel();

    // Processes bytes of the peer, in pieces of any size, and appends complete messages. After an error the channel is
    // unusable; earlier messages are authentic. takeOutput() then has an alert, by which the peer learns of the error.
    Result<void> input(std::span<const std::byte> bytes, std::vector<std::vector<std::byte>>& messages);
    // Errors: the message is too long; the channel is not open, or has ended.
    Result<void> send(std::span<const std::byte> message);
    // Returns the number of bytes that complete the current TLS record, or its header.
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
