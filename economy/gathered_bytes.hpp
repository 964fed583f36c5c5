// Bytes of one kind for a batch, one behind the other. What a program loads comes in packets that are one such piece: while it is alone,
// it is not copied, as whoever compresses it copies it anyway.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mural::economy {

class GatheredBytes {
public:
    void add(std::span<const std::byte> bytes) {
        own();
        own_.insert(own_.end(), bytes.begin(), bytes.end());
    }
    // As add(), but the bytes stay where they are until own() or clear().
    void lend(std::span<const std::byte> bytes) {
        if (!own_.empty() || !lent_.empty() || bytes.size() < kWorthBytes) return add(bytes);
        lent_ = bytes;
    }
    // What was lent goes away.
    void own() {
        own_.insert(own_.end(), lent_.begin(), lent_.end());
        lent_ = {};
    }
    void clear() {
        own_.clear();
        lent_ = {};
    }
    // To write in it.
    [[nodiscard]] std::vector<std::byte>& owned() {
        own();
        return own_;
    }
    [[nodiscard]] std::span<const std::byte> bytes() const { return lent_.empty() ? std::span<const std::byte>(own_) : lent_; }
    [[nodiscard]] size_t size() const { return bytes().size(); }

private:
    static constexpr size_t kWorthBytes = 16384;

    std::vector<std::byte> own_;
    std::span<const std::byte> lent_; // then own_ is empty
};

} // namespace mural::economy
