// The options of `mural page`, and the rules about them. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::page {

struct PageArguments {
    std::vector<std::string> words; // [SESSION], or link, links, revoke LINK, each with an optional SESSION
    std::string at;                 // --at: ADDRESS[:PORT] or unix:PATH
    bool stops = false;             // --off
    std::string certificate, key;   // --page-cert, --page-key
    std::string tls = "auto";       // --page-tls
    bool isInsecure = false;        // --page-insecure
    std::vector<std::string> hosts; // --page-host
    std::string embedOrigin;        // --page-embed
    bool hasOpenMetrics = false;    // --metrics-open
    std::string tokenFile;          // --page-token-file
    int previewRate = 15, previewSize = 1280, previewQuality = 80;
    std::string control = "click";   // --control
    bool reachesUserDisplay = false; // --input-on-display
    std::string role = "view";       // --role
    std::string lifetime = "8h";     // --for
    int most = 20;                   // --most
    std::string name;                // --name
};

// Where the page listens.
struct PageAddress {
    std::string host = "127.0.0.1";
    uint16_t firstPort = 8787, lastPort = 8806;
    std::string unixPath;

    [[nodiscard]] bool isLoopback() const;
};

// Errors: no such form, or an invalid port.
Result<PageAddress> pageAddressOf(const std::string& at);
// Returns whether the page uses TLS. Errors: it would listen beyond this machine without TLS.
Result<bool> usesTls(const PageArguments& arguments, const PageAddress& address);
// Returns seconds: "90", "45m", "8h", "2d". Errors: another form.
Result<int64_t> lifetimeOf(const std::string& text);

} // namespace mural::page
