#include "nodes/output/windows/x_connection.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <poll.h>
#include <sys/socket.h>
#include <thread>

#include <fmt/format.h>
#include <xcb/shm.h>
#include <xcb/xcbext.h>

namespace mural {

namespace {

// xcb has no deadline for this part of connecting. It runs in a thread, which is abandoned if the server does not
// answer. The thread then frees its own resources.
struct Attempt {
    std::mutex mutex;
    std::condition_variable done;
    xcb_connection_t* connection = nullptr;
    bool finished = false;
    bool abandoned = false;
};

void connectInto(const std::shared_ptr<Attempt>& attempt, const std::string& displayName) {
    xcb_connection_t* connection = xcb_connect(displayName.empty() ? nullptr : displayName.c_str(), nullptr);
    // Queried here, because later calls of the extension would wait for the reply without a deadline.
    if (xcb_connection_has_error(connection) == 0) xcb_get_extension_data(connection, &xcb_shm_id);
    const std::lock_guard lock(attempt->mutex);
    if (attempt->abandoned) {
        xcb_disconnect(connection);
        return;
    }
    attempt->connection = connection;
    attempt->finished = true;
    attempt->done.notify_all();
}

std::string nameOf(const std::string& displayName) {
    if (!displayName.empty()) return displayName;
    const char* fromEnvironment = std::getenv("DISPLAY");
    return fromEnvironment != nullptr ? fromEnvironment : "";
}

Error cannotConnect(const std::string& name, int code) {
    if (name.empty()) return {"no X display: DISPLAY is not set; set it, or run without a window output"};
    if (code == XCB_CONN_CLOSED_PARSE_ERR)
        return {fmt::format("'{}' is not the name of an X display; names look like :0 or host:0", name)};
    return {fmt::format("cannot connect to the X display '{}'; check that the server runs and that "
                        "xauth allows you in",
                        name)};
}

} // namespace

Result<std::unique_ptr<XConnection>> XConnection::open(const std::string& displayName, Deadline deadline) {
    const std::string name = nameOf(displayName);
    if (name.empty()) return cannotConnect(name, 0);
    auto attempt = std::make_shared<Attempt>();
    std::thread(connectInto, attempt, name).detach();
    xcb_connection_t* connection = nullptr;
    {
        std::unique_lock lock(attempt->mutex);
        attempt->done.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kNsPerS * 3600)),
                               [&] { return attempt->finished; });
        if (!attempt->finished) {
            attempt->abandoned = true;
            return Error{fmt::format("the X display '{}' does not answer in time; another program may have "
                                     "grabbed its server, or the server is stopped",
                                     name)};
        }
        connection = attempt->connection;
    }
    if (const int code = xcb_connection_has_error(connection); code != 0) {
        xcb_disconnect(connection);
        return cannotConnect(name, code);
    }
    return std::unique_ptr<XConnection>(new XConnection(connection, name));
}

XConnection::XConnection(xcb_connection_t* connection, std::string displayName)
    : connection_(connection), displayName_(std::move(displayName)) {
    const int fd = xcb_get_file_descriptor(connection_);
    sockaddr_storage address{};
    socklen_t addressBytes = sizeof address;
    local_ =
        ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &addressBytes) == 0 && address.ss_family == AF_UNIX;
    // The kernel counts more than the bytes themselves. A quarter of the limit always fits.
    int bufferBytes = 0;
    socklen_t optionBytes = sizeof bufferBytes;
    ::getsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bufferBytes, &optionBytes);
    bytesInFlight_ = static_cast<size_t>(std::max(bufferBytes, 16 * 1024)) / 4;
}

XConnection::~XConnection() { xcb_disconnect(connection_); }

XAnswer XConnection::awaitRaw(unsigned sequence, Deadline deadline, void** reply, XOwned<xcb_generic_error_t>* error) {
    xcb_flush(connection_);
    for (;;) {
        xcb_generic_error_t* failure = nullptr;
        const int known = xcb_poll_for_reply(connection_, sequence, reply, &failure);
        XOwned<xcb_generic_error_t> owned(failure);
        if (xcb_connection_has_error(connection_) != 0 && *reply == nullptr) return XAnswer::ConnectionLost;
        if (known != 0) {
            if (*reply != nullptr) return XAnswer::Reply;
            if (error != nullptr) *error = std::move(owned);
            return XAnswer::Failed;
        }
        const int64_t leftNs = deadline.leftNs(kNsPerS);
        if (leftNs == 0) return XAnswer::TimedOut;
        pollfd ready{xcb_get_file_descriptor(connection_), POLLIN, 0};
        ::poll(&ready, 1, static_cast<int>((leftNs + kNsPerMs - 1) / kNsPerMs));
    }
}

XAnswer XConnection::check(xcb_void_cookie_t request, Deadline deadline, XOwned<xcb_generic_error_t>& error) {
    const unsigned fence = sendFence();
    const XAnswer answer = awaitFence(fence, deadline);
    if (answer == XAnswer::TimedOut) {
        xcb_discard_reply(connection_, fence);
        xcb_discard_reply(connection_, request.sequence);
    }
    // The server has passed the request, so this returns at once.
    if (answer == XAnswer::Reply) error.reset(xcb_request_check(connection_, request));
    return answer;
}

Error XConnection::describe(XAnswer answer) const {
    if (answer == XAnswer::TimedOut) {
        return {fmt::format("the X display '{}' does not answer in time; another program may have "
                            "grabbed its server, or the server is stopped",
                            displayName_)};
    }
    return {fmt::format("the connection to the X display '{}' is lost; restart its server and the "
                        "session",
                        displayName_)};
}

} // namespace mural
