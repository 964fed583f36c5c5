// Random numbers that depend only on a seed.
#pragma once

#include <cstdint>

namespace fuzz {

class Random {
public:
    Random(std::uint64_t seed, std::uint64_t step) : state_(seed * 0x9e3779b97f4a7c15U + step * 0xd1342543de82ef95U) {
        next();
    }

    std::uint32_t next() {
        state_ += 0x9e3779b97f4a7c15U; // splitmix64
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 16);
    }

    std::uint32_t below(std::uint32_t limit) { return limit == 0 ? 0 : next() % limit; }
    int between(int low, int high) { return low + static_cast<int>(below(static_cast<std::uint32_t>(high - low + 1))); }
    bool chance(std::uint32_t percent) { return below(100) < percent; }
    float unit() { return static_cast<float>(below(1025)) / 1024.0F; } // 0 to 1
    float around() { return unit() * 2.4F - 1.2F; }

    template <class T, std::size_t N> const T& of(const T (&values)[N]) { return values[below(N)]; }

private:
    std::uint64_t state_;
};

} // namespace fuzz
