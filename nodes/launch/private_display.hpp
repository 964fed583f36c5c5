// An X server of our own (Xvfb) for programs that run without a display, or that must see a screen of
// the wall's size: there every size question has a true answer.
#pragma once

#include <memory>
#include <string>

#include "common/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/x_authority.hpp"

namespace mural::launch {

constexpr int kMaxScreenSize = 32767; // the X protocol's coordinates are 16 bits with sign
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

    // Points a program at this display, and away from a Wayland one.
    void use(Environment& environment) const;

private:
    PrivateDisplay() = default;
    ChildProcess server_;
    std::unique_ptr<XAuthority> authority_;
    std::string name_;
};

// Whether this process could open the display (empty name: there is none). Asked in a child process,
// because connecting has no time limit of its own.
bool displayUsable(const std::string& name);

} // namespace mural::launch
