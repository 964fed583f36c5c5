// Accepts browsers: HTTP/1.1 and WebSockets, over TCP with or without TLS, or over a Unix socket. Used by the thread of
// its io_context.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>

#include "common/base/result.hpp"
#include "tools/mural/page/http/connection_site.hpp"
#include "tools/mural/page/http/tls_files.hpp"

namespace mural::page {

struct ListenConfig {
    std::string host = "127.0.0.1";             // address or name; empty with unixPath
    uint16_t firstPort = 8787, lastPort = 8806; // the first free one is used
    std::string unixPath;                       // empty: TCP
    std::optional<TlsFiles> tls;                // nullopt: no TLS
};

class PageListener {
public:
    static constexpr size_t kMaxConnections = 256;

    // Errors: no free port; an invalid certificate; the name has no address.
    static Result<std::unique_ptr<PageListener>> open(boost::asio::io_context& io, const ListenConfig& config);
    PageListener(const PageListener&) = delete;
    PageListener& operator=(const PageListener&) = delete;
    ~PageListener();

    [[nodiscard]] uint16_t port() const; // 0: a Unix socket
    // Accepts from now on. `site` must outlive the io_context's handlers.
    void serve(ConnectionSite& site);
    // Accepts no more.
    void close();

private:
    class Impl;
    explicit PageListener(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace mural::page
