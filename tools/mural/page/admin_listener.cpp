#include "tools/mural/page/admin_listener.hpp"

#include <array>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <boost/asio/write.hpp>

#include "common/ipc/user_socket.hpp"
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_protocol.hpp"
#include "nodes/head/control/control_request.hpp"
#include "tools/mural/page/hub/page_replies.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;
using boost::system::error_code;

// A client of the socket. Requests are performed one after the other.
class AdminClient : public std::enable_shared_from_this<AdminClient> {
public:
    AdminClient(boost::asio::local::stream_protocol::socket socket, PageHub& hub, std::function<void()> onStop)
        : socket_(std::move(socket)), hub_(hub), onStop_(std::move(onStop)) {}

    void begin() {
        Json hello = hub_.hello();
        hello["protocol"] = kControlVersion;
        write({{"hello", hello}});
    }

private:
    void read() {
        const size_t end = received_.find('\n');
        if (end != std::string::npos) {
            const std::string line = received_.substr(0, end);
            received_.erase(0, end + 1);
            return perform(line);
        }
        if (received_.size() > kMaxControlRequestBytes) return;
        socket_.async_read_some(boost::asio::buffer(part_),
                                [self = shared_from_this()](const error_code& error, size_t bytes) {
                                    if (error) return;
                                    self->received_.append(self->part_.data(), bytes);
                                    self->read();
                                });
    }

    void perform(const std::string& line) {
        const ControlRequest request = parseControlRequest(line);
        const auto reply = [self = shared_from_this(), id = request.id](Json result) {
            result["id"] = id;
            self->write(result);
        };
        if (!request.problem.empty()) return reply(failureOf(control_code::kBadRequest, request.problem));
        if (request.operation == "page-stop") {
            isStopping_ = true;
            return reply({{"ok", true}, {"result", Json::object()}});
        }
        hub_.perform(Role::Operate, "mural page", request.operation, request.arguments, reply);
    }

    void write(const Json& line) {
        unsent_ = jsonText(line) + "\n";
        boost::asio::async_write(socket_, boost::asio::buffer(unsent_),
                                 [self = shared_from_this()](const error_code& error, size_t) {
                                     if (self->isStopping_) return self->onStop_();
                                     if (!error) self->read();
                                 });
    }

    boost::asio::local::stream_protocol::socket socket_;
    PageHub& hub_;
    const std::function<void()> onStop_;
    std::array<char, 4096> part_{};
    std::string received_, unsent_;
    bool isStopping_ = false;
};

} // namespace

Result<std::unique_ptr<AdminListener>> AdminListener::open(boost::asio::io_context& io, const std::string& path,
                                                           PageHub& hub, std::function<void()> onStop) {
    error_code error;
    Local::socket earlier(io);
    earlier.connect(Local::endpoint(path), error);
    if (!error) return Error{"this session has a page already; mural page link prints an address of it"};
    unlink(path.c_str()); // of a page that was killed
    Local::acceptor acceptor(io);
    auto listener = listenForUser(path, SOCK_STREAM, boost::asio::socket_base::max_listen_connections);
    if (!listener) return Error{"the page cannot open its socket " + path + ": " + listener.error().message};
    acceptor.assign(Local(), listener->release());
    std::unique_ptr<AdminListener> admin(new AdminListener(std::move(acceptor), path, hub, std::move(onStop)));
    admin->accept();
    return admin;
}

AdminListener::AdminListener(Local::acceptor acceptor, std::string path, PageHub& hub, std::function<void()> onStop)
    : acceptor_(std::move(acceptor)), path_(std::move(path)), hub_(hub), onStop_(std::move(onStop)) {}

AdminListener::~AdminListener() { unlink(path_.c_str()); }

void AdminListener::close() {
    error_code ignored;
    acceptor_.close(ignored);
}

void AdminListener::accept() {
    acceptor_.async_accept([this](const error_code& error, Local::socket socket) {
        if (error) return;
        if (isPeerOwnOrRoot(socket.native_handle()))
            std::make_shared<AdminClient>(std::move(socket), hub_, onStop_)->begin();
        accept();
    });
}

} // namespace mural::page
