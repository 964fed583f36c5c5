#include "tools/mural/ctl/control_client.hpp"

#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/ipc/user_socket.hpp"
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_protocol.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

constexpr size_t kMaxReplyBytes = size_t{16} << 20;

Error connectionError(const std::string& path, const std::string& why) {
    return Error{"no connection to the session at " + path + ": " + why + "; mural stat lists the sessions"};
}

const Error kNoReply{"the session does not reply; its head may be stopped"};
const Error kClosed{"the session has closed the connection; it ended, or this client read too slowly"};

// Returns false if the deadline passes.
bool waitFor(int fd, short events, Deadline deadline) {
    while (!deadline.passed()) {
        pollfd entry{fd, events, 0};
        const int64_t leftMs = (deadline.leftNs(kNsPerS) + kNsPerMs - 1) / kNsPerMs;
        if (poll(&entry, 1, static_cast<int>(leftMs)) > 0) return true;
    }
    return false;
}

} // namespace

// Texts of nodes, programs and the command line may not be valid UTF-8.
std::string jsonLine(const Json& value) { return jsonText(value); }

Json memberOf(const Json& value, const char* name) {
    if (!value.is_object()) return {};
    const auto found = value.find(name);
    return found != value.end() ? *found : Json();
}

std::string textOf(const Json& value, const char* name) {
    const Json member = memberOf(value, name);
    return member.is_string() ? member.get<std::string>() : std::string();
}

Result<ControlClient> ControlClient::connect(const std::string& path, Deadline deadline) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof address.sun_path) return connectionError(path, "the path is too long");
    std::memcpy(address.sun_path, path.data(), path.size());
    FileDescriptor fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd.valid()) return connectionError(path, std::strerror(errno));
    // EAGAIN: its queue of connections is full.
    while (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        if ((errno != EAGAIN && errno != EINTR) || deadline.passed())
            return connectionError(path, std::strerror(errno));
        poll(nullptr, 0, 10);
    }
    if (!isPeerOwn(fd.get())) return connectionError(path, "it belongs to another user");
    ControlClient client(std::move(fd));
    auto first = client.receive(deadline);
    if (!first) return first.error();
    if (const std::string error = textOf(*first, "error"); !error.empty()) return Error{error};
    client.hello_ = memberOf(*first, "hello");
    if (memberOf(client.hello_, "protocol") != kControlVersion)
        return Error{"the session speaks another version of the control protocol; use the mural that started it"};
    return client;
}

Result<void> ControlClient::send(const std::string& line, Deadline deadline) {
    size_t done = 0;
    while (done < line.size()) {
        const ssize_t n = ::send(socket_.get(), line.data() + done, line.size() - done, MSG_NOSIGNAL);
        if (n > 0) done += static_cast<size_t>(n);
        if (n < 0 && errno != EAGAIN && errno != EINTR) return kClosed;
        if (n < 0 && !waitFor(socket_.get(), POLLOUT, deadline)) return kNoReply;
    }
    return {};
}

Result<Json> ControlClient::receive(Deadline deadline) {
    size_t end = 0, examined = 0;
    while ((end = received_.find('\n', examined)) == std::string::npos) {
        examined = received_.size();
        char part[65536];
        const ssize_t n = recv(socket_.get(), part, sizeof part, 0);
        if (n > 0) received_.append(part, static_cast<size_t>(n));
        if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR) || received_.size() > kMaxReplyBytes) return kClosed;
        if (n < 0 && !waitFor(socket_.get(), POLLIN, deadline)) return kNoReply;
    }
    Json line = parseJson(std::string_view(received_).substr(0, end));
    received_.erase(0, end + 1);
    if (!line.is_object()) return Error{"the session sent an invalid line; use the mural that started it"};
    return line;
}

Result<Json> ControlClient::request(const std::string& operation, const Json& arguments, Deadline deadline) {
    const int64_t id = ++lastId_;
    const std::string line = jsonLine({{"id", id}, {"op", operation}, {"args", arguments}}) + "\n";
    if (const auto sent = send(line, deadline); !sent) return sent.error();
    while (true) {
        auto reply = receive(deadline);
        if (!reply || !reply->contains("topic")) return reply;
    }
}

} // namespace mural::cli
