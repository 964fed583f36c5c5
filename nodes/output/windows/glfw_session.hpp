// A GLFW session on one X display. GLFW exists once per process and belongs to the thread that initialised it, as does
// this object.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace mural {

class GlfwSession {
public:
    // displayName empty: DISPLAY. Fails if this process has another session. GLFW reads the display's name only from
    // the environment: DISPLAY is changed during initialisation, so no other thread may access the environment
    // meanwhile.
    static Result<std::unique_ptr<GlfwSession>> open(const std::string& displayName);
    GlfwSession(const GlfwSession&) = delete;
    GlfwSession& operator=(const GlfwSession&) = delete;
    ~GlfwSession();

    // Installs handlers so that X errors do not end the process. GLFW 3.3 sometimes restores Xlib's handler: call this
    // before each use of the server.
    void guardErrors() const;

    // Waits until the server has processed all requests. Returns false if the display is lost.
    bool sync() const;

    // Waits for an event, for `wakeFd` to become readable (unless -1), or for the timeout.
    void waitForEvents(int wakeFd, int64_t timeoutNs) const;

    [[nodiscard]] bool displayLost() const;
    [[nodiscard]] const std::string& displayName() const { return displayName_; }

    // Returns and clears GLFW's last error, "" if none.
    static std::string takeError();

private:
    explicit GlfwSession(std::string displayName) : displayName_(std::move(displayName)) {}
    std::string displayName_;
};

} // namespace mural
