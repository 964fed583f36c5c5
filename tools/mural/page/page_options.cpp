#include "tools/mural/page/page_options.hpp"

#include <arpa/inet.h>

#include "tools/mural/page/access/link_table.hpp"
#include "tools/mural/page/http/page_numbers.hpp"

namespace mural::page {

namespace {

constexpr int kMaxPort = 65535;

Result<void> readPort(const std::string& at, std::string_view text, PageAddress& address) {
    const auto port = wholeNumber(text, 1, kMaxPort);
    if (!port) return Error{"--at " + at + ": the port must be a number from 1 to 65535"};
    address.firstPort = address.lastPort = static_cast<uint16_t>(*port);
    return {};
}

} // namespace

bool PageAddress::isLoopback() const {
    if (!unixPath.empty() || host == "localhost") return true;
    in_addr four{};
    in6_addr six{};
    if (inet_pton(AF_INET, host.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
    if (inet_pton(AF_INET6, host.c_str(), &six) == 1) return IN6_IS_ADDR_LOOPBACK(&six);
    return false; // a name may have any address
}

Result<PageAddress> pageAddressOf(const std::string& at) {
    PageAddress address;
    constexpr std::string_view kUnix = "unix:";
    if (at.empty()) return address;
    if (at.starts_with(kUnix)) {
        address.unixPath = at.substr(kUnix.size());
        if (!address.unixPath.starts_with("/"))
            return Error{"--at " + at + ": a Unix socket needs an absolute path, such as unix:/run/user/1000/page"};
        return address;
    }
    std::string_view text = at;
    if (text.starts_with('[')) { // [IPv6]:PORT
        const size_t end = text.find(']');
        if (end == std::string_view::npos) return Error{"--at " + at + ": the bracket ] is missing"};
        address.host = std::string(text.substr(1, end - 1));
        text.remove_prefix(end + 1);
        if (text.empty()) return address;
        if (text.front() != ':') return Error{"--at " + at + ": expected [ADDRESS]:PORT"};
        if (const auto read = readPort(at, text.substr(1), address); !read) return read.error();
        return address;
    }
    const size_t colon = text.find(':');
    if (colon != std::string_view::npos && text.find(':', colon + 1) == std::string_view::npos) {
        if (const auto read = readPort(at, text.substr(colon + 1), address); !read) return read.error();
        text = text.substr(0, colon);
    }
    if (!text.empty()) address.host = std::string(text);
    return address;
}

Result<bool> usesTls(const PageArguments& arguments, const PageAddress& address) {
    if (arguments.certificate.empty() != arguments.key.empty())
        return Error{"--page-cert and --page-key require each other"};
    if (!arguments.certificate.empty() && arguments.tls == "off") return Error{"--page-tls off excludes --page-cert"};
    if (!arguments.certificate.empty()) return true;
    if (arguments.tls == "auto") return !address.isLoopback();
    if (!address.isLoopback() && !arguments.isInsecure)
        return Error{"--page-tls off: others could read and change the page at " + address.host +
                     "; listen at 127.0.0.1 and use ssh -L, or leave out --page-tls off, or add --page-insecure"};
    return false;
}

Result<int64_t> lifetimeOf(const std::string& text) {
    const Error error{"--for " + text + ": expected a time such as 90s, 45m, 8h or 2d, of a year at most"};
    if (text.empty()) return error;
    int64_t unit = 1;
    std::string_view number = text;
    switch (text.back()) {
    case 's': unit = 1; break;
    case 'm': unit = 60; break;
    case 'h': unit = 3600; break;
    case 'd': unit = int64_t{24} * 3600; break;
    default: unit = 0;
    }
    if (unit > 0)
        number.remove_suffix(1);
    else
        unit = 1;
    const auto count = wholeNumber(number, 1, static_cast<int>(kMaxLinkSeconds));
    if (!count || *count * unit > kMaxLinkSeconds) return error;
    return *count * unit;
}

} // namespace mural::page
