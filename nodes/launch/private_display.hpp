// A private X server (Xvfb) for programs without a display, or for programs that must see a screen of the wall's size.
// All queries about the screen's size are then answered consistently.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/x_authority.hpp"

namespace mural::launch {

constexpr int kMaxScreenSize = 32767; // X protocol coordinates are signed 16-bit integers
constexpr int kDefaultScreenWidth = 1920;
constexpr int kDefaultScreenHeight = 1080;

class PrivateDisplay {
public:
    static Result<std::unique_ptr<PrivateDisplay>> start(int width, int height);
    PrivateDisplay(const PrivateDisplay&) = delete;
    PrivateDisplay& operator=(const PrivateDisplay&) = delete;
    ~PrivateDisplay(); // ends the server

    [[nodiscard]] const std::string& name() const { return name_; } // ":99"
    [[nodiscard]] const XAuthority& authority() const { return *authority_; }
    [[nodiscard]] pid_t pid() const { return server_.pid(); }
    [[nodiscard]] bool running() { return server_.running(); }

    // Sets the program's display variables to this display, and removes the Wayland one.
    void use(Environment& environment) const;

private:
    PrivateDisplay() = default;
    ChildProcess server_;
    std::unique_ptr<XAuthority> authority_;
    std::string name_;
};

// Returns whether this process could open the display; false for an empty name. A child process tries, because
// connecting has no time limit.
bool displayUsable(const std::string& name);

} // namespace mural::launch
