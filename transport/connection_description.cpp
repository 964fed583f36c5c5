#include "transport/connection_description.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "transport/tcp/tcp_address.hpp"

namespace mural {

namespace {

constexpr std::string_view kTcp = "tcp://";
constexpr std::string_view kShm = "shm:";
constexpr std::string_view kRsp = "rsp://";
constexpr std::string_view kAuthority = "://"; // follows the scheme of a plug-in

Error invalid(std::string_view text, const std::string& why) {
    return Error{"connection \"" + std::string(text) + "\": " + why +
                 "; write tcp://host:port, rsp://group:port, shm:descriptor, pipe:, or a plug-in's scheme://host:port"};
}

template <class Number> bool parseNumber(std::string_view text, Number& into) {
    const char* end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, into);
    return code == std::errc() && stop == end;
}

// Parses host:port from `rest`.
Result<ConnectionDescription> parseEndpoint(std::string_view text, std::string_view rest) {
    const size_t colon = rest.rfind(':');
    if (colon == std::string_view::npos) return invalid(text, "the port is missing");
    ConnectionDescription result;
    result.kind = ConnectionDescription::Kind::Tcp;
    if (!parseNumber(rest.substr(colon + 1), result.port)) {
        return invalid(text, "the port must be a number from 0 to 65535");
    }
    std::string_view host = rest.substr(0, colon);
    const bool brackets = host.size() >= 2 && host.front() == '[' && host.back() == ']';
    if (brackets) host = host.substr(1, host.size() - 2);
    if (brackets ? host.empty() : host.find_first_of(":[]") != std::string_view::npos) {
        return invalid(text, "an IPv6 address must be in brackets");
    }
    if (host.find_first_of("/@ \t") != std::string_view::npos) {
        return invalid(text, "the host contains an invalid character");
    }
    result.host = host;
    return result;
}

// Parses host:port?parameter=value&... from `rest`.
Result<ConnectionDescription> parseWithParameters(std::string_view text, std::string_view rest) {
    const size_t question = rest.find('?');
    auto result = parseEndpoint(text, rest.substr(0, question));
    if (!result) return result.error();
    std::string_view list = question == std::string_view::npos ? std::string_view() : rest.substr(question + 1);
    while (!list.empty()) {
        const std::string_view pair = list.substr(0, list.find('&'));
        list.remove_prefix(std::min(list.size(), pair.size() + 1));
        const size_t equals = pair.find('=');
        if (equals == 0 || equals == std::string_view::npos)
            return invalid(text, "parameters must be name=value, separated by &");
        const std::string name(pair.substr(0, equals));
        if (!result->parameters.emplace(name, pair.substr(equals + 1)).second)
            return invalid(text, name + " is given twice");
    }
    return result;
}

Result<ConnectionDescription> parseRsp(std::string_view text) {
    auto result = parseWithParameters(text, text.substr(kRsp.size()));
    if (!result) return result.error();
    result->kind = ConnectionDescription::Kind::Rsp;
    if (result->host.empty()) return invalid(text, "the group's address is missing, such as 239.255.77.85");
    return result;
}

// The scheme becomes part of a file name, so only letters and digits are allowed.
bool isScheme(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

Result<ConnectionDescription> parsePlugin(std::string_view text, std::string_view scheme) {
    auto result = parseWithParameters(text, text.substr(scheme.size() + kAuthority.size()));
    if (!result) return result.error();
    result->kind = ConnectionDescription::Kind::Plugin;
    result->scheme = scheme;
    return result;
}

} // namespace

Result<ConnectionDescription> parseConnectionDescription(std::string_view text) {
    if (text.starts_with(kTcp)) return parseEndpoint(text, text.substr(kTcp.size()));
    if (text == "pipe:") return ConnectionDescription{};
    if (text.starts_with(kShm)) {
        ConnectionDescription result;
        result.kind = ConnectionDescription::Kind::SharedMemory;
        const std::string_view number = text.substr(kShm.size());
        if (!number.empty() && (!parseNumber(number, result.descriptor) || result.descriptor < 0)) {
            return invalid(text, "the descriptor must be a number");
        }
        return result;
    }
    if (text.starts_with(kRsp)) return parseRsp(text);
    const std::string_view scheme = text.substr(0, text.find(kAuthority));
    if (scheme.size() < text.size() && isScheme(scheme)) return parsePlugin(text, scheme);
    return invalid(text, "unknown kind");
}

std::string toText(const ConnectionDescription& description) {
    switch (description.kind) {
    case ConnectionDescription::Kind::Pipe: return "pipe:";
    case ConnectionDescription::Kind::SharedMemory:
        return description.descriptor < 0 ? "shm:" : "shm:" + std::to_string(description.descriptor);
    case ConnectionDescription::Kind::Tcp: return tcpText(description.host, description.port);
    case ConnectionDescription::Kind::Rsp:
    case ConnectionDescription::Kind::Plugin: break;
    }
    const bool plugin = description.kind == ConnectionDescription::Kind::Plugin;
    std::string text = (plugin ? description.scheme + std::string(kAuthority) : std::string(kRsp)) +
                       endpointText(description.host, description.port);
    char separator = '?';
    for (const auto& [name, value] : description.parameters) {
        text += std::exchange(separator, '&') + name + "=" + value;
    }
    return text;
}

} // namespace mural
