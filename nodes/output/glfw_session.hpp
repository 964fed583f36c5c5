// GLFW, started for one X display and ended again. GLFW is one per process and belongs to the
// thread that started it: so does this.
#pragma once

#include <memory>
#include <string>

#include "common/result.hpp"

namespace mural {

class GlfwSession {
public:
    // displayName empty: DISPLAY. Fails when another session is open in this process.
    // GLFW takes the display's name from the environment only: DISPLAY is changed for the moment of
    // starting, so no other thread should change the environment meanwhile.
    static Result<std::unique_ptr<GlfwSession>> open(const std::string& displayName);
    GlfwSession(const GlfwSession&) = delete;
    GlfwSession& operator=(const GlfwSession&) = delete;
    ~GlfwSession();

    // X errors must not end the process, but GLFW 3.3 puts Xlib's fatal handler back now and then:
    // called before anything that talks to the server.
    void guardErrors() const;

    // Lets the server do all that was sent. False when the display is lost.
    bool sync() const;

    // Sleeps until the server has sent something, `wakeFd` (if not -1) is readable, or time is
    // over.
    void waitForEvents(int wakeFd, int64_t timeoutNs) const;

    [[nodiscard]] bool displayLost() const;
    [[nodiscard]] const std::string& displayName() const { return displayName_; }

    // What GLFW last complained about, "" if nothing; forgets it.
    static std::string takeError();

private:
    explicit GlfwSession(std::string displayName)
        : displayName_(std::move(displayName)) {}
    std::string displayName_;
};

} // namespace mural
