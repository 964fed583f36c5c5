#include "nodes/head/capture/capture_server.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <poll.h>
#include <span>
#include <sys/socket.h>
#include <sys/un.h>

#include "common/ipc/descriptor_message.hpp"
#include "common/log/log.hpp"
#include "nodes/launch/session_socket.hpp"

namespace mural {
namespace {

using capture::Hello;
using capture::Welcome;

constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kHelloPatienceMs = 5000;
constexpr int64_t kWelcomePatienceMs = 5000;
constexpr size_t kMaxNewcomers = 64;
constexpr size_t kListeners = 2; // one with an abstract name, one with a path

Error socketError(const std::string& session, const char* what) {
    std::string text = "session socket " + session + ": " + what + ": " + std::strerror(errno);
    if (errno == EADDRINUSE) text += "; another session has this name; choose another one";
    return Error{text};
}

Result<FileDescriptor> listenAt(const std::string& session, const sockaddr_un& address, size_t bytes) {
    FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd.valid()) return socketError(session, "socket");
    if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(bytes)) != 0)
        return socketError(session, "bind");
    if (listen(fd.get(), 64) != 0) return socketError(session, "listen");
    return fd;
}

Result<FileDescriptor> listenAbstract(const std::string& session) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (session.empty() || session.size() >= sizeof(address.sun_path)) {
        return Error{"the session's name must have 1 to " + std::to_string(sizeof(address.sun_path) - 1) +
                     " bytes: " + session};
    }
    std::memcpy(address.sun_path + 1, session.data(), session.size()); // [0] = 0: abstract
    return listenAt("@" + session, address, offsetof(sockaddr_un, sun_path) + 1 + session.size());
}

// Opens a socket in a folder that only this user can access. Returns an invalid descriptor without a path or on
// failure. Programs of this network namespace do not need it. Programs of others then report that they can't connect.
FileDescriptor listenInFolder(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof(address.sun_path)) return {};
    std::memcpy(address.sun_path, path.data(), path.size());
    auto fd = listenAt(path, address, sizeof address);
    return fd ? std::move(*fd) : FileDescriptor();
}

bool waitWritable(int fd, Deadline deadline) {
    pollfd room{fd, POLLOUT, 0};
    const int ready = poll(&room, 1, static_cast<int>(deadline.leftNs(kNsPerS) / kNsPerMs));
    return (ready >= 0 || errno == EINTR) && !deadline.passed();
}

// The descriptor travels with the first byte.
bool sendAll(int socket, std::span<const std::byte> bytes, int fdToPass, Deadline deadline) {
    while (!bytes.empty()) {
        const ssize_t n = sendWithDescriptor(socket, bytes, fdToPass);
        if (n > 0) {
            bytes = bytes.subspan(static_cast<size_t>(n));
            fdToPass = -1;
            continue;
        }
        const bool again = errno == EAGAIN || errno == EWOULDBLOCK;
        if (!again || !waitWritable(socket, deadline)) return false;
    }
    return true;
}

bool sendWelcome(int socket, Welcome welcome, const std::string& text, int memoryFd) {
    welcome.magic = capture::kMagic;
    welcome.version = capture::kVersion;
    welcome.extensionBytes = static_cast<uint32_t>(text.size());
    const Deadline deadline = Deadline::inMs(kWelcomePatienceMs);
    return sendAll(socket, std::as_bytes(std::span(&welcome, 1)), memoryFd, deadline) &&
           sendAll(socket, std::as_bytes(std::span(text)), -1, deadline);
}

bool peerOf(int socket, ucred& peer) {
    socklen_t size = sizeof(peer);
    return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
}

} // namespace

Result<std::unique_ptr<CaptureServer>> CaptureServer::start(const CaptureAddresses& addresses, uint64_t digest,
                                                            ProgramHost& host) {
    auto listener = listenAbstract(addresses.abstractName);
    if (!listener) return listener.error();
    std::unique_ptr<CaptureServer> server(
        new CaptureServer(std::move(*listener), listenInFolder(addresses.path), addresses.path, digest, host));
    server->thread_ = std::thread([raw = server.get()] { raw->serve(); });
    return server;
}

