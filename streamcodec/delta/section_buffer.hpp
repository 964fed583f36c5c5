// Collects the bytes of one section. A large upload often arrives as a packet with a single piece; alone in the section
// it is borrowed, not copied, because the compressor copies it anyway.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mural::delta {

class SectionBuffer {
public:
    void add(std::span<const std::byte> bytes) {
        own();
        own_.insert(own_.end(), bytes.begin(), bytes.end());
    }
    // Like add(), but borrows the bytes: they must stay valid until own() or clear().
    void lend(std::span<const std::byte> bytes) {
        if (!own_.empty() || !lent_.empty() || bytes.size() < kWorthBytes) return add(bytes);
        lent_ = bytes;
    }
    // Copies borrowed bytes before they become invalid.
    void own() {
        own_.insert(own_.end(), lent_.begin(), lent_.end());
        lent_ = {};
    }
    void clear() {
        own_.clear();
        lent_ = {};
    }
    // Returns the buffer for appending.
    [[nodiscard]] std::vector<std::byte>& owned() {
        own();
        return own_;
    }
    [[nodiscard]] std::span<const std::byte> bytes() const {
        return lent_.empty() ? std::span<const std::byte>(own_) : lent_;
    }
    [[nodiscard]] size_t size() const { return bytes().size(); }

private:
    static constexpr size_t kWorthBytes = 16384;

    std::vector<std::byte> own_;
    std::span<const std::byte> lent_; // own_ is empty while this is set
};

} // namespace mural::delta
