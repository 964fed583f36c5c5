// The cookie of a private X display, as a file for X servers and libXau. The file is anonymous memory with a name in
// /proc, so no session leaves it on disk.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace mural::launch {

constexpr const char* kXAuthorityProtocol = "MIT-MAGIC-COOKIE-1";

class XAuthority {
public:
    static constexpr size_t kCookieBytes = 16;
    using Cookie = std::array<uint8_t, kCookieBytes>;

    static Result<std::unique_ptr<XAuthority>> create();
    XAuthority(const XAuthority&) = delete;
    XAuthority& operator=(const XAuthority&) = delete;
    ~XAuthority();

    // For XAUTHORITY and Xvfb's -auth. Other processes of this user can open it while this object lives.
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const Cookie& cookie() const { return cookie_; }

private:
    XAuthority(int fd, const Cookie& cookie);
    int fd_;
    Cookie cookie_;
    std::string path_;
};

// One entry that matches every display: family (any), address, number, protocol, cookie.
std::string authorityFile(const XAuthority::Cookie& cookie);

} // namespace mural::launch