CaptureServer::CaptureServer(FileDescriptor listener, FileDescriptor pathListener, std::string path, uint64_t digest,
                             ProgramHost& host)
    : listener_(std::move(listener)),
      pathListener_(std::move(pathListener)),
      path_(std::move(path)),
      digest_(digest),
      host_(host) {}

CaptureServer::~CaptureServer() {
    stop_ = true;
    shutdown(listener_.get(), SHUT_RDWR); // wakes the thread
    if (thread_.joinable()) thread_.join();
    if (!path_.empty()) launch::removeSessionSocket(path_); // `mural run` may have been killed
}

void CaptureServer::serve() {
    while (!stop_) {
        // poll ignores a negative descriptor
        std::vector<pollfd> polled{{listener_.get(), POLLIN, 0}, {pathListener_.get(), POLLIN, 0}};
        for (const Newcomer& n : newcomers_) polled.push_back({n.socket.get(), POLLIN, 0});
        if (poll(polled.data(), polled.size(), kAcceptSliceMs) < 0) continue;
        // Backwards, because the vector shrinks during the loop.
        for (size_t i = newcomers_.size(); i-- > 0;) {
            if (settle(newcomers_[i], polled[i + kListeners].revents != 0))
                newcomers_.erase(newcomers_.begin() + static_cast<std::ptrdiff_t>(i));
        }
        for (size_t i = 0; i < kListeners; ++i)
            if (polled[i].revents != 0 && !stop_) acceptOne(polled[i].fd);
    }
}

// A program of this user may be paused for any time before its Hello. Other peers may hold a place only until the
// deadline.
void CaptureServer::acceptOne(int listener) {
    FileDescriptor socket(accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
    // Waits, because without a free descriptor the next accept4() would fail at once.
    if (!socket.valid() && (errno == EMFILE || errno == ENFILE)) poll(nullptr, 0, kAcceptSliceMs);
    if (!socket.valid()) return;
    if (newcomers_.size() >= kMaxNewcomers) {
        const auto late = std::ranges::find_if(newcomers_, [](const Newcomer& n) { return n.deadline.passed(); });
        if (late == newcomers_.end()) return;
        newcomers_.erase(late);
    }
    ucred peer{};
    const bool mayTakeLong = peerOf(socket.get(), peer) && peer.uid == geteuid();
    newcomers_.push_back({std::move(socket), Deadline::inMs(kHelloPatienceMs), mayTakeLong});
}

bool CaptureServer::settle(Newcomer& newcomer, bool readable) {
    if (newcomer.deadline.passed() && !newcomer.mayTakeLong) return true;
    if (!readable) return false;
    auto* hello = reinterpret_cast<std::byte*>(&newcomer.hello);
    const ssize_t n =
        recv(newcomer.socket.get(), hello + newcomer.haveBytes, sizeof(Hello) - newcomer.haveBytes, MSG_DONTWAIT);
    if (n == 0) return true; // the peer has closed the connection
    if (n < 0) return errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR;
    newcomer.haveBytes += static_cast<size_t>(n);
    if (newcomer.haveBytes < sizeof(Hello)) return false;
    answer(std::move(newcomer.socket), newcomer.hello);
    return true;
}

void CaptureServer::answer(FileDescriptor socket, const Hello& hello) {
    auto admission = judge(socket.get(), hello);
    if (!admission) {
        log::debug(log::Topic::Program, "a program was refused: ", admission.error().message);
        Welcome refusal{};
        refusal.refused = 1;
        sendWelcome(socket.get(), refusal, admission.error().message, -1);
        return;
    }
    const bool sent = sendWelcome(socket.get(), admission->welcome, admission->extensions, admission->memoryFd);
    host_.programWelcomed(admission->welcome.clientId, sent ? std::move(socket) : FileDescriptor());
}

Result<Admission> CaptureServer::judge(int socket, const Hello& hello) {
    ucred peer{};
    if (!peerOf(socket, peer)) return Error{"the head cannot identify this program"};
    if (peer.uid != geteuid())
        return Error{"the session belongs to another user; start the program as the user of `mural run`"};
    if (hello.magic != capture::kMagic || hello.version != capture::kVersion || hello.registryDigest != digest_) {
        return Error{"the capture library and `mural head` are of different builds; install both from one build"};
    }
    return host_.admitProgram(peer.pid, hello.kind);
}

} // namespace mural
