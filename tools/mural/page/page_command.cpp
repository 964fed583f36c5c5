#include "tools/mural/page/page_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/launch/program_check.hpp"
#include "nodes/launch/session_socket.hpp"
#include "tools/mural/ctl/session_request.hpp"
#include "tools/mural/page/access/link_table.hpp"
#include "tools/mural/page/page_process.hpp"
#include "tools/mural/page/page_requests.hpp"
#include "tools/mural/stat/running_sessions.hpp"

namespace mural::page {

namespace {

constexpr const char* kPage = "page";
constexpr int64_t kConnectMs = 5'000;

int serve(const PageArguments& arguments) {
    if (arguments.words.size() > 1)
        return cli::requestFailure(kPage, "unexpected word " + arguments.words[1] + " (see mural page --help)",
                                   launch::kExitUsage);
    const auto address = pageAddressOf(arguments.at);
    if (!address) return cli::requestFailure(kPage, address.error().message, launch::kExitUsage);
    const auto tls = usesTls(arguments, address.value());
    if (!tls) return cli::requestFailure(kPage, tls.error().message, launch::kExitUsage);
    int status = 0;
    const std::string session = arguments.words.empty() ? "" : arguments.words.front();
    auto path = cli::controlPathOf(kPage, session, status);
    if (!path) return cli::requestFailure(kPage, path.error().message, status);
    auto client = cli::ControlClient::connect(*path, Deadline::inMs(kConnectMs));
    if (!client) return cli::requestFailure(kPage, client.error().message, cli::kExitFailed);
    const auto served = servePage(arguments, address.value(), tls.value(), *path, client->hello());
    if (!served) return cli::requestFailure(kPage, served.error().message, launch::kExitUsage);
    return 0;
}

} // namespace

void describePage(CLI::App& command, PageArguments& a) {
    command.add_option("COMMAND", a.words, "[SESSION], or link, links or revoke LINK, followed by [SESSION]")
        ->type_name("");
    command
        .add_option("--at", a.at,
                    "where the page listens: an address of this machine, perhaps with a port, or unix:PATH (the first "
                    "free port of 127.0.0.1:8787 to 8806)")
        ->type_name("ADDRESS");
    command.add_flag("--off", a.stops, "end the page of the session");
    command.add_option("--page-cert", a.certificate, "certificate for TLS, in PEM format (one of its own)")
        ->type_name("FILE");
    command.add_option("--page-key", a.key, "key of that certificate, in PEM format")->type_name("FILE");
    command.add_option("--page-tls", a.tls, "auto: TLS beyond this machine; off: none (auto)")
        ->check(CLI::IsMember({"auto", "off"}));
    command.add_flag("--page-insecure", a.isInsecure, "permit --page-tls off beyond this machine");
    command.add_option("--page-host", a.hosts, "further host name by which browsers reach the page")->type_name("NAME");
    command
        .add_option("--page-embed", a.embedOrigin, "origin that may show the page in a frame, such as https://portal")
        ->type_name("ORIGIN");
    command.add_flag("--metrics-open", a.hasOpenMetrics, "/metrics needs no token");
    command
        .add_option("--page-token-file", a.tokenFile,
                    "write the token of the printed address to this file, readable by this user only")
        ->type_name("FILE");
    command.add_option("--preview-rate", a.previewRate, "most pictures per second of a preview (15)")
        ->type_name("N")
        ->check(CLI::Range(1, 60));
    command.add_option("--preview-size", a.previewSize, "most pixels of a preview's longer side (1280)")
        ->type_name("N")
        ->check(CLI::Range(64, 8192));
    command.add_option("--preview-quality", a.previewQuality, "highest JPEG quality of moving pictures (80)")
        ->type_name("N")
        ->check(CLI::Range(10, 95));
    command
        .add_option("--control", a.control,
                    "who sends input to the program: click (takes an idle lease), ask (input-take alone takes it), "
                    "owner (operators), all (click)")
        ->check(CLI::IsMember({"click", "ask", "owner", "all"}));
    command.add_flag("--input-on-display", a.reachesUserDisplay,
                     "send input also to a display that is not the program's private one; it moves the pointer there");
    command.add_option("--role", a.role, "link: what its viewers may do: view, input or operate (view)")
        ->check(CLI::IsMember({"view", "input", "operate"}));
    command.add_option("--for", a.lifetime, "link: lifetime such as 90s, 45m, 8h or 2d (8h)")->type_name("TIME");
    command.add_option("--most", a.most, "link: pages that may be open at once; 0: no limit (20)")
        ->type_name("N")
        ->check(CLI::Range(0, kMaxPagesOfLink));
    command.add_option("--name", a.name, "link: its name in lists")->type_name("NAME");
}

int pageCommand(const PageArguments& arguments) {
    const std::string verb = arguments.words.empty() ? "" : arguments.words.front();
    if (arguments.stops || verb == "link" || verb == "links" || verb == "revoke") return requestOfPage(arguments);
    return serve(arguments);
}

} // namespace mural::page
