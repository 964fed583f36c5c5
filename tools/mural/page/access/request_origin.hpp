// Checks of the headers Host and Origin. A foreign site whose name resolves to this machine (DNS rebinding), or one
// that opens a WebSocket across origins, is refused. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mural::page {

class KnownHosts {
public:
    // names: host names and addresses by which the page may be reached, without ports. Any port is accepted, because
    // tunnels and proxies change it.
    explicit KnownHosts(std::vector<std::string> names);

    [[nodiscard]] bool isKnownHost(std::string_view host) const;
    // An empty origin is accepted: programs send none. Otherwise its host must equal the request's host.
    [[nodiscard]] bool isOwnOrigin(std::string_view origin, std::string_view host) const;

private:
    std::vector<std::string> names_; // in lower case
};

// Returns the host without its port and brackets, in lower case: "[::1]:8787" becomes "::1".
[[nodiscard]] std::string hostName(std::string_view host);

} // namespace mural::page
