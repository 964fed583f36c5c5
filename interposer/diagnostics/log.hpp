// Writes one line to the user's stderr with write(2): no locks, no allocation, no stdio of the host program. Writes
// only to the file that descriptor 2 was at the start, because daemons close it and may open another file there.
#pragma once

#include <cstdarg>
#include <cstddef>

namespace mural {

// Formats the prefix, the text as far as it fits, and a newline, without a terminator. Returns the length; 0: nothing.
[[gnu::format(printf, 4, 0)]] size_t formatLine(char* line, size_t sizeBytes, const char* prefix, const char* format,
                                                va_list arguments);

// Writes all bytes despite interruptions. Neither SIGPIPE nor SIGXFSZ reaches the program. Returns false if bytes are
// left.
bool writeAll(int fd, const void* data, size_t bytes);

// Writes "mural: " + text + newline. Formats like printf.
void say(const char* format, ...) __attribute__((format(printf, 1, 2)));
// Writes only once per call site.
#define MURAL_SAY_ONCE(...)                                                                                            \
    do {                                                                                                               \
        static bool once = false;                                                                                      \
        if (!__atomic_exchange_n(&once, true, __ATOMIC_RELAXED)) ::mural::say(__VA_ARGS__);                            \
    } while (0)

} // namespace mural
