#include "tools/mural/stat/running_sessions.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/ipc/capture_ring.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::cli {

namespace {

constexpr timeval kPatience{5, 0}; // timeout of a silent head
constexpr size_t kMaxBytes = size_t{16} << 20;

// Calls with a timeout are not restarted after a stop (SIGSTOP, SIGCONT), whatever the signals' flags.
template <class Call> auto uninterrupted(Call&& call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

FileDescriptor connectTo(const std::string& session) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (session.size() >= sizeof address.sun_path) return {};
    std::memcpy(address.sun_path + 1, session.data(), session.size()); // [0] = 0: abstract
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + session.size());
    FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!fd.valid()) return {};
    setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    setsockopt(fd.get(), SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (uninterrupted([&] { return connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), length); }) != 0)
        return {};
    return fd;
}

// Checks the owner, because any user may listen under such a name.
bool isTrustedPeer(int fd) {
    ucred peer{};
    socklen_t size = sizeof peer;
    return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

std::optional<nlohmann::json> querySession(const std::string& name) {
    const FileDescriptor fd = connectTo(name);
    if (!fd.valid() || !isTrustedPeer(fd.get())) return {};
    capture::Hello hello{};
    hello.magic = capture::kStatusMagic;
    hello.version = capture::kVersion;
    hello.pid = getpid();
    if (uninterrupted([&] { return send(fd.get(), &hello, sizeof hello, MSG_NOSIGNAL); }) !=
        static_cast<ssize_t>(sizeof hello))
        return {};
    std::string text;
    char part[65536];
    ssize_t n = 0;
    while (text.size() < kMaxBytes && (n = uninterrupted([&] { return recv(fd.get(), part, sizeof part, 0); })) > 0)
        text.append(part, static_cast<size_t>(n));
    nlohmann::json state = nlohmann::json::parse(text, nullptr, false);
    if (!state.is_object()) return {};
    return state;
}

} // namespace

std::vector<std::string> sessionNamesIn(const std::string& unixSockets) {
    // The last word of a line is the name; "@" stands for the 0 of an abstract name.
    static const std::regex kName(R"( @(mural-[0-9]+-[0-9a-f]{16})$)");
    std::set<std::string> names; // a session appears once per connection
    std::istringstream lines(unixSockets);
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line, found, kName)) names.insert(found[1]);
    return {names.begin(), names.end()};
}

Result<std::vector<nlohmann::json>> queryRunningSessions() {
    std::ifstream file("/proc/net/unix", std::ios::binary);
    if (!file)
        return Error{std::string("/proc/net/unix cannot be read: ") + std::strerror(errno) +
                     "; check that /proc is mounted"};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::vector<nlohmann::json> sessions;
    for (const std::string& name : sessionNamesIn(text))
        if (auto state = querySession(name)) sessions.push_back(std::move(*state));
    return sessions;
}

} // namespace mural::cli
