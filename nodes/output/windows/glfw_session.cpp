#include "nodes/output/windows/glfw_session.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <optional>
#include <poll.h>

#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "nodes/output/windows/glfw_x11.hpp"

namespace mural {

namespace {

std::atomic<bool> inUse{false};
std::atomic<bool> lost{false};

// Ignores errors of single requests, such as a window destroyed by another client or an operation overtaken by a window
// manager. The results of calls show the errors that matter.
int onXError(Display*, XErrorEvent*) { return 0; }

// The connection is lost. Xlib would end the process; with this handler all its calls fail instead.
void onXLost(Display*, void*) { lost = true; }

int quietly(Display*) {
    return 0; // Xlib's own handler prints
}

// Sets DISPLAY during its lifetime.
class DisplayName {
public:
    explicit DisplayName(const std::string& name) {
        const char* before = std::getenv("DISPLAY");
        if (name.empty() || (before != nullptr && name == before)) return;
        changed_ = true;
        if (before != nullptr) before_ = before;
        ::setenv("DISPLAY", name.c_str(), 1);
    }
    DisplayName(const DisplayName&) = delete;
    DisplayName& operator=(const DisplayName&) = delete;
    ~DisplayName() {
        if (!changed_) return;
        if (before_)
            ::setenv("DISPLAY", before_->c_str(), 1);
        else
            ::unsetenv("DISPLAY");
    }

private:
    bool changed_ = false;
    std::optional<std::string> before_;
};

} // namespace

Result<std::unique_ptr<GlfwSession>> GlfwSession::open(const std::string& displayName) {
    if (inUse.exchange(true)) return Error{"wall windows are open in this process already; close them first"};
    const DisplayName environment(displayName);
    const char* name = std::getenv("DISPLAY");
    const std::string realName = name != nullptr ? name : "";
    lost = false;
    XSetIOErrorHandler(quietly);
    if (glfwInit() != GLFW_TRUE) {
        const std::string reason = takeError();
        XSetIOErrorHandler(nullptr);
        inUse = false;
        if (realName.empty())
            return Error{"no X display for the wall windows: DISPLAY is not set; set it, or use "
                         "another --display"};
        return Error{fmt::format("cannot open wall windows on the X display '{}': {}; check that "
                                 "the server runs and that xauth allows you in",
                                 realName, reason)};
    }
    XSetIOErrorExitHandler(glfwGetX11Display(), onXLost, nullptr);
    std::unique_ptr<GlfwSession> session(new GlfwSession(realName));
    session->guardErrors();
    return session;
}

GlfwSession::~GlfwSession() {
    guardErrors();
    glfwTerminate();
    XSetErrorHandler(nullptr);
    XSetIOErrorHandler(nullptr);
    inUse = false;
}

void GlfwSession::guardErrors() const { XSetErrorHandler(onXError); }

bool GlfwSession::sync() const {
    guardErrors();
    if (!lost) XSync(glfwGetX11Display(), False);
    return !lost;
}

void GlfwSession::waitForEvents(int wakeFd, int64_t timeoutNs) const {
    // Events that Xlib has already read do not make the socket readable.
    if (!lost && XEventsQueued(glfwGetX11Display(), QueuedAlready) > 0) return;
    pollfd ready[2] = {{lost ? -1 : ConnectionNumber(glfwGetX11Display()), POLLIN, 0}, {wakeFd, POLLIN, 0}};
    const int64_t timeoutMs = std::clamp<int64_t>(timeoutNs / kNsPerMs + 1, 1, 60'000);
    ::poll(ready, 2, static_cast<int>(timeoutMs));
}

bool GlfwSession::displayLost() const { return lost; }

std::string GlfwSession::takeError() {
    const char* text = nullptr;
    if (glfwGetError(&text) == GLFW_NO_ERROR || text == nullptr) return {};
    return text;
}

} // namespace mural
