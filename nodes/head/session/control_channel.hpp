// The head's end of the control connection to `mural run`: lines of JSON (docs/reference/control-protocol.md).
#pragma once

#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

// send(), say() and error() are thread-safe and never block. One thread receives.
class ControlChannel {
public:
    explicit ControlChannel(FileDescriptor fd) : fd_(std::move(fd)) {}
    ControlChannel(const ControlChannel&) = delete;
    ControlChannel& operator=(const ControlChannel&) = delete;
    ~ControlChannel(); // waits a limited time for buffered lines

    void send(const nlohmann::json& event);
    void say(const std::string& text); // one line for the user
    void error(const std::string& text);

    // Returns the next line, or nothing if the deadline passes or the connection fails.
    std::optional<std::string> receive(Deadline deadline);
    // True after the peer has closed the connection. Its remaining lines can still be received.
    [[nodiscard]] bool broken() const;

private:
    void writeLine(const std::string& line);
    void writeSome();
    bool fill(Deadline deadline);
    void markBroken();
    [[nodiscard]] bool markedBroken() const;

    FileDescriptor fd_;
    std::string received_;
    mutable std::mutex mutex_; // guards the members below
    std::string unsent_;
    bool broken_ = false;
};

} // namespace mural
