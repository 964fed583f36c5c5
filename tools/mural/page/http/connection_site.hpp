// Replies to HTTP requests and accepts WebSockets, for the connections of browsers. Connections are templates of Beast,
// which compile for minutes, so they include nothing else of the page.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/mural/page/hub/viewer_socket.hpp"

namespace mural::page {

inline constexpr size_t kMaxHeaderBytes = size_t{8} << 10, kMaxBodyBytes = size_t{1} << 20;
inline constexpr size_t kMaxTextMessageBytes = size_t{64} << 10; // of a WebSocket

struct HttpRequest {
    std::string method;
    std::string path; // with the query, as the browser sent it
    std::string host, origin, authorization;
    std::string body;
    std::string address; // of the client, for limits and the log
};

struct HttpResponse {
    unsigned status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers; // beside those of every response
};

class ConnectionSite {
public:
    using OnResponse = std::function<void(HttpResponse response)>;

    ConnectionSite() = default;
    ConnectionSite(const ConnectionSite&) = delete;
    ConnectionSite& operator=(const ConnectionSite&) = delete;
    virtual ~ConnectionSite() = default;

    virtual void handle(HttpRequest request, OnResponse onResponse) = 0;
    // Returns why a WebSocket is refused; nullopt: it is not.
    [[nodiscard]] virtual std::optional<HttpResponse> refusal(const HttpRequest& request) const = 0;
    // Returns the headers of every response.
    [[nodiscard]] virtual std::vector<std::pair<std::string, std::string>> commonHeaders() const = 0;

    // Adds a socket. Returns its number; 0: too many viewers.
    virtual int join(ViewerSocket& socket, const std::string& address) = 0;
    virtual void received(int viewer, std::string_view text) = 0;
    virtual void left(int viewer) = 0;
};

} // namespace mural::page
