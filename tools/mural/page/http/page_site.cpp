#include "tools/mural/page/http/page_site.hpp"

#include <algorithm>

#include "common/base/clock.hpp"
#include "common/json/json_text.hpp"
#include "tools/mural/page/http/http_text.hpp"
#include "tools/mural/page/http/page_assets.hpp"
#include "tools/mural/page/hub/wall_description.hpp"
#include "tools/mural/page/protocol/client_message.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr std::string_view kApi = "/api/v1/";
constexpr int kMaxTraceFrames = 600, kMaxNodeLogLines = 1000, kMaxPictureWidth = 16384, kMaxJpegQuality = 95;

} // namespace

PageSite::PageSite(boost::asio::io_context& io, PageHub& hub, SiteConfig config)
    : io_(io), hub_(hub), config_(std::move(config)), hosts_(config_.hosts) {}

std::vector<std::pair<std::string, std::string>> PageSite::commonHeaders() const {
    const std::string frames = config_.embedOrigin.empty() ? "'none'" : config_.embedOrigin;
    return {{"Content-Security-Policy",
             "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors " + frames},
            {"Cache-Control", "no-store"},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"}};
}

std::optional<HttpResponse> PageSite::refusal(const HttpRequest& request) const {
    if (!config_.hosts.empty() && !hosts_.isKnownHost(request.host))
        return textResponse(421, "this host name is not one of the page; add it with --page-host");
    if (!hosts_.isOwnOrigin(request.origin, request.host))
        return textResponse(403, "requests of other origins are refused");
    return std::nullopt;
}

void PageSite::handle(HttpRequest request, OnResponse onResponse) {
    if (auto refused = refusal(request)) return onResponse(std::move(*refused));
    const size_t mark = request.path.find('?');
    const std::string path = request.path.substr(0, mark);
    const std::string query = mark == std::string::npos ? "" : request.path.substr(mark + 1);
    if (path.starts_with(kApi)) return handleApi(path.substr(kApi.size()), query, std::move(request), onResponse);
    if (request.method != "GET" && request.method != "HEAD")
        return onResponse(textResponse(405, "this resource has the method GET only"));
    if (path == "/healthz" || path == "/readyz") return answerHealth(path == "/readyz", onResponse);
    if (path == "/metrics") {
        if (config_.hasOpenMetrics) return answerMetrics(onResponse);
        return handleApi("metrics", query, std::move(request), onResponse);
    }
    if (path == "/ws") return onResponse(textResponse(426, "this resource is a WebSocket"));
    if (auto asset = assetResponse(path)) return onResponse(std::move(*asset));
    onResponse(textResponse(404, "there is no such resource"));
}

void PageSite::handleApi(const std::string& path, const std::string& query, HttpRequest request,
                         const OnResponse& onResponse) {
    if (!requests_.take(monotonicNowNs()))
        return onResponse(textResponse(429, "more than 100 requests per second; try again"));
    const std::string_view bearer = "Bearer ";
    const std::string_view given = request.authorization;
    const auto access = hub_.access(given.starts_with(bearer) ? given.substr(bearer.size()) : "", request.address);
    if (access.login == PageHub::Login::TooMany)
        return onResponse(textResponse(429, "too many failed logins; try again in a minute"));
    if (access.login == PageHub::Login::Denied) {
        HttpResponse response = textResponse(401, "a valid token is required: Authorization: Bearer TOKEN");
        response.headers.emplace_back("WWW-Authenticate", "Bearer");
        return onResponse(std::move(response));
    }
    answer({std::move(request), access.link.role, path, query}, onResponse);
}

void PageSite::answer(const Call& call, const OnResponse& onResponse) {
    if (call.path == "links" || call.path.starts_with("links/")) return answerLinks(call, onResponse);
    if (call.path == "ops") return answerOperation(call, onResponse);
    if (call.request.method != "GET") return onResponse(textResponse(405, "this resource has the method GET only"));
    answerDocument(call, onResponse);
}

void PageSite::answerDocument(const Call& call, const OnResponse& onResponse) {
    if (call.path == "metrics") return answerMetrics(onResponse);
    if (call.path == "state") return performFor(call, "status", Json::object(), onResponse);
    if (call.path == "schema") return onResponse({200, "application/schema+json", std::string(controlSchema()), {}});
    if (call.path == "picture.jpg" || call.path == "picture.png") return answerPicture(call, onResponse);
    if (call.path == "config.eqc" || call.path == "config.svg") return answerConfig(call, onResponse);
    if (call.path == "trace.json") {
        const auto frames = numberIn(call.query, "frames", 300, 1, kMaxTraceFrames);
        if (!frames) return onResponse(textResponse(400, "frames: expected a number from 1 to 600"));
        constexpr int kTries = 8;
        return answerTrace(static_cast<size_t>(*frames), kTries, onResponse);
    }
    if (const auto node = nodeOfLogPath(call.path)) {
        if (call.role < Role::Operate) return onResponse(textResponse(403, "log lines require the role operate"));
        const auto lines = numberIn(call.query, "lines", 100, 1, kMaxNodeLogLines);
        if (!lines) return onResponse(textResponse(400, "lines: expected a number from 1 to 1000"));
        return onResponse(textResponse(200, hub_.nodeLog(*node, static_cast<size_t>(*lines))));
    }
    onResponse(textResponse(404, "there is no such resource"));
}

void PageSite::performFor(const Call& call, const std::string& operation, const Json& arguments,
                          const OnResponse& onResponse) {
    hub_.perform(call.role, call.request.address, operation, arguments, [onResponse](const Json& reply) {
        if (reply.contains("result")) return onResponse(jsonResponse(200, reply["result"]));
        onResponse(replyResponse(reply));
    });
}

void PageSite::answerPicture(const Call& call, const OnResponse& onResponse) {
    PictureHub::Snapshot wanted;
    wanted.isPng = call.path.ends_with(".png");
    const auto width = numberIn(call.query, "w", 0, 0, kMaxPictureWidth);
    const auto quality = numberIn(call.query, "q", wanted.quality, 1, kMaxJpegQuality);
    if (!width || !quality)
        return onResponse(textResponse(400, "w: expected a number up to 16384; q: one from 1 to 95"));
    wanted.maxWidth = *width;
    wanted.quality = *quality;
    hub_.pictures().snapshot(wanted, [onResponse, isPng = wanted.isPng](Result<std::string> bytes) {
        if (!bytes) return onResponse(textResponse(503, bytes.error().message));
        onResponse({200, isPng ? "image/png" : "image/jpeg", std::move(*bytes), {}});
    });
}

void PageSite::answerConfig(const Call& call, const OnResponse& onResponse) {
    if (call.role < Role::Operate) return onResponse(textResponse(403, "the configuration requires the role operate"));
    hub_.askHead("plan", Json::object(), [onResponse, isDrawing = call.path.ends_with(".svg")](const Json& reply) {
        const auto result = reply.find("result");
        if (result == reply.end() || !result->contains("options")) return onResponse(replyResponse(reply));
        const Json& options = result->at("options");
        auto text = isDrawing ? configDrawing(options) : configText(options);
        if (!text) return onResponse(textResponse(503, text.error().message));
        onResponse({200, isDrawing ? "image/svg+xml" : "text/plain; charset=utf-8", std::move(*text), {}});
    });
}

void PageSite::answerLinks(const Call& call, const OnResponse& onResponse) {
    const std::string& method = call.request.method;
    if (method == "GET" && call.path == "links") return performFor(call, "links", Json::object(), onResponse);
    if (method == "POST" && call.path == "links") {
        const Json terms = call.request.body.empty() ? Json(Json::object()) : parseShallowJson(call.request.body);
        if (!terms.is_object()) return onResponse(textResponse(400, "the body must be one object of JSON"));
        return performFor(call, "link-new", terms, onResponse);
    }
    if (method == "DELETE" && call.path.starts_with("links/")) {
        const auto link = wholeNumber(call.path.substr(std::string_view("links/").size()), 0, INT32_MAX);
        if (!link) return onResponse(textResponse(400, "expected links/NUMBER"));
        return performFor(call, "link-revoke", {{"link", static_cast<unsigned>(*link)}}, onResponse);
    }
    onResponse(textResponse(405, "links has the methods GET and POST, links/NUMBER has DELETE"));
}

void PageSite::answerOperation(const Call& call, const OnResponse& onResponse) {
    if (call.request.method != "POST") return onResponse(textResponse(405, "ops has the method POST only"));
    Json body = parseShallowJson(call.request.body);
    if (body.is_object() && !body.contains("id")) body["id"] = 0;
    const ClientMessage message = parseClientMessage(jsonText(body));
    const auto* request = std::get_if<RequestMessage>(&message);
    if (request == nullptr)
        return onResponse(textResponse(400, R"(the body must be a request such as {"op":"status","args":{}})"));
    hub_.perform(call.role, call.request.address, request->operation, request->arguments,
                 [onResponse, id = request->id](Json reply) {
                     reply["id"] = id;
                     onResponse(replyResponse(reply));
                 });
}

void PageSite::answerHealth(bool isReady, const OnResponse& onResponse) {
    if (!isReady || !hub_.isHeadAlive()) return onResponse(healthResponse(hub_.isHeadAlive(), nullptr));
    hub_.askHead("status", Json::object(), [onResponse](const Json& reply) {
        const auto result = reply.find("result");
        onResponse(healthResponse(result != reply.end(), result != reply.end() ? &*result : nullptr));
    });
}

} // namespace mural::page
