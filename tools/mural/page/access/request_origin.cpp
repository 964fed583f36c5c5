#include "tools/mural/page/access/request_origin.hpp"

#include <algorithm>

namespace mural::page {

namespace {

std::string lowerCase(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

} // namespace

std::string hostName(std::string_view host) {
    if (host.starts_with('[')) return lowerCase(host.substr(1, host.find(']') - 1));
    return lowerCase(host.substr(0, host.find(':')));
}

KnownHosts::KnownHosts(std::vector<std::string> names) : names_(std::move(names)) {
    for (std::string& name : names_) name = lowerCase(name);
}

bool KnownHosts::isKnownHost(std::string_view host) const {
    return std::ranges::find(names_, hostName(host)) != names_.end();
}

bool KnownHosts::isOwnOrigin(std::string_view origin, std::string_view host) const {
    if (origin.empty()) return true;
    const size_t at = origin.find("://");
    const std::string_view scheme = origin.substr(0, at);
    if (at == std::string_view::npos || (scheme != "http" && scheme != "https")) return false;
    return lowerCase(origin.substr(at + 3)) == lowerCase(host);
}

} // namespace mural::page
