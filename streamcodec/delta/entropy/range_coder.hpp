// Adaptive binary range coder (LZMA-style): predicted bits cost next to nothing, and a small batch needs no tables.
// Writer and reader have the same interface, so one template codes both directions and they cannot diverge. The reader
// ignores value arguments and returns the decoded values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::delta {

// Probability of a 0 bit. Adapts fast at first, later by 1/32 of the error.
class BitModel {
public:
    [[nodiscard]] uint32_t zero() const { return zero_; } // of 65536
    void update(bool bit) {
        static constexpr std::array<uint16_t, 16> kShares{26214, 18724, 14563, 11915, 10082, 8738, 7710, 6898,
                                                          5957,  5041,  4369,  3855,  3277,  2849, 2427, 2048};
        const int32_t wrong = (bit ? kMin : kMax) - zero_;
        zero_ = static_cast<uint16_t>(zero_ + wrong * kShares[seen_] / 65536);
        seen_ = static_cast<uint16_t>(seen_ + (seen_ + 1u < kShares.size()));
    }

private:
    static constexpr int32_t kMin = 24, kMax = 65536 - kMin;
    uint16_t zero_ = 32768;
    uint16_t seen_ = 0;
};

// One of 16 symbols by frequency: one branch-free step instead of four binary ones.
class SymbolModel {
public:
    static constexpr uint32_t kBits = 14, kSymbols = 16;

    [[nodiscard]] uint32_t from(uint32_t symbol) const { return static_cast<uint32_t>(from_[symbol]); }
    [[nodiscard]] uint32_t to(uint32_t symbol) const { return symbol + 1 == kSymbols ? 1u << kBits : from(symbol + 1); }
    [[nodiscard]] uint32_t at(uint32_t position) const {
        // larger values are malformed
        const auto there = static_cast<int16_t>(position < 1u << kBits ? position : (1u << kBits) - 1);
        uint32_t symbols = 0; // with 16 bits GCC 12 returns the negative count at -O3
        for (const int16_t from : from_) symbols += from <= there ? 1 : 0;
        return symbols - 1;
    }
    void update(uint32_t symbol) {
        const int rate = kRates[seen_ >> 2];
        seen_ = static_cast<uint8_t>(seen_ + (seen_ + 1u < 4 * kRates.size()));
        const std::array<int16_t, kSymbols>& goals = kGoals[symbol];
        for (uint32_t i = 0; i < kSymbols; ++i)
            from_[i] = static_cast<int16_t>(from_[i] + (static_cast<int16_t>(goals[i] - from_[i]) >> rate));
    }

private:
    // Target distribution per symbol: the symbol dominates, and every other symbol stays possible.
    static constexpr auto kGoals = [] {
        constexpr int kMin = 4;
        std::array<std::array<int16_t, kSymbols>, kSymbols> goals{};
        for (uint32_t symbol = 0; symbol < kSymbols; ++symbol)
            for (uint32_t i = 0; i < kSymbols; ++i)
                goals[symbol][i] = static_cast<int16_t>(
                    static_cast<int>(i) * kMin + (i <= symbol ? 0 : (1 << kBits) - kMin * static_cast<int>(kSymbols)));
        return goals;
    }();
    static constexpr std::array<uint8_t, 6> kRates{2, 3, 3, 4, 4, 5};
    std::array<int16_t, kSymbols> from_{0,    1024, 2048,  3072,  4096,  5120,  6144,  7168,
                                        8192, 9216, 10240, 11264, 12288, 13312, 14336, 15360};
    uint8_t seen_ = 0;
};

constexpr uint32_t kMinRange = 1u << 24;

class RangeWriter {
public:
    static constexpr bool kReads = false;

