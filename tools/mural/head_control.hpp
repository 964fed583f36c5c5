// The head process of a session and its line-based control connection. Not thread-safe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"

namespace mural::cli {

class HeadControl {
public:
    // command: program and arguments; "--control-fd N" is appended.
    static Result<std::unique_ptr<HeadControl>> start(const std::vector<std::string>& command,
                                                      const launch::Environment& environment);
    HeadControl(const HeadControl&) = delete;
    HeadControl& operator=(const HeadControl&) = delete;
    // Ends the head and its nodes, in order first, then by signals.
    ~HeadControl();

    [[nodiscard]] int fd() const { return fd_; }
    [[nodiscard]] launch::ChildProcess& process() { return process_; }
    // Returns false after either side has ended the connection.
    [[nodiscard]] bool connected() const { return connected_; }

    void send(const std::string& line);
    // Returns complete received lines without blocking.
    std::vector<std::string> receive();

private:
    HeadControl(int fd, launch::ChildProcess process) : fd_(fd), process_(process) {}

    int fd_;
    launch::ChildProcess process_;
    bool connected_ = true;
    std::string partial_;
};

} // namespace mural::cli
