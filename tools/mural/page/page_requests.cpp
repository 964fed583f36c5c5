#include "tools/mural/page/page_requests.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/launch/program_check.hpp"
#include "nodes/launch/session_socket.hpp"
#include "tools/mural/ctl/session_request.hpp"
#include "tools/mural/page/http/page_numbers.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr const char* kPageCommand = "page";
constexpr int64_t kPatienceMs = 10'000;

struct PageRequest {
    std::string operation;
    Json arguments = Json::object();
    std::string session;
};

Result<PageRequest> requestOf(const PageArguments& a) {
    PageRequest request;
    size_t used = a.stops ? 0 : 1;
    const std::string verb = a.stops || a.words.empty() ? "" : a.words.front();
    if (a.stops) {
        request.operation = "page-stop";
    } else if (verb == "links") {
        request.operation = "links";
    } else if (verb == "link") {
        const auto seconds = lifetimeOf(a.lifetime);
        if (!seconds) return seconds.error();
        request.operation = "link-new";
        request.arguments = {{"role", a.role}, {"seconds", seconds.value()}, {"most", a.most}, {"name", a.name}};
    } else {
        const auto link = a.words.size() > 1 ? wholeNumber(a.words[1], 1, INT32_MAX) : std::nullopt;
        if (!link) return Error{"revoke requires the number of a link; mural page links lists them"};
        request.operation = "link-revoke";
        request.arguments = {{"link", static_cast<unsigned>(*link)}};
        used = 2;
    }
    if (a.words.size() > used + 1) return Error{"unexpected word " + a.words[used + 1] + " (see mural page --help)"};
    if (a.words.size() > used) request.session = a.words[used];
    return request;
}

void print(const std::string& operation, const Json& result) {
    if (operation == "link-new")
        fmt::print("link {} ({}): {}\n", result.value("link", 0), result.value("role", ""),
                   result.value("address", ""));
    if (operation != "links") return;
    const Json links = result.value("links", Json::array());
    for (const Json& link : links) {
        const Json left = link.value("secondsLeft", Json());
        fmt::print("link {} ({}){}: {} of {} pages open, {}\n", link.value("link", 0), link.value("role", ""),
                   link.value("name", "").empty() ? "" : " " + link.value("name", ""), link.value("open", 0),
                   link.value("most", 0) == 0 ? "any number of" : std::to_string(link.value("most", 0)),
                   left.is_number() ? fmt::format("{} min left", left.get<int64_t>() / 60) : "no expiry");
    }
    if (links.empty()) fmt::print("no link\n");
}

} // namespace

int requestOfPage(const PageArguments& arguments) {
    const auto request = requestOf(arguments);
    if (!request) return cli::requestFailure(kPageCommand, request.error().message, launch::kExitUsage);
    int status = 0;
    auto path = cli::controlPathOf(kPageCommand, request.value().session, status);
    if (!path) return cli::requestFailure(kPageCommand, path.error().message, status);
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    auto client = cli::ControlClient::connect(launch::pageSocketOf(*path), deadline);
    if (!client)
        return cli::requestFailure(kPageCommand, "the session has no page; start it with mural page", cli::kExitFailed);
    auto reply = client->request(request.value().operation, request.value().arguments, deadline);
    if (!reply) return cli::requestFailure(kPageCommand, reply.error().message, cli::kExitFailed);
    if (cli::memberOf(*reply, "ok") != true)
        return cli::printReply(kPageCommand, request.value().operation, *reply, false);
    print(request.value().operation, cli::memberOf(*reply, "result"));
    return 0;
}

} // namespace mural::page
