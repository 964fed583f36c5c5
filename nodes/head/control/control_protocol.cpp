#include "nodes/head/control/control_protocol.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"
#include "nodes/head/control/control_request.hpp"
#include "nodes/head/control/nearest_names.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

constexpr int64_t kDefaultStatusIntervalMs = 1000;
constexpr int64_t kDefaultIntervalMs = 100;

Result<ControlTopic> topicOf(const Json& arguments) {
    const auto name = arguments.at("topic").get<std::string>();
    const auto found = std::ranges::find(kControlTopicNames, name);
    if (found == kControlTopicNames.end())
        return Error{"no topic has this name; subscribe to " +
                     joinNames({kControlTopicNames.begin(), kControlTopicNames.end()})};
    return static_cast<ControlTopic>(found - kControlTopicNames.begin());
}

} // namespace

ControlProtocol::ControlProtocol(const ControlOperations& operations, const Json& hello) : operations_(operations) {
    addOwnOperations();
    Json first = hello;
    first["protocol"] = kControlVersion;
    write({{"hello", first}});
}

void ControlProtocol::addOwnOperations() {
    own_.add({"help", "", "list the operations of this session", {}, [this](const Json&) { return help(); }});
    own_.add({"subscribe",
              "",
              "send messages of a topic from now on: status, log or events",
              {{"topic", Kind::Text, true, "status, log or events"},
               {"interval", Kind::Whole, false, "smallest time between two messages in ms, 20 to 3600000"}},
              [this](const Json& arguments) { return subscribe(arguments); }});
    own_.add({"unsubscribe",
              "",
              "send no more messages of a topic",
              {{"topic", Kind::Text, true, "status, log or events"}},
              [this](const Json& arguments) { return unsubscribe(arguments); }});
}

// ---- requests

bool ControlProtocol::acceptsBytes() const {
    return !isOver_ && received_.size() - performedBytes_ <= kMaxControlRequestBytes &&
           unsent().size() < kMaxControlUnsentBytes;
}

void ControlProtocol::receive(std::string_view bytes) {
    if (isOver_) return;
    received_.erase(0, performedBytes_);
    performedBytes_ = 0;
    received_ += bytes;
}

bool ControlProtocol::hasRequest() const {
    if (isOver_ || unsent().size() >= kMaxControlUnsentBytes) return false;
    return received_.find('\n', performedBytes_) != std::string::npos ||
           received_.size() - performedBytes_ > kMaxControlRequestBytes;
}

void ControlProtocol::perform(size_t most, int64_t nowNs) {
    for (; most > 0 && hasRequest(); --most) {
        const size_t end = received_.find('\n', performedBytes_);
        if (end == std::string::npos || end - performedBytes_ > kMaxControlRequestBytes) return refuseLongRequest();
        const std::string_view line = std::string_view(received_).substr(performedBytes_, end - performedBytes_);
        performedBytes_ = end + 1;
        performLine(line, nowNs);
    }
}

void ControlProtocol::refuseLongRequest() {
    write({{"id", nullptr},
           {"ok", false},
           {"code", control_code::kLimit},
           {"error", "a request has more than " + std::to_string(kMaxControlRequestBytes) +
                         " bytes; the connection closes; send shorter lines"}});
    isOver_ = true;
    received_.clear();
    performedBytes_ = 0;
}

void ControlProtocol::performLine(std::string_view line, int64_t nowNs) {
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    nowNs_ = nowNs;
    const ControlRequest request = parseControlRequest(line);
    Json result = Json::object();
    const ControlError error = request.problem.empty() ? performOperation(request.operation, request.arguments, result)
                                                       : ControlError{control_code::kBadRequest, request.problem};
    Json reply = {{"id", request.id}, {"ok", error.code.empty()}};
    if (error.code.empty()) {
        reply["result"] = std::move(result);
    } else {
        reply["code"] = error.code;
        reply["error"] = error.text;
    }
    write(reply);
}

ControlError ControlProtocol::performOperation(const std::string& name, const Json& arguments, Json& result) {
    if (own_.contains(name)) return own_.perform(name, arguments, result);
    if (operations_.contains(name)) return operations_.perform(name, arguments, result);
    std::vector<std::string> names = own_.names();
    for (std::string& other : operations_.names()) names.push_back(std::move(other));
    return unknownOperation(name, names);
}

