#include "transport/connection_description.hpp"

#include <charconv>

#include "transport/tcp_address.hpp"

namespace mural {

namespace {

constexpr std::string_view kTcp = "tcp://";
constexpr std::string_view kShm = "shm:";

Error invalid(std::string_view text, const std::string& why) {
    return Error{"connection \"" + std::string(text) + "\": " + why +
                 "; write tcp://host:port, shm:descriptor or pipe:"};
}

template <class Number> bool parseNumber(std::string_view text, Number& into) {
    const char* end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, into);
    return code == std::errc() && stop == end;
}

Result<ConnectionDescription> parseTcp(std::string_view text) {
    const std::string_view rest = text.substr(kTcp.size());
    const size_t colon = rest.rfind(':');
    if (colon == std::string_view::npos)
        return invalid(text, "the port is missing");
    ConnectionDescription result;
    result.kind = ConnectionDescription::Kind::Tcp;
    if (!parseNumber(rest.substr(colon + 1), result.port)) {
        return invalid(text, "the port must be a number from 0 to 65535");
    }
    std::string_view host = rest.substr(0, colon);
    const bool brackets = host.size() >= 2 && host.front() == '[' && host.back() == ']';
    if (brackets)
        host = host.substr(1, host.size() - 2);
    if (brackets ? host.empty() : host.find_first_of(":[]") != std::string_view::npos) {
        return invalid(text, "an IPv6 address must stand in brackets");
    }
    if (host.find_first_of("/@ \t") != std::string_view::npos) {
        return invalid(text, "the host has a character that no host name has");
    }
    result.host = host;
    return result;
}

} // namespace

Result<ConnectionDescription> parseConnectionDescription(std::string_view text) {
    if (text.starts_with(kTcp))
        return parseTcp(text);
    if (text == "pipe:")
        return ConnectionDescription{};
    if (text.starts_with(kShm)) {
        ConnectionDescription result;
        result.kind = ConnectionDescription::Kind::SharedMemory;
        const std::string_view number = text.substr(kShm.size());
        if (!number.empty() && (!parseNumber(number, result.descriptor) || result.descriptor < 0)) {
            return invalid(text, "the descriptor must be a number");
        }
        return result;
    }
    if (text.starts_with("rsp:"))
        return invalid(text, "reliable multicast is not in this build");
    return invalid(text, "unknown kind");
}

std::string toText(const ConnectionDescription& description) {
    switch (description.kind) {
    case ConnectionDescription::Kind::Pipe:
        return "pipe:";
    case ConnectionDescription::Kind::SharedMemory:
        return description.descriptor < 0 ? "shm:"
                                          : "shm:" + std::to_string(description.descriptor);
    case ConnectionDescription::Kind::Tcp:
        break;
    }
    return tcpText(description.host, description.port);
}

Result<std::unique_ptr<Connection>> connectTo(std::string_view text, Deadline deadline) {
    const auto description = parseConnectionDescription(text);
    if (!description)
        return description.error();
    const ConnectionDescription& to = description.value();
    if (to.kind == ConnectionDescription::Kind::Tcp) {
        if (to.host.empty() || to.port == 0)
            return invalid(text, "connecting needs a host and a port");
        return connectTcp(to.host, to.port, deadline);
    }
    if (to.kind == ConnectionDescription::Kind::SharedMemory && to.descriptor >= 0) {
        return openSharedMemory(to.descriptor);
    }
    return invalid(text, "has no other end to connect to");
}

Result<std::unique_ptr<Listener>> listenAt(std::string_view text) {
    const auto description = parseConnectionDescription(text);
    if (!description)
        return description.error();
    if (description.value().kind != ConnectionDescription::Kind::Tcp) {
        return invalid(text, "only TCP can listen");
    }
    return listenTcp(description.value().host, description.value().port);
}

} // namespace mural
