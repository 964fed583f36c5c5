// A set of values of a small enumeration, as bits: eyes, buffers, tasks.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace mural {

template <class E> class EnumSet {
public:
    constexpr EnumSet() = default;
    constexpr EnumSet(std::initializer_list<E> values) {
        for (const E value : values) add(value);
    }
    constexpr void add(E value) { bits_ |= bit(value); }
    constexpr void remove(E value) { bits_ &= ~bit(value); }
    [[nodiscard]] constexpr bool has(E value) const { return (bits_ & bit(value)) != 0; }
    [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }
    [[nodiscard]] constexpr uint32_t bits() const { return bits_; }
    friend constexpr EnumSet operator&(EnumSet a, EnumSet b) { return fromBits(a.bits_ & b.bits_); }
    friend constexpr EnumSet operator|(EnumSet a, EnumSet b) { return fromBits(a.bits_ | b.bits_); }
    friend constexpr bool operator==(EnumSet, EnumSet) = default;

private:
    static constexpr uint32_t bit(E value) { return 1u << static_cast<unsigned>(value); }
    static constexpr EnumSet fromBits(uint32_t bits) {
        EnumSet set;
        set.bits_ = bits;
        return set;
    }
    uint32_t bits_ = 0;
};

} // namespace mural
