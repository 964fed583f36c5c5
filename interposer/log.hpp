// One line to the user's stderr, by write(2): no locks, no allocation, no stdio of the host program. Only to the file
// that descriptor 2 was at the start: daemons close it, and may open a file of their own there.
#pragma once

#include <cstdarg>
#include <cstddef>

namespace mural {

// prefix, the formatted text as far as there is room, and a newline; no terminator. Returns the length, 0: nothing.
size_t formatLine(char* line, size_t sizeBytes, const char* prefix, const char* format, va_list arguments);

// All bytes, through interruptions; neither SIGPIPE nor SIGXFSZ reaches the program. False: not all were written.
bool writeAll(int fd, const void* data, size_t bytes);

// "mural: " + text + newline. printf formats.
void say(const char* format, ...) __attribute__((format(printf, 1, 2)));
// Only the first time per place.
#define MURAL_SAY_ONCE(...)                                                                        \
    do {                                                                                           \
        static bool said = false;                                                                  \
        if (!__atomic_exchange_n(&said, true, __ATOMIC_RELAXED)) ::mural::say(__VA_ARGS__);        \
    } while (0)

} // namespace mural
