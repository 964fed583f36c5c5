#include "nodes/launch/display_numbers.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::launch {

namespace {

constexpr int kNumbers = 65536 - 6000; // a server of number n may listen at TCP port 6000 + n
constexpr int64_t kLockMs = 20'000;
constexpr int kLockSliceMs = 10;

// Returns 0 if a server accepts the connection, else errno. EAGAIN: its queue is full.
int connectError(const sockaddr_un& address, size_t bytes) {
    const FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const auto* const general = reinterpret_cast<const sockaddr*>(&address);
    return connect(fd.get(), general, static_cast<socklen_t>(bytes)) == 0 ? 0 : errno;
}

sockaddr_un addressOf(const std::string& path, size_t at) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + at, path.data(), std::min(path.size(), sizeof address.sun_path - at - 1));
    return address;
}

bool abstractFree(const std::string& path) {
    return connectError(addressOf(path, 1), offsetof(sockaddr_un, sun_path) + 1 + path.size()) == ECONNREFUSED;
}

bool fileFree(const std::string& path) {
    struct stat file {};
    if (lstat(path.c_str(), &file) != 0) return errno == ENOENT || errno == ENOTDIR;
    const bool mayReplace = file.st_uid == geteuid() || geteuid() == 0;
    return mayReplace && connectError(addressOf(path, 0), sizeof(sockaddr_un)) == ECONNREFUSED;
}

} // namespace

DisplayNumbers::DisplayNumbers(const std::string& folder) : folder_(folder) {
    constexpr mode_t kForAllUsers = 01777;
    if (mkdir(folder_.c_str(), kForAllUsers) == 0) chmod(folder_.c_str(), kForAllUsers); // mkdir() applies the umask
    lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const Deadline deadline = Deadline::inMs(kLockMs);
    while (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && !deadline.passed()) poll(nullptr, 0, kLockSliceMs);
}

DisplayNumbers::~DisplayNumbers() {
    if (lock_ >= 0) close(lock_);
}

std::optional<int> DisplayNumbers::firstFree(int first) const {
    for (int number = first; number < kNumbers; ++number) {
        const std::string path = folder_ + "/X" + std::to_string(number);
        if (abstractFree(path) && fileFree(path)) return number;
    }
    return std::nullopt;
}

} // namespace mural::launch
