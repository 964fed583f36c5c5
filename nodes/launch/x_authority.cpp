#include "nodes/launch/x_authority.hpp"

#include <cerrno>
#include <cstring>
#include <string_view>
#include <sys/mman.h>
#include <sys/random.h>
#include <unistd.h>

namespace mural::launch {

namespace {

constexpr uint16_t kFamilyWild = 0xffff; // X11/Xauth.h: matches every address

void appendBigEndian(std::string& file, size_t value) {
    file += static_cast<char>(value >> 8 & 0xff);
    file += static_cast<char>(value & 0xff);
}

void appendCounted(std::string& file, std::string_view bytes) {
    appendBigEndian(file, bytes.size());
    file += bytes;
}

} // namespace

std::string authorityFile(const XAuthority::Cookie& cookie) {
    std::string file;
    appendBigEndian(file, kFamilyWild);
    appendCounted(file, ""); // address
    appendCounted(file, ""); // display number: any
    appendCounted(file, kXAuthorityProtocol);
    appendCounted(file, {reinterpret_cast<const char*>(cookie.data()), cookie.size()});
    return file;
}

Result<std::unique_ptr<XAuthority>> XAuthority::create() {
    Cookie cookie{};
    if (getrandom(cookie.data(), cookie.size(), 0) != static_cast<ssize_t>(cookie.size())) {
        return Error{"cannot get random bytes for the key of the private display: " +
                     std::string(std::strerror(errno))};
    }
    const int fd = memfd_create("mural-xauthority", MFD_CLOEXEC);
    if (fd < 0) return Error{"no memory for the key of the private display: " + std::string(std::strerror(errno))};
    std::unique_ptr<XAuthority> authority(new XAuthority(fd, cookie));
    const std::string file = authorityFile(cookie);
    if (write(fd, file.data(), file.size()) != static_cast<ssize_t>(file.size())) {
        return Error{"the key of the private display cannot be written: " + std::string(std::strerror(errno))};
    }
    return authority;
}

XAuthority::XAuthority(int fd, const Cookie& cookie)
    : fd_(fd), cookie_(cookie), path_("/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd)) {}

XAuthority::~XAuthority() { close(fd_); }

} // namespace mural::launch
