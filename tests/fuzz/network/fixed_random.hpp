// Replaces the random numbers of libsodium and OpenSSL with a fixed sequence, so that an input has the same effect each
// time.
#pragma once

#include <random>

#define OPENSSL_SUPPRESS_DEPRECATED // RAND_set_rand_method; its successor is a provider of 200 lines
#include <openssl/rand.h>
#include <sodium.h>

namespace mural::fuzz {

inline std::mt19937& fixedRandomState() {
    static std::mt19937 state;
    return state;
}

inline void fillFromSequence(unsigned char* into, size_t bytes) {
    for (size_t i = 0; i < bytes; ++i) into[i] = static_cast<unsigned char>(fixedRandomState()());
}

inline int fixOpenSslRandom() {
    static RAND_METHOD fixed = [] {
        RAND_METHOD m{};
        m.bytes = m.pseudorand = [](unsigned char* into, int bytes) {
            fillFromSequence(into, static_cast<size_t>(bytes));
            return 1;
        };
        m.status = [] { return 1; };
        return m;
    }();
    return RAND_set_rand_method(&fixed);
}

// Restarts the sequence. Called before the first use of the libraries, and at the beginning of each input.
inline void fixRandom() {
    static randombytes_implementation fixed = [] {
        randombytes_implementation r{};
        r.implementation_name = [] { return "fixed"; };
        r.random = [] { return static_cast<uint32_t>(fixedRandomState()()); };
        r.buf = [](void* into, size_t bytes) { fillFromSequence(static_cast<unsigned char*>(into), bytes); };
        return r;
    }();
    static const int set = randombytes_set_implementation(&fixed);
    static const int ready = set == 0 && fixOpenSslRandom() == 1 ? sodium_init() : -1;
    if (ready < 0) std::abort();
    fixedRandomState().seed(1);
}

} // namespace mural::fuzz
