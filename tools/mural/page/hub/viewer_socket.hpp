// The WebSocket of a viewer, as the hub uses it. Tests have a socket of their own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace mural::page {

// Codes with which the page closes a WebSocket (RFC 6455, 7.4).
inline constexpr uint16_t kCloseGoingAway = 1001, kClosePolicy = 1008, kCloseDenied = 4401, kCloseSessionEnded = 4410,
                          kCloseTooMany = 4429;

class ViewerSocket {
public:
    ViewerSocket() = default;
    ViewerSocket(const ViewerSocket&) = delete;
    ViewerSocket& operator=(const ViewerSocket&) = delete;
    virtual ~ViewerSocket() = default;

    // These do not block. A socket whose viewer reads too slowly closes.
    virtual void sendText(std::string text) = 0;
    // Sends one message: the header, then the payload, which several viewers share.
    virtual void sendBinary(std::string header, std::shared_ptr<const std::string> payload) = 0;
    virtual void close(uint16_t code, const std::string& why) = 0;
};

} // namespace mural::page
