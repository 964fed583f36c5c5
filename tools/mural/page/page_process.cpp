#include "tools/mural/page/page_process.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/session_socket.hpp"
#include "tools/mural/page/admin_listener.hpp"
#include "tools/mural/page/http/page_listener.hpp"
#include "tools/mural/page/http/page_site.hpp"

namespace mural::page {

namespace {

constexpr rlim_t kMaxDescriptors = 512;
constexpr rlim_t kMaxDataBytes = rlim_t{1} << 30;
constexpr std::chrono::milliseconds kCloseTime{1500}; // for the close frames of all viewers

// A fault in a parser of this process must not become more than a fault of this process.
void limitOwnPrivileges() {
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    const auto limit = [](__rlimit_resource which, rlim_t most) {
        rlimit now{};
        if (getrlimit(which, &now) != 0) return;
        now.rlim_max = std::min(now.rlim_max, most);
        now.rlim_cur = std::min(now.rlim_cur, now.rlim_max);
        setrlimit(which, &now);
    };
    limit(RLIMIT_NOFILE, kMaxDescriptors);
    limit(RLIMIT_DATA, kMaxDataBytes);
    limit(RLIMIT_CORE, 0); // a core file would contain tokens
    std::signal(SIGPIPE, SIG_IGN);
}

std::string machineName() {
    char name[256] = {};
    return gethostname(name, sizeof name - 1) == 0 ? name : "localhost";
}

// Returns the addresses of all interfaces of this machine.
std::vector<std::string> ownAddresses() {
    std::vector<std::string> result;
    ifaddrs* all = nullptr;
    if (getifaddrs(&all) != 0) return result;
    for (const ifaddrs* at = all; at != nullptr; at = at->ifa_next) {
        if (at->ifa_addr == nullptr) continue;
        const bool isSix = at->ifa_addr->sa_family == AF_INET6;
        if (!isSix && at->ifa_addr->sa_family != AF_INET) continue;
        char text[NI_MAXHOST] = {};
        const socklen_t size = isSix ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
        if (getnameinfo(at->ifa_addr, size, text, sizeof text, nullptr, 0, NI_NUMERICHOST) == 0)
            result.emplace_back(text);
    }
    freeifaddrs(all);
    return result;
}

bool isAnyAddress(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

std::vector<std::string> hostsOf(const PageArguments& arguments, const PageAddress& address) {
    if (!address.unixPath.empty()) return {}; // the proxy in front decides
    std::vector<std::string> hosts = {"127.0.0.1", "localhost", "::1", address.host};
    if (!address.isLoopback()) hosts.push_back(machineName());
    if (isAnyAddress(address.host))
        for (std::string& own : ownAddresses()) hosts.push_back(std::move(own));
    hosts.insert(hosts.end(), arguments.hosts.begin(), arguments.hosts.end());
    return hosts;
}

std::string urlOf(const PageArguments& arguments, const PageAddress& address, bool hasTls, uint16_t port) {
    if (!address.unixPath.empty())
        return fmt::format("http://{}/", arguments.hosts.empty() ? "localhost" : arguments.hosts.front());
    std::string host = isAnyAddress(address.host) ? machineName() : address.host;
    if (host.find(':') != std::string::npos) host = "[" + host + "]";
    return fmt::format("{}://{}:{}/", hasTls ? "https" : "http", host, port);
}

Result<void> writeToken(const std::string& path, const std::string& token) {
    const FileDescriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR));
    const std::string line = token + "\n";
    if (!file.valid() || fchmod(file.get(), S_IRUSR | S_IWUSR) != 0 ||
        write(file.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
        return Error{"--page-token-file " + path + ": " + std::strerror(errno) + "; choose a writable file"};
    return {};
}

Result<std::optional<TlsFiles>> tlsFilesOf(const PageArguments& arguments, bool hasTls) {
    if (!hasTls) return std::optional<TlsFiles>();
    if (!arguments.certificate.empty()) return std::optional(TlsFiles{arguments.certificate, arguments.key});
    auto own = ownTlsFiles();
    if (!own) return own.error();
    return std::optional(*own);
}

// Prints the address of an operator, and how to trust the certificate.
Result<void> announce(PageHub& hub, const PageArguments& arguments, const PageAddress& address, const std::string& url,
                      const std::optional<TlsFiles>& tls) {
    LinkTerms terms;
    terms.role = Role::Operate;
    terms.seconds = 0;
    terms.most = 0;
    terms.name = "owner";
    hub.links().limit(terms.name, terms.role, 1); // the browser of an earlier page stays known
    auto owner = hub.links().create(terms, monotonicNowNs());
    if (!owner) return owner.error();
    hub.keepLinks();
    if (!arguments.tokenFile.empty())
        if (const auto written = writeToken(arguments.tokenFile, owner->token); !written) return written.error();
    fmt::print("{}#t={}\n", url, owner->token);
    if (tls && arguments.certificate.empty()) {
        auto fingerprint = fingerprintOf(tls->certificate);
        if (!fingerprint) return fingerprint.error();
        fmt::print("SHA-256 of its certificate: {}\n", *fingerprint);
    }
    if (!address.unixPath.empty()) fmt::print("socket: {}\n", address.unixPath);
    std::fflush(stdout);
    return {};
}

} // namespace

Result<void> servePage(const PageArguments& arguments, const PageAddress& address, bool hasTls,
                       const std::string& controlPath, const nlohmann::json& hello) {
    limitOwnPrivileges();
    boost::asio::io_context io(1);
    auto tls = tlsFilesOf(arguments, hasTls);
    if (!tls) return tls.error();
    auto listener = PageListener::open(io, {address.host, address.firstPort, address.lastPort, address.unixPath, *tls});
    if (!listener) return listener.error();
    const std::string url = urlOf(arguments, address, hasTls, (*listener)->port());

    boost::asio::steady_timer closing(io);
    std::unique_ptr<AdminListener> admin;
    const auto stop = [&] {
        (*listener)->close();
        if (admin) admin->close();
        closing.expires_after(kCloseTime);
        closing.async_wait([&io](const boost::system::error_code&) { io.stop(); });
    };
    HubConfig config;
    config.controlPath = controlPath;
    config.hello = hello;
    config.address = url;
    config.pictures = {arguments.previewRate, arguments.previewSize, arguments.previewQuality};
    config.inputMode = inputModeOfName(arguments.control).value_or(InputMode::Click);
    config.reachesUserDisplay = arguments.reachesUserDisplay;
    bool hasSessionEnded = false;
    auto hub = PageHub::create(io, std::move(config), [&] {
        hasSessionEnded = true;
        stop();
    });
    if (!hub) return hub.error();
    auto opened = AdminListener::open(io, launch::pageSocketOf(controlPath), **hub, [&] { io.stop(); });
    if (!opened) return opened.error();
    admin = std::move(*opened);
    PageSite site(io, **hub, {hostsOf(arguments, address), arguments.embedOrigin, arguments.hasOpenMetrics});
    (*listener)->serve(site);
    if (const auto announced = announce(**hub, arguments, address, url, *tls); !announced) return announced.error();
    boost::asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&io](const boost::system::error_code& error, int) {
        if (!error) io.stop();
    });
    io.run();
    if (hasSessionEnded) fmt::print(stderr, "mural page: the session has ended\n");
    return {};
}

} // namespace mural::page
