// Listens in place of an X server, at the first free display number that hwloc would try, and counts connections.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <string>
#include <thread>
#include <unistd.h>

namespace mural {

class DisplayListener {
public:
    DisplayListener() {
        for (int number = 0; number < 10 && !listens_; number++) listens_ = listenAt(number);
        thread_ = std::thread([this] { hangUp(); });
    }
    DisplayListener(const DisplayListener&) = delete;
    DisplayListener& operator=(const DisplayListener&) = delete;
    ~DisplayListener() {
        over_ = true;
        thread_.join();
        if (socket_ >= 0) close(socket_);
    }
    [[nodiscard]] bool listens() const { return listens_; } // false if all ten displays exist
    [[nodiscard]] int callers() const { return callers_; }

private:
    bool listenAt(int number) {
        if (socket_ >= 0) close(socket_);
        socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string name = "/tmp/.X11-unix/X" + std::to_string(number); // an abstract Linux socket: no file
        std::memcpy(address.sun_path + 1, name.data(), name.size());
        const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
        return bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) == 0 && listen(socket_, 16) == 0;
    }
    // Closes all connections, so no client waits for a reply.
    void hangUp() {
        while (!over_) {
            pollfd waiting{socket_, POLLIN, 0};
            if (poll(&waiting, 1, 10) <= 0) continue;
            if (const int caller = accept(socket_, nullptr, nullptr); caller >= 0) {
                callers_++;
                close(caller);
            }
        }
    }

    int socket_ = -1;
    bool listens_ = false;
    std::atomic<bool> over_ = false;
    std::atomic<int> callers_ = 0;
    std::thread thread_;
};

} // namespace mural
