// Building blocks of messages: numbers of variable length (LEB128), fixed-size values, and byte strings.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <mural/archive/byte_buffer.hpp>

namespace mural::objects {

class MessageWriter {
public:
    explicit MessageWriter(archive::ByteBuffer& out) : out_(out) {}

    void byte(uint8_t value) { fixed(value); }
    // Small numbers take few bytes: 7 bits per byte.
    void number(uint64_t value) {
        for (; value >= 0x80; value >>= 7) byte(static_cast<uint8_t>(value | 0x80));
        byte(static_cast<uint8_t>(value));
    }
    template <class T> void fixed(const T& value) { std::memcpy(out_.grow(sizeof(T)), &value, sizeof(T)); }
    void raw(std::span<const std::byte> bytes) { out_.append(bytes.data(), bytes.size()); }
    void sized(std::span<const std::byte> bytes) {
        number(bytes.size());
        raw(bytes);
    }
    void text(std::string_view text) { sized(std::as_bytes(std::span(text))); }

private:
    archive::ByteBuffer& out_;
};

// Reads never pass the end. After the first error all reads return zeros.
class MessageReader {
public:
    explicit MessageReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    uint8_t byte() { return fixed<uint8_t>(); }
    uint64_t number() {
        uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const uint8_t next = byte();
            const uint64_t bits = next & 0x7fU;
            if (shift == 63 && bits > 1) break; // beyond 64 bits
            value |= bits << shift;
            if ((next & 0x80U) == 0) return value;
        }
        fail();
        return 0;
    }
    // Reads a number and fails above `most`.
    uint64_t numberUpTo(uint64_t most) {
        const uint64_t value = number();
        if (value <= most) return value;
        fail();
        return 0;
    }
    template <class T> T fixed() {
        T value{};
        const auto bytes = raw(sizeof(T));
        if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof(T));
        return value;
    }
    // Returns a part of the message, without a copy; empty after an error.
    std::span<const std::byte> raw(size_t count) {
        if (count > rest_.size()) {
            fail();
            return {};
        }
        const auto bytes = rest_.first(count);
        rest_ = rest_.subspan(count);
        return bytes;
    }
    std::span<const std::byte> sized() { return raw(static_cast<size_t>(numberUpTo(rest_.size()))); }
    std::string text(size_t most) {
        const auto bytes = raw(static_cast<size_t>(numberUpTo(most)));
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    std::span<const std::byte> rest() { return raw(rest_.size()); }

    void fail() {
        isOk_ = false;
        rest_ = {};
    }
    [[nodiscard]] bool ok() const { return isOk_; }
    // True if the message was read without errors up to its end.
    [[nodiscard]] bool atEnd() const { return isOk_ && rest_.empty(); }

private:
    std::span<const std::byte> rest_;
    bool isOk_ = true;
};

} // namespace mural::objects
