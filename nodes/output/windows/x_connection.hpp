// A connection to an X server. No call exceeds its deadline, and no error ends the process. Used by one thread.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include <xcb/xcb.h>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

struct FreeDeleter {
    void operator()(void* memory) const { std::free(memory); }
};
template <class T> using XOwned = std::unique_ptr<T, FreeDeleter>;

enum class XAnswer { Reply, Failed, TimedOut, ConnectionLost };

class XConnection {
public:
    // displayName empty: the environment's DISPLAY.
    static Result<std::unique_ptr<XConnection>> open(const std::string& displayName, Deadline deadline);
    XConnection(const XConnection&) = delete;
    XConnection& operator=(const XConnection&) = delete;
    ~XConnection();

    [[nodiscard]] xcb_connection_t* get() const { return connection_; }
    [[nodiscard]] const xcb_setup_t& setup() const { return *xcb_get_setup(connection_); }
    [[nodiscard]] const std::string& displayName() const { return displayName_; }
    // True for a server on this machine with a Unix socket, which can pass descriptors.
    [[nodiscard]] bool isLocal() const { return local_; }
    // The number of unanswered bytes that can be sent without blocking.
    [[nodiscard]] size_t bytesInFlight() const { return bytesInFlight_; }

    // Waits for the reply to a request. If the request failed, `error` (unless null) holds the reason. After TimedOut
    // the same request can be waited for again.
    template <class Reply>
    XAnswer await(unsigned sequence, Deadline deadline, XOwned<Reply>* reply,
                  XOwned<xcb_generic_error_t>* error = nullptr) {
        void* raw = nullptr;
        const XAnswer answer = awaitRaw(sequence, deadline, &raw, error);
        if (reply != nullptr)
            reply->reset(static_cast<Reply*>(raw));
        else
            std::free(raw);
        return answer;
    }

    // A request whose reply arrives after the server has processed everything before it.
    unsigned sendFence() { return xcb_get_input_focus(connection_).sequence; }
    XAnswer awaitFence(unsigned sequence, Deadline deadline) {
        return await<xcb_get_input_focus_reply_t>(sequence, deadline, nullptr);
    }

    // Waits for a checked request without a reply, by means of a fence. `error` is empty if the server has accepted the
    // request.
    XAnswer check(xcb_void_cookie_t request, Deadline deadline, XOwned<xcb_generic_error_t>& error);

    // One line for TimedOut and ConnectionLost.
    [[nodiscard]] Error describe(XAnswer answer) const;

private:
    XConnection(xcb_connection_t* connection, std::string displayName);

    XAnswer awaitRaw(unsigned sequence, Deadline deadline, void** reply, XOwned<xcb_generic_error_t>* error);

    xcb_connection_t* connection_;
    std::string displayName_;
    bool local_ = false;
    size_t bytesInFlight_ = 0;
};

} // namespace mural
