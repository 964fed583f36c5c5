// One line to the user's stderr, by write(2): no locks, no allocation, no stdio of the host program.
#pragma once

namespace mural {

// "mural: " + text + newline. printf formats.
void say(const char* format, ...) __attribute__((format(printf, 1, 2)));
// Only the first time per place.
#define MURAL_SAY_ONCE(...)                                                                        \
    do {                                                                                           \
        static bool said = false;                                                                  \
        if (!__atomic_exchange_n(&said, true, __ATOMIC_RELAXED)) ::mural::say(__VA_ARGS__);        \
    } while (0)

} // namespace mural