Result<Json> ControlProtocol::help() const {
    Json list = Json::array();
    operations_.describe(list);
    own_.describe(list);
    return Json{{"operations", list}};
}

// ---- subscriptions

Result<Json> ControlProtocol::subscribe(const Json& arguments) {
    const auto topic = topicOf(arguments);
    if (!topic) return topic.error();
    if (topic.value() == ControlTopic::Status && !operations_.contains("status"))
        return Error{"this session has no status; subscribe to log or events"};
    const int64_t usualMs = topic.value() == ControlTopic::Status ? kDefaultStatusIntervalMs : kDefaultIntervalMs;
    const int64_t intervalMs = arguments.value("interval", usualMs);
    if (intervalMs < kMinControlIntervalMs || intervalMs > kMaxControlIntervalMs)
        return Error{"the interval of a subscription must be " + std::to_string(kMinControlIntervalMs) + " to " +
                     std::to_string(kMaxControlIntervalMs) + " ms; choose another one"};
    at(topic.value()) = {intervalMs * kNsPerMs, nowNs_, {}, 0};
    return Json{{"topic", nameOf(topic.value())}, {"interval", intervalMs}};
}

Result<Json> ControlProtocol::unsubscribe(const Json& arguments) {
    const auto topic = topicOf(arguments);
    if (!topic) return topic.error();
    at(topic.value()) = {};
    return Json::object();
}

void ControlProtocol::offer(ControlTopic topic, const std::string& entry) {
    if (!subscribes(topic)) return;
    Subscription& s = at(topic);
    if (s.entries.size() < kMaxControlWaitingEntries)
        s.entries.push_back(entry);
    else
        ++s.dropped;
}

void ControlProtocol::countDropped(ControlTopic topic, uint64_t entries) {
    if (subscribes(topic)) at(topic).dropped += entries;
}

bool ControlProtocol::hasMessage(ControlTopic topic) const {
    const Subscription& s = at(topic);
    return s.intervalNs > 0 && (topic == ControlTopic::Status || !s.entries.empty() || s.dropped > 0);
}

int64_t ControlProtocol::nextMessageNs() const {
    int64_t nextNs = INT64_MAX;
    for (size_t i = 0; i < kControlTopics; ++i)
        if (hasMessage(static_cast<ControlTopic>(i))) nextNs = std::min(nextNs, subscriptions_[i].nextNs);
    return isOver_ ? INT64_MAX : nextNs;
}

void ControlProtocol::sendMessages(int64_t nowNs) {
    for (size_t i = 0; i < kControlTopics && !isOver_; ++i) {
        const auto topic = static_cast<ControlTopic>(i);
        Subscription& s = subscriptions_[i];
        if (!hasMessage(topic) || s.nextNs > nowNs) continue;
        s.nextNs = nowNs + s.intervalNs;
        const bool hasRoom = unsent().size() < kMaxControlUnsentBytes / 2;
        if (hasRoom) sendMessage(topic);
        if (!hasRoom && topic == ControlTopic::Status) ++s.dropped; // other topics keep their entries
    }
}

void ControlProtocol::sendMessage(ControlTopic topic) {
    Subscription& s = at(topic);
    Json message = {{"topic", nameOf(topic)}, {"dropped", s.dropped}};
    s.dropped = 0;
    if (topic == ControlTopic::Status) {
        Json status;
        const ControlError error = operations_.perform("status", Json::object(), status);
        message["data"] = error.code.empty() ? std::move(status) : Json();
        return write(message);
    }
    Json entries = Json::array();
    for (const std::string& entry : s.entries) entries.push_back(parseJson(entry));
    s.entries.clear();
    message["data"] = std::move(entries);
    write(message);
}

// ---- bytes to send

void ControlProtocol::write(const Json& line) {
    // Text from nodes and programs may not be valid UTF-8.
    unsent_ += jsonText(line);
    unsent_ += '\n';
}

void ControlProtocol::sent(size_t bytes) {
    sentBytes_ += std::min(bytes, unsent().size());
    if (sentBytes_ < unsent_.size() / 2) return; // moves each byte once on average
    unsent_.erase(0, sentBytes_);
    sentBytes_ = 0;
}

} // namespace mural
