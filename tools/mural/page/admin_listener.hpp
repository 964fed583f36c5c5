// The Unix socket on which the page accepts requests of `mural page link`, `links`, `revoke` and `--off`: lines of JSON
// as in docs/reference/control.md. Only the page's own user may connect. Used by the thread of its io_context.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>

#include "common/base/result.hpp"
#include "tools/mural/page/hub/page_hub.hpp"

namespace mural::page {

class AdminListener {
public:
    // onStop: `page-stop` was requested. Errors: another page of this session runs; the folder cannot be written.
    static Result<std::unique_ptr<AdminListener>> open(boost::asio::io_context& io, const std::string& path,
                                                       PageHub& hub, std::function<void()> onStop);
    AdminListener(const AdminListener&) = delete;
    AdminListener& operator=(const AdminListener&) = delete;
    ~AdminListener(); // removes the socket

    void close();

private:
    using Local = boost::asio::local::stream_protocol;

    AdminListener(Local::acceptor acceptor, std::string path, PageHub& hub, std::function<void()> onStop);
    void accept();

    Local::acceptor acceptor_;
    const std::string path_;
    PageHub& hub_;
    const std::function<void()> onStop_;
};

} // namespace mural::page
