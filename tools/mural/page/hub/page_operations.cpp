// The operations that the page performs itself, and the way of all others to the head.
#include <algorithm>
#include <utility>

#include "common/base/clock.hpp"
#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "tools/mural/page/hub/page_hub.hpp"
#include "tools/mural/page/hub/page_replies.hpp"
#include "tools/mural/page/hub/wall_description.hpp"

namespace mural::page {

namespace {

constexpr const char* kDenied = "denied";
constexpr size_t kLoggedBytes = 200;

using Json = nlohmann::json;

// Logs a request, and its result when it comes: who, from where, what, and how it ended.
PageHub::OnReply audited(const std::string& who, const std::string& operation, const Json& arguments,
                         PageHub::OnReply onReply) {
    std::string request =
        who + " requests " + operation.substr(0, 40) + " " + jsonText(arguments).substr(0, kLoggedBytes);
    log::info(log::Topic::Session, request);
    return [request = std::move(request), onReply = std::move(onReply)](PageHub::Json reply) {
        const bool isDone = reply.value("ok", false);
        log::line(log::Topic::Session, isDone ? log::Level::Info : log::Level::Warning, request, ": ",
                  isDone ? std::string("done") : reply.value("error", std::string("failed")));
        onReply(std::move(reply));
    };
}

bool isQuick(Role required) { return required == Role::View; }

} // namespace

void PageHub::perform(Role role, const std::string& who, const std::string& operation, const Json& arguments,
                      OnReply onReply) {
    if (!arguments.is_object())
        return onReply(failureOf(control_code::kBadArgument, "the member args of a request must be an object"));
    const Role required = requiredRole(operation, arguments);
    if (role < required) {
        ++deniedRequests_;
        return onReply(failureOf(kDenied, "\"" + operation.substr(0, 40) + "\" requires the role " +
                                              std::string(nameOf(required)) + "; this link has the role " +
                                              std::string(nameOf(role))));
    }
    if (required == Role::Operate) onReply = audited(who, operation, arguments, std::move(onReply));
    if (ofPage(operation, arguments, onReply)) return;
    if (operation == "subscribe" || operation == "unsubscribe" || operation == "preview" || operation == "input-take" ||
        operation == "input-release")
        return onReply(failureOf(control_code::kFailed, operation + " requires a WebSocket"));
    HeadLink& link = isQuick(required) ? *quick_ : *slow_;
    if (operation != "help") return link.request(operation, arguments, std::move(onReply));
    link.request(operation, arguments, [onReply = std::move(onReply)](Json reply) {
        if (reply.contains("result") && reply["result"].contains("operations"))
            addOwnOperations(reply["result"]["operations"]);
        onReply(std::move(reply));
    });
}

std::optional<PageHub::Json> PageHub::ofViewer(int number, const RequestMessage& request) {
    const int64_t nowNs = monotonicNowNs();
    if (!request.arguments.is_object()) return std::nullopt;
    if (request.operation == "subscribe") return replyOf(fan_.subscribe(number, request.arguments, nowNs));
    if (request.operation == "unsubscribe") return replyOf(fan_.unsubscribe(number, request.arguments));
    if (request.operation == "preview")
        return replyOf(pictures_.preview(number, *viewers_.at(number).socket, viewers_.at(number).decodesVideo,
                                         request.arguments));
    if (request.operation == "input-take") return takeInput(number, request.arguments);
    if (request.operation == "input-release") return releaseInput(number, request.arguments);
    return std::nullopt;
}

bool PageHub::ofPage(const std::string& operation, const Json& arguments, const OnReply& onReply) {
    if (operation == "links") {
        onReply({{"ok", true}, {"result", {{"links", links_.list(monotonicNowNs())}}}});
    } else if (operation == "link-new") {
        onReply(createLink(arguments));
    } else if (operation == "link-revoke") {
        onReply(revokeLink(arguments));
    } else if (operation == "wall") {
        describeWall(onReply);
    } else {
        return false;
    }
    return true;
}

PageHub::Json PageHub::createLink(const Json& arguments) {
    auto terms = linkTermsOf(arguments);
    if (!terms) return failureOf(control_code::kBadArgument, terms.error().message);
    auto created = links_.create(*terms, monotonicNowNs());
    if (!created) return failureOf(control_code::kFailed, created.error().message);
    keepLinks();
    return {{"ok", true},
            {"result",
             {{"link", created->link},
              {"role", nameOf(terms->role)},
              {"token", created->token},
              {"address", config_.address + "#t=" + created->token}}}};
}

PageHub::Json PageHub::revokeLink(const Json& arguments) {
    const auto link = arguments.find("link");
    if (link == arguments.end() || !link->is_number_unsigned() || link->get<uint64_t>() > INT32_MAX)
        return failureOf(control_code::kBadArgument, "link: expected the number of a link");
    if (!links_.revoke(link->get<int>()))
        return failureOf(control_code::kFailed,
                         "there is no link " + std::to_string(link->get<int>()) + "; mural page links lists them");
    keepLinks();
    return {{"ok", true}, {"result", Json::object()}};
}

void PageHub::describeWall(OnReply onReply) {
    askHead("plan", Json::object(), [this, onReply = std::move(onReply)](const Json& reply) {
        const auto result = reply.find("result");
        if (result == reply.end() || !result->contains("options")) return onReply(reply);
        const auto [width, height] = pictures_.wallSize();
        auto wall = wallDescription(result->at("options"), width, height);
        if (!wall) return onReply(failureOf(control_code::kFailed, wall.error().message));
        onReply({{"ok", true}, {"result", std::move(*wall)}});
    });
}

} // namespace mural::page
