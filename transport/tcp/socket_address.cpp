#include "transport/tcp/socket_address.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <netdb.h>
#include <netinet/in.h>

namespace mural {

Result<SocketAddress> numericAddress(const std::string& host, uint16_t port) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_DGRAM;
    hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    addrinfo* list = nullptr;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list) != 0)
        return Error{"\"" + host + "\" is not a network address; use a numeric one, such as 10.0.0.1 or ff12::4"};
    SocketAddress address;
    std::memcpy(&address.storage, list->ai_addr, list->ai_addrlen);
    address.sizeBytes = list->ai_addrlen;
    freeaddrinfo(list);
    return address;
}

bool SocketAddress::isMulticast() const {
    if (family() == AF_INET)
        return IN_MULTICAST(ntohl(reinterpret_cast<const sockaddr_in*>(&storage)->sin_addr.s_addr));
    return family() == AF_INET6 && IN6_IS_ADDR_MULTICAST(&reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_addr);
}

std::string numericText(const SocketAddress& address) {
    std::array<char, NI_MAXHOST> text{};
    if (getnameinfo(address.get(), address.sizeBytes, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0)
        return {};
    constexpr std::string_view kMapped = "::ffff:"; // prefix of an IPv4 peer of an IPv6 socket
    const std::string_view numbers = text.data();
    const bool mapped = numbers.starts_with(kMapped) && numbers.find('.') != std::string_view::npos;
    return std::string(numbers.substr(mapped ? kMapped.size() : 0));
}

Result<HostPort> splitHostPort(std::string_view text) {
    const size_t colon = text.rfind(':');
    const Error wrong{"\"" + std::string(text) + "\" is not host:port; IPv6 addresses need brackets, such as [::1]:80"};
    if (colon == std::string_view::npos) return wrong;
    std::string_view host = text.substr(0, colon);
    const std::string_view digits = text.substr(colon + 1);
    if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
        host = host.substr(1, host.size() - 2);
    else if (host.find(':') != std::string_view::npos)
        return wrong;
    HostPort result{std::string(host), 0};
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), result.port);
    if (code != std::errc() || end != digits.data() + digits.size() || digits.empty()) return wrong;
    return result;
}

std::string endpointText(const std::string& host, uint16_t port) {
    const bool brackets = host.find(':') != std::string::npos;
    return (brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<SocketAddress> numericEndpoint(std::string_view text) {
    auto parts = splitHostPort(text);
    if (!parts) return parts.error();
    return numericAddress(parts->host, parts->port);
}

} // namespace mural