    bool code(BitModel& model, bool bit) {
        const uint32_t bound = (range_ >> 16) * model.zero();
        low_ += bit ? bound : 0;
        range_ = bit ? range_ - bound : bound;
        model.update(bit);
        settle();
        return bit;
    }
    uint32_t code(SymbolModel& model, uint32_t symbol) {
        const uint32_t from = model.from(symbol), part = range_ >> SymbolModel::kBits;
        low_ += uint64_t{part} * from;
        range_ = part * (model.to(symbol) - from);
        model.update(symbol);
        settle();
        return symbol;
    }
    // Codes 1 to 16 bits with equal probabilities.
    uint32_t code(uint32_t value, unsigned bits) {
        range_ >>= bits;
        low_ += uint64_t{range_} * value;
        settle();
        return value;
    }
    // Ends the data; clear() starts again. The reader assumes zeros after the end.
    std::span<const std::byte> finish() {
        for (unsigned count = 0; count <= 4; ++count) {
            const uint64_t rest = (uint64_t{1} << (32 - 8 * count)) - 1, value = (low_ + rest) & ~rest;
            if (value > low_ + range_ - 1) continue;
            low_ = value;
            carry();
            for (unsigned i = 0; i < count; ++i) bytes_.push_back(static_cast<std::byte>(low_ >> (24 - 8 * i)));
            break;
        }
        low_ = 0;
        return bytes_;
    }
    void clear() {
        bytes_.clear();
        low_ = 0;
        range_ = UINT32_MAX;
    }
    [[nodiscard]] size_t sizeBytes() const { return bytes_.size(); }
    [[nodiscard]] bool bad() const { return false; }

private:
    void settle() {
        while (range_ < kMinRange) {
            carry();
            bytes_.push_back(static_cast<std::byte>(low_ >> 24));
            low_ = low_ << 8 & UINT32_MAX;
            range_ <<= 8;
        }
    }
    void carry() {
        if (low_ <= UINT32_MAX) return;
        low_ &= UINT32_MAX;
        for (size_t i = bytes_.size(); i > 0; --i) {
            bytes_[i - 1] = static_cast<std::byte>(static_cast<uint32_t>(bytes_[i - 1]) + 1);
            if (bytes_[i - 1] != std::byte{0}) return;
        }
    }

    std::vector<std::byte> bytes_;
    uint64_t low_ = 0; // 33 bits; the top bit is the carry
    uint32_t range_ = UINT32_MAX;
};

// Accepts any input. bad() is true after the end.
class RangeReader {
public:
    static constexpr bool kReads = true;

    explicit RangeReader(std::span<const std::byte> bytes = {}) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
    }
    bool code(BitModel& model, bool) {
        const uint32_t bound = (range_ >> 16) * model.zero();
        const bool bit = code_ >= bound;
        code_ -= bit ? bound : 0;
        range_ = bit ? range_ - bound : bound;
        model.update(bit);
        settle();
        return bit;
    }
    uint32_t code(SymbolModel& model, uint32_t) {
        const uint32_t part = range_ >> SymbolModel::kBits, symbol = model.at(code_ / part), from = model.from(symbol);
        code_ -= part * from;
        range_ = part * (model.to(symbol) - from);
        model.update(symbol);
        settle();
        return symbol;
    }
    uint32_t code(uint32_t, unsigned bits) {
        range_ >>= bits;
        uint32_t value = code_ / range_;
        if (value >> bits != 0) value = (1u << bits) - 1; // malformed input
        code_ -= value * range_;
        settle();
        return value;
    }
    // Returns true if more was read than the writer may omit.
    [[nodiscard]] bool bad() const { return at_ > bytes_.size() + 4; }

private:
    void settle() {
        for (; range_ < kMinRange; range_ <<= 8) code_ = code_ << 8 | next();
    }
    uint32_t next() {
        const uint32_t byte = at_ < bytes_.size() ? static_cast<uint32_t>(bytes_[at_]) : 0;
        ++at_;
        return byte;
    }

    std::span<const std::byte> bytes_;
    size_t at_ = 0;
    uint32_t code_ = 0;
    uint32_t range_ = UINT32_MAX;
};

// A byte: the low half is coded in the context of the high half.
class ByteModel {
public:
    template <class Coder> uint32_t code(Coder& coder, uint32_t value) {
        const uint32_t high = coder.code(high_, value >> 4);
        return high << 4 | coder.code(low_[high], value & 15);
    }

private:
    SymbolModel high_;
    std::array<SymbolModel, SymbolModel::kSymbols> low_;
};

} // namespace mural::delta
