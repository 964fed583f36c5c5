// Sequence number of a datagram: 32 bits with wrap-around. The shorter distance orders two numbers (RFC 1982), so a
// window is limited to 2^31; windows here hold 2^13.
#pragma once

#include <cstdint>

namespace mural::rsp {

class Sequence {
public:
    constexpr Sequence() = default;
    constexpr explicit Sequence(uint32_t value) : value_(value) {}

    [[nodiscard]] constexpr uint32_t value() const { return value_; }

    constexpr Sequence& operator++() {
        ++value_;
        return *this;
    }
    constexpr Sequence& operator+=(int64_t n) {
        value_ += static_cast<uint32_t>(n);
        return *this;
    }
    friend constexpr Sequence operator+(Sequence s, int64_t n) { return s += n; }
    friend constexpr Sequence operator-(Sequence s, int64_t n) { return s += -n; }
    // Returns the distance from b to a; negative if a precedes b.
    friend constexpr int64_t operator-(Sequence a, Sequence b) { return static_cast<int32_t>(a.value_ - b.value_); }

    friend constexpr bool operator==(Sequence a, Sequence b) = default;
    friend constexpr bool operator<(Sequence a, Sequence b) { return a - b < 0; }
    friend constexpr bool operator>(Sequence a, Sequence b) { return b < a; }
    friend constexpr bool operator<=(Sequence a, Sequence b) { return !(b < a); }
    friend constexpr bool operator>=(Sequence a, Sequence b) { return !(a < b); }

private:
    uint32_t value_ = 0;
};

constexpr Sequence later(Sequence a, Sequence b) { return a < b ? b : a; }
constexpr Sequence earlier(Sequence a, Sequence b) { return a < b ? a : b; }

} // namespace mural::rsp
