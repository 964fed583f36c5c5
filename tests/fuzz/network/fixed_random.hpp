// Replaces libsodium's random numbers with a fixed sequence, so that an input has the same effect each time.
#pragma once

#include <random>

#include <sodium.h>

namespace mural::fuzz {

inline std::mt19937& fixedRandomState() {
    static std::mt19937 state;
    return state;
}

// Restarts the sequence. Called before the first use of libsodium, and at the beginning of each input.
inline void fixRandom() {
    static randombytes_implementation fixed = [] {
        randombytes_implementation r{};
        r.implementation_name = [] { return "fixed"; };
        r.random = [] { return static_cast<uint32_t>(fixedRandomState()()); };
        r.buf = [](void* into, size_t bytes) {
            for (size_t i = 0; i < bytes; ++i)
                static_cast<unsigned char*>(into)[i] = static_cast<unsigned char>(fixedRandomState()());
        };
        return r;
    }();
    static const int set = randombytes_set_implementation(&fixed);
    static const int ready = set == 0 ? sodium_init() : -1;
    if (ready < 0) std::abort();
    fixedRandomState().seed(1);
}

} // namespace mural::fuzz
