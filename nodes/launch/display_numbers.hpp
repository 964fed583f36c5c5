// Numbers of X displays that no server uses.
//
// Xvfb selects a number by itself, but considers only servers of its own network namespace. With a shared
// /tmp/.X11-unix, as in many containers, it replaces the socket of a server outside, and removes it at its end.
#pragma once

#include <optional>
#include <string>

namespace mural::launch {

class DisplayNumbers {
public:
    // folder: the folder of the servers' sockets, which is created if it does not exist. Waits at most 20 s for other
    // sessions that start a server. No error: without the folder, every number with a free abstract name counts as
    // free.
    explicit DisplayNumbers(const std::string& folder = "/tmp/.X11-unix");
    DisplayNumbers(const DisplayNumbers&) = delete;
    DisplayNumbers& operator=(const DisplayNumbers&) = delete;
    ~DisplayNumbers(); // lets other sessions select numbers

    // The lowest free number from `first` on. It stays free for sessions of Mural while this object lives; start the
    // server meanwhile. A socket file without a server is free only if this user may replace it. nullopt: none is free.
    [[nodiscard]] std::optional<int> firstFree(int first = 0) const;

private:
    const std::string folder_;
    int lock_ = -1; // descriptor of the folder with an flock, which containers share as well
};

} // namespace mural::launch
