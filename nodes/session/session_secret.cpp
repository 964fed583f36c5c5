#include "nodes/session/session_secret.hpp"

#include <cerrno>
#include <cstring>
#include <sys/random.h>

namespace mural {
namespace {

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

} // namespace

Result<SessionSecret> makeSessionSecret() {
    SessionSecret secret;
    size_t have = 0;
    while (have < secret.size()) {
        const ssize_t got = getrandom(secret.data() + have, secret.size() - have, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            return Error{std::string("cannot get random bytes for the session's secret (getrandom): ") +
                         std::strerror(errno)};
        }
        have += static_cast<size_t>(got);
    }
    return secret;
}

std::string toHex(const SessionSecret& secret) {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string hex;
    for (const std::byte b : secret) {
        hex += kDigits[std::to_integer<unsigned>(b) >> 4];
        hex += kDigits[std::to_integer<unsigned>(b) & 15];
    }
    return hex;
}

Result<SessionSecret> sessionSecretFromHex(const std::string& line) {
    const std::string hex = line.substr(0, line.find_last_not_of("\r\n") + 1);
    const Error error{
        "the session secret on standard input is not a line of 64 hex digits; nodes are started by `mural head`"};
    if (hex.size() != 2 * kChannelSecretBytes) return error;
    SessionSecret secret;
    for (size_t i = 0; i < kChannelSecretBytes; ++i) {
        const int high = hexDigit(hex[2 * i]);
        const int low = hexDigit(hex[2 * i + 1]);
        if (high < 0 || low < 0) return error;
        secret[i] = static_cast<std::byte>(high << 4 | low);
    }
    return secret;
}

} // namespace mural
