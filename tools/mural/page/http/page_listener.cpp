#include "tools/mural/page/http/page_listener.hpp"

#include <array>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/ssl/context.hpp>

#include "common/ipc/user_socket.hpp"
#include "common/log/log.hpp"
#include "tools/mural/page/http/browser_connection.hpp"

namespace mural::page {

namespace {

using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Local = asio::local::stream_protocol;

constexpr std::chrono::milliseconds kAcceptRest{100}; // after an error such as too many descriptors

Result<std::shared_ptr<asio::ssl::context>> tlsContext(const TlsFiles& files) {
    auto context = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_server);
    error_code error;
    context->set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_tlsv1 |
                         asio::ssl::context::no_tlsv1_1);
    context->use_certificate_chain_file(files.certificate, error);
    if (error) return Error{"--page-cert " + files.certificate + ": " + error.message() + "; give a PEM file"};
    context->use_private_key_file(files.key, asio::ssl::context::pem, error);
    if (error)
        return Error{"--page-key " + files.key + ": " + error.message() +
                     "; give the PEM file of the certificate's key"};
    return context;
}

} // namespace

class PageListener::Impl {
public:
    explicit Impl(asio::io_context& io) : io_(io), rest_(io) {}

    ~Impl() {
        if (!unixPath_.empty()) unlink(unixPath_.c_str());
    }

    Result<void> listenTcp(const ListenConfig& config) {
        error_code error;
        const auto found = Tcp::resolver(io_).resolve(config.host, "", error);
        if (error || found.empty())
            return Error{"the page cannot listen at " + config.host + ": " + error.message() +
                         "; name an address of this machine with --at"};
        for (int port = config.firstPort; port <= config.lastPort; ++port) {
            if (tryPort({found.begin()->endpoint().address(), static_cast<uint16_t>(port)}, error)) return {};
            if (error != asio::error::address_in_use) break;
        }
        const bool isOne = config.firstPort == config.lastPort;
        return Error{"the page cannot listen at " + config.host + ":" + std::to_string(config.firstPort) +
                     (isOne ? "" : "-" + std::to_string(config.lastPort)) + ": " + error.message() +
                     "; choose another address or port with --at"};
    }

    Result<void> listenUnix(const std::string& path) {
        struct stat facts {};
        if (lstat(path.c_str(), &facts) == 0 && S_ISSOCK(facts.st_mode) && facts.st_uid == geteuid() &&
            isDeserted(path))
            unlink(path.c_str()); // of an earlier page
        Local::acceptor acceptor(io_);
        auto listener = listenForUser(path, SOCK_STREAM, asio::socket_base::max_listen_connections);
        if (!listener) return Error{"--at unix:" + path + ": " + listener.error().message + "; choose another path"};
        acceptor.assign(Local(), listener->release());
        unixPath_ = path;
        local_.emplace(std::move(acceptor));
        return {};
    }

    void serve(ConnectionSite& site) {
        site_ = &site;
        if (tcp_) acceptTcp();
        if (local_) acceptLocal();
    }

    void close() {
        error_code ignored;
        if (tcp_) tcp_->close(ignored);
        if (local_) local_->close(ignored);
        rest_.cancel();
    }

    [[nodiscard]] uint16_t port() const {
        error_code ignored;
        return tcp_ ? tcp_->local_endpoint(ignored).port() : uint16_t{0};
    }

    std::shared_ptr<asio::ssl::context> tls_;

private:
    static bool isDeserted(const std::string& path) {
        asio::io_context io;
        Local::socket socket(io);
        error_code error;
        socket.connect(Local::endpoint(path), error);
        return error == asio::error::connection_refused;
    }

    bool tryPort(const Tcp::endpoint& endpoint, error_code& error) {
        Tcp::acceptor acceptor(io_);
        acceptor.open(endpoint.protocol(), error);
        if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
        if (!error) acceptor.bind(endpoint, error);
        if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
        if (error) return false;
        tcp_.emplace(std::move(acceptor));
        return true;
    }

    void acceptTcp() {
        tcp_->async_accept([this](const error_code& error, Tcp::socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (error) return restThen([this] { acceptTcp(); });
            error_code ignored;
            socket.set_option(Tcp::no_delay(true), ignored);
            const auto peer = socket.remote_endpoint(ignored);
            begin(asio::generic::stream_protocol::socket(std::move(socket)), peer.address().to_string(ignored));
            acceptTcp();
        });
    }

    void acceptLocal() {
        local_->async_accept([this](const error_code& error, Local::socket socket) {
            if (error == asio::error::operation_aborted) return;
            if (error) return restThen([this] { acceptLocal(); });
            begin(asio::generic::stream_protocol::socket(std::move(socket)), "a local program");
            acceptLocal();
        });
    }

    template <class Next> void restThen(Next next) {
        rest_.expires_after(kAcceptRest);
        rest_.async_wait([next](const error_code& error) {
            if (!error) next();
        });
    }

    void begin(asio::generic::stream_protocol::socket socket, std::string address) {
        if (slot_.use_count() > static_cast<long>(kMaxConnections)) {
            log::debug(log::Topic::Session, "a connection from ", address, " is refused: there are 256");
            return; // closes it
        }
        PlainStream stream(std::move(socket));
        if (tls_)
            serveTls(TlsStream(std::move(stream), *tls_), *site_, std::move(address), slot_);
        else
            servePlain(std::move(stream), *site_, std::move(address), slot_);
    }

    asio::io_context& io_;
    asio::steady_timer rest_;
    std::optional<Tcp::acceptor> tcp_;
    std::optional<Local::acceptor> local_;
    std::string unixPath_;
    ConnectionSite* site_ = nullptr;
    std::shared_ptr<void> slot_ = std::make_shared<int>(0); // each connection has a reference
};

Result<std::unique_ptr<PageListener>> PageListener::open(asio::io_context& io, const ListenConfig& config) {
    auto impl = std::make_unique<Impl>(io);
    if (config.tls) {
        auto context = tlsContext(*config.tls);
        if (!context) return context.error();
        impl->tls_ = std::move(*context);
    }
    const auto listening = config.unixPath.empty() ? impl->listenTcp(config) : impl->listenUnix(config.unixPath);
    if (!listening) return listening.error();
    return std::unique_ptr<PageListener>(new PageListener(std::move(impl)));
}

PageListener::PageListener(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PageListener::~PageListener() = default;

uint16_t PageListener::port() const { return impl_->port(); }
void PageListener::serve(ConnectionSite& site) { impl_->serve(site); }
void PageListener::close() { impl_->close(); }

} // namespace mural::page
