// The head's end of the control connection to `mural run` (docs/control-protocol.md): lines of JSON.
#pragma once

#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "transport/file_descriptor.hpp"

namespace mural {

// send(), say() and error() from any thread, never blocking; the receiving calls from one.
class ControlChannel {
public:
    explicit ControlChannel(FileDescriptor fd) : fd_(std::move(fd)) {}
    ControlChannel(const ControlChannel&) = delete;
    ControlChannel& operator=(const ControlChannel&) = delete;
    ~ControlChannel(); // waits a while until the last lines are written

    void send(const nlohmann::json& event);
    void say(const std::string& text); // one line for the user
    void error(const std::string& text);

    // The next line, nothing when the deadline passes first or the connection is broken.
    std::optional<std::string> receive(Deadline deadline);
    // The other end is gone; lines that it left may still be received.
    [[nodiscard]] bool broken() const;

private:
    void writeLine(const std::string& line);
    void writeSome();
    bool fill(Deadline deadline);
    void markBroken();
    [[nodiscard]] bool markedBroken() const;

    FileDescriptor fd_;
    std::string received_;
    mutable std::mutex mutex_; // what follows
    std::string unsent_;
    bool broken_ = false;
};

} // namespace mural
