#include "tools/mural/page/http/http_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/json/json_text.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/control_request.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

bool areAllMembers(const Json& status) {
    const auto nodes = status.find("nodes");
    if (nodes == status.end() || !nodes->is_array()) return false;
    return std::ranges::all_of(*nodes, [](const Json& node) {
        const std::string state = node.value("state", "");
        return state == "alive" || state == "stopped"; // an operator stopped it
    });
}

} // namespace

HttpResponse textResponse(unsigned status, std::string_view line) {
    HttpResponse response;
    response.status = status;
    response.body = std::string(line);
    if (!response.body.empty() && response.body.back() != '\n') response.body += '\n';
    return response;
}

HttpResponse jsonResponse(unsigned status, const Json& value) {
    return {status, "application/json", jsonText(value), {}};
}

HttpResponse replyResponse(const Json& reply) {
    if (reply.value("ok", false)) return jsonResponse(200, reply);
    const std::string code = reply.value("code", "");
    const unsigned status = code == "denied"                          ? 403
                            : code == control_code::kUnknownOperation ? 404
                            : code == control_code::kLimit            ? 429
                            : code == control_code::kFailed           ? 409
                                                                      : 400;
    return jsonResponse(status, reply);
}

HttpResponse healthResponse(bool isAlive, const Json* status) {
    Json checks = {{"head", isAlive ? "pass" : "fail"}};
    std::string all = isAlive ? "pass" : "fail";
    if (isAlive && status != nullptr) {
        const bool isComplete = areAllMembers(*status);
        const bool hasProgram = !status->value("programs", Json::array()).empty();
        checks["nodes"] = isComplete ? "pass" : "fail";
        checks["program"] = hasProgram ? "pass" : "warn";
        if (!isComplete) all = "fail";
        if (isComplete && !hasProgram) all = "warn";
    }
    return jsonResponse(all == "fail" ? 503 : 200, {{"status", all}, {"checks", checks}});
}

std::string pageMetrics(const PageHub::Numbers& numbers, const std::string& session, bool isHeadThere) {
    std::string text;
    const auto begin = [&](const char* name, const char* type, const char* help) {
        text += fmt::format("# HELP {0} {2}\n# TYPE {0} {1}\n", name, type, help);
    };
    const std::string label = "session=\"" + session + "\""; // has letters, digits and dashes only
    begin("mural_page_head_up", "gauge", "1: the head replies to the page.");
    text += fmt::format("mural_page_head_up{{{}}} {}\n", label, isHeadThere ? 1 : 0);
    begin("mural_page_clients", "gauge", "Open pages, by role.");
    for (const Role role : {Role::View, Role::Input, Role::Operate})
        text += fmt::format("mural_page_clients{{{},role=\"{}\"}} {}\n", label, nameOf(role),
                            numbers.viewers[static_cast<size_t>(role)]);
    const auto ofClasses = [&](const char* name, const char* help, uint64_t PictureHub::Totals::*member) {
        begin(name, "counter", help);
        for (size_t i = 0; i < kPictureClasses; ++i)
            text += fmt::format("{}{{{},class=\"{}\"}} {}\n", name, label, kPictureClassNames[i],
                                numbers.pictures[i].*member);
    };
    ofClasses("mural_page_encodes_total", "Pictures that the page encoded.", &PictureHub::Totals::encodes);
    ofClasses("mural_page_pictures_total", "Pictures that the page sent.", &PictureHub::Totals::sent);
    ofClasses("mural_page_bytes_total", "Bytes of pictures that the page sent.", &PictureHub::Totals::bytes);
    begin("mural_page_invalid_messages_total", "counter", "Messages of pages that were no valid ones.");
    text += fmt::format("mural_page_invalid_messages_total{{{}}} {}\n", label, numbers.invalidMessages);
    begin("mural_page_input_events_total", "counter", "Input events of viewers that reached the program's display.");
    text += fmt::format("mural_page_input_events_total{{{}}} {}\n", label, numbers.inputs);
    begin("mural_page_input_dropped_total", "counter",
          "Input events that were dropped: no lease, no display, or a limit.");
    text += fmt::format("mural_page_input_dropped_total{{{}}} {}\n", label, numbers.droppedInputs);
    begin("mural_page_denied_requests_total", "counter", "Requests and input that a role does not permit.");
    text += fmt::format("mural_page_denied_requests_total{{{}}} {}\n", label, numbers.deniedRequests);
    return text;
}

std::optional<int> numberIn(std::string_view query, std::string_view name, int missing, int least, int most) {
    while (!query.empty()) {
        const size_t end = query.find('&');
        const std::string_view pair = query.substr(0, end);
        query = end == std::string_view::npos ? std::string_view() : query.substr(end + 1);
        if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
            return wholeNumber(pair.substr(name.size() + 1), least, most);
    }
    return missing;
}

std::optional<int> nodeOfLogPath(std::string_view path) {
    constexpr std::string_view kBegin = "nodes/", kEnd = "/log";
    if (!path.starts_with(kBegin) || !path.ends_with(kEnd) || path.size() <= kBegin.size() + kEnd.size())
        return std::nullopt;
    constexpr int kMostNodes = 100'000;
    return wholeNumber(path.substr(kBegin.size(), path.size() - kBegin.size() - kEnd.size()), 0, kMostNodes);
}

Json parseShallowJson(std::string_view text) {
    if (depthOfJson(text) > kMaxControlDepth) return Json(Json::value_t::discarded);
    return parseJson(text);
}

} // namespace mural::page
