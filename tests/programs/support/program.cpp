#include "tests/programs/support/program.hpp"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace programs {

void fail(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::fprintf(stderr, "%s: ", program_invocation_short_name);
    std::vfprintf(stderr, format, arguments);
    std::fputc('\n', stderr);
    va_end(arguments);
    std::_Exit(2);
}

Options parseOptions(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        if (std::strcmp(argv[i], "--frames") == 0) {
            options.frames = std::atoi(value);
            ++i;
        } else if (std::strcmp(argv[i], "--size") == 0) {
            if (std::sscanf(value, "%dx%d", &options.width, &options.height) != 2) {
                fail("--size wants WIDTHxHEIGHT, not \"%s\"", value);
            }
            ++i;
        } else {
            fail("unknown option \"%s\"; known are --frames N and --size WxH", argv[i]);
        }
    }
    if (options.frames < 1 || options.width < 1 || options.height < 1) {
        fail("--frames and --size want positive numbers");
    }
    return options;
}

} // namespace programs
