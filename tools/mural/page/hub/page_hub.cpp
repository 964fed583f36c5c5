#include "tools/mural/page/hub/page_hub.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <boost/asio/post.hpp>
#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "common/json/json_text.hpp"
#include "common/log/log.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "nodes/input/program_input.hpp"
#include "tools/mural/page/access/link_store.hpp"
#include "tools/mural/page/hub/output_list.hpp"
#include "tools/mural/page/hub/page_replies.hpp"

namespace mural::page {

namespace {

constexpr int64_t kHelloNs = 5 * kNsPerS;
constexpr std::chrono::milliseconds kBusyTick{10}, kCalmTick{100};
constexpr int64_t kAliveEveryNs = 2 * kNsPerS, kAliveNs = 6 * kNsPerS;
constexpr int64_t kFramesEveryNs = 250 * kNsPerMs;
constexpr int64_t kOutputsEveryNs = kNsPerS, kWallEveryNs = 5 * kNsPerS;
constexpr size_t kMaxWaiting = 64; // requests of a viewer without a reply
constexpr size_t kMaxLogLines = 1000;
constexpr const char* kLinksName = "page-links"; // removed by nodes/launch/session_socket.cpp

// Returns the folder of the head's sockets with another name.
std::string socketBeside(const std::string& controlPath, const char* name) {
    return controlPath.substr(0, controlPath.rfind('/') + 1) + name;
}

} // namespace

Result<std::unique_ptr<PageHub>> PageHub::create(boost::asio::io_context& io, HubConfig config,
                                                 std::function<void()> onEnd) {
    auto quick = HeadLink::connect(io, config.controlPath);
    if (!quick) return quick.error();
    auto slow = HeadLink::connect(io, config.controlPath);
    if (!slow) return slow.error();
    std::unique_ptr<PageHub> hub(
        new PageHub(io, std::move(config), std::move(onEnd), std::move(*quick), std::move(*slow)));
    hub->begin();
    return hub;
}

PageHub::PageHub(boost::asio::io_context& io, HubConfig config, std::function<void()> onEnd,
                 std::shared_ptr<HeadLink> quick, std::shared_ptr<HeadLink> slow)
    : config_(std::move(config)),
      onEnd_(std::move(onEnd)),
      quick_(std::move(quick)),
      slow_(std::move(slow)),
      pictures_(io, socketBeside(config_.controlPath, "pictures"), config_.pictures),
      lease_(config_.inputMode),
      input_(std::make_unique<input::ProgramInput>([&io, this](int viewer, uint32_t number) {
          boost::asio::post(io, [this, viewer, number] { pictures_.inputReached(viewer, number); });
      })),
      cursor_(std::make_unique<CursorWatch>([&io, this](const CursorState& state) {
          boost::asio::post(io, [this, state] { pictures_.setCursor(state); });
      })),
      timer_(io) {}

PageHub::~PageHub() {
    quick_->close();
    slow_->close();
}

void PageHub::begin() {
    if (!restoreLinks(socketBeside(config_.controlPath, kLinksName), links_, monotonicNowNs()))
        log::warning(log::Topic::Session, "the links of an earlier page are unreadable, and ended");
    repliedAtNs_ = monotonicNowNs();
    quick_->begin([this](const Json& message) { takeMessage(message); }, [this] { end(); });
    slow_->begin([](const Json&) {}, [this] { end(); });
    tick();
}

// The sockets close by themselves, after the message has been sent.
void PageHub::end() {
    if (std::exchange(hasEnded_, true)) return;
    timer_.cancel();
    const Json event = {{"event", "session-ended"}, {"text", "the session has ended, or its head was lost"}};
    const Json message = {{"topic", "events"}, {"dropped", 0}, {"data", Json::array({event})}};
    std::vector<int> numbers;
    for (const auto& [number, viewer] : viewers_) numbers.push_back(number);
    for (const int number : numbers) {
        if (viewers_.contains(number) && viewers_.at(number).isKnown) send(number, message);
        closeViewer(number, kCloseSessionEnded, "the session has ended");
    }
    onEnd_();
}

void PageHub::tick() {
    if (hasEnded_) return;
    const int64_t nowNs = monotonicNowNs();
    checkViewers(nowNs);
    subscribeToHead();
    fetchFrames(nowNs);
    fetchOutputs(nowNs);
    watchCursor(nowNs);
    if (pictures_.isWanted()) pictures_.tick(nowNs);
    fan_.flush(nowNs, [this](int viewer, const Json& message) { send(viewer, message); });
    if (nowNs - askedAtNs_ >= kAliveEveryNs) {
        askedAtNs_ = nowNs;
        quick_->request("latency", Json::object(), [this](const Json&) { repliedAtNs_ = monotonicNowNs(); });
    }
    timer_.expires_after(pictures_.isWanted() ? kBusyTick : kCalmTick);
    timer_.async_wait([this](const boost::system::error_code& error) {
        if (!error) tick();
    });
}

bool PageHub::isHeadAlive() const { return !hasEnded_ && monotonicNowNs() - repliedAtNs_ < kAliveNs; }

// ---- viewers

void PageHub::keepLinks() {
    const auto kept = page::keepLinks(socketBeside(config_.controlPath, kLinksName), links_, monotonicNowNs());
    if (!kept) log::warning(log::Topic::Session, kept.error().message);
}

int PageHub::join(ViewerSocket& socket, const std::string& address) {
    if (viewers_.size() >= kMaxViewers || hasEnded_) return 0;
    const int number = ++lastViewer_;
    Viewer& viewer = viewers_[number];
    viewer.socket = &socket;
    viewer.address = address;
    viewer.helloUntilNs = monotonicNowNs() + kHelloNs;
    return number;
}

void PageHub::left(int number) {
    const auto found = viewers_.find(number);
    if (found == viewers_.end()) return;
    const bool wasKnown = found->second.isKnown;
    if (wasKnown) links_.close(found->second.link.link);
    viewers_.erase(found);
    fan_.forget(number);
    pictures_.forget(number);
    if (lease_.release(number)) changeHolder();
    if (wasKnown && !hasEnded_) announceViewers();
}

void PageHub::closeViewer(int number, uint16_t code, const std::string& why) {
    const auto found = viewers_.find(number);
    if (found == viewers_.end()) return;
    ViewerSocket& socket = *found->second.socket;
    left(number); // before the close, so nothing more is sent
    socket.close(code, why);
}

void PageHub::checkViewers(int64_t nowNs) {
    std::vector<std::pair<int, bool>> ended; // viewer, and whether its link ended
    for (const auto& [number, viewer] : viewers_) {
        if (!viewer.isKnown && nowNs > viewer.helloUntilNs) ended.emplace_back(number, false);
        if (viewer.isKnown && !links_.isValid(viewer.link.link, nowNs)) ended.emplace_back(number, true);
    }
    for (const auto& [number, isLink] : ended)
        closeViewer(number, isLink ? kCloseDenied : kClosePolicy,
                    isLink ? "the link has expired or was revoked" : "no hello within 5 s");
}

void PageHub::received(int number, std::string_view text) {
    if (!viewers_.contains(number) || hasEnded_) return;
    const ClientMessage message = parseClientMessage(text);
    if (!viewers_.at(number).isKnown && !std::holds_alternative<HelloMessage>(message))
        return closeViewer(number, kCloseDenied, "the first message must be a hello");
    std::visit([this, number](const auto& kind) { take(number, kind); }, message);
}

PageHub::Access PageHub::access(std::string_view token, const std::string& address) {
    const int64_t nowNs = monotonicNowNs();
    if (!failures_.permits(address, nowNs)) return {Login::TooMany, {}};
    if (const auto known = links_.find(token, nowNs)) return {Login::Accepted, *known};
    failures_.failed(address, nowNs);
    log::info(log::Topic::Session, "an invalid or expired token from ", address, " was refused");
    return {Login::Denied, {}};
}

void PageHub::take(int number, const HelloMessage& hello) {
    Viewer& viewer = viewers_.at(number);
    if (viewer.isKnown) return;
    const Access found = access(hello.token, viewer.address);
    if (found.login == Login::TooMany)
        return closeViewer(number, kCloseTooMany, "too many failed logins; try again in a minute");
    if (found.login == Login::Denied) return closeViewer(number, kCloseDenied, "the token is not valid");
    if (!links_.open(found.link.link))
        return closeViewer(number, kCloseTooMany, "as many pages are open as this link permits");
    viewer.isKnown = true;
    viewer.link = found.link;
    viewer.decodesVideo = hello.decodesH264;
    viewer.name = hello.name.empty() ? found.link.name : hello.name;
    log::info(log::Topic::Session, "viewer ", number, " (", nameOf(found.link.role), ") from ", viewer.address);
    send(number, {{"welcome",
                   {{"role", nameOf(found.link.role)},
                    {"session", config_.hello},
                    {"client", number},
                    {"limits", limitsJson()}}}});
    announceViewers();
}

void PageHub::take(int number, const InvalidMessage& invalid) {
    ++invalidMessages_;
    if (!invalid.id.is_null() && viewers_.at(number).requests.take(monotonicNowNs()))
        send(number,
             {{"id", invalid.id}, {"ok", false}, {"code", control_code::kBadRequest}, {"error", invalid.problem}});
}

void PageHub::take(int number, const PingMessage& ping) {
    constexpr double kNsInMs = kNsPerMs;
    send(number, {{"pong", ping.time}, {"serverMs", static_cast<double>(monotonicNowNs()) / kNsInMs}});
}

void PageHub::take(int number, const AckMessage& ack) { pictures_.acknowledged(number, ack.frame, monotonicNowNs()); }

void PageHub::take(int number, const RequestMessage& request) {
    Viewer& viewer = viewers_.at(number);
    if (!viewer.requests.take(monotonicNowNs()) || viewer.waiting >= kMaxWaiting)
        return reply(number, request.id,
                     failureOf(control_code::kLimit, "a page may send 20 requests per second; wait and repeat it"));
    if (viewer.link.role >= requiredRole(request.operation, request.arguments)) {
        if (auto done = ofViewer(number, request)) return reply(number, request.id, std::move(*done));
    }
    ++viewer.waiting;
    const std::string who = fmt::format("viewer {} ({})", number, viewer.address);
    perform(viewer.link.role, who, request.operation, request.arguments, [this, number, id = request.id](Json result) {
        const auto found = viewers_.find(number);
        if (found == viewers_.end()) return;
        --found->second.waiting;
        reply(number, id, std::move(result));
    });
}

void PageHub::reply(int viewer, const Json& id, Json reply) {
    reply["id"] = id;
    send(viewer, reply);
}

void PageHub::send(int viewer, const Json& message) {
    const auto found = viewers_.find(viewer);
    if (found != viewers_.end()) found->second.socket->sendText(jsonText(message));
}

PageHub::Json PageHub::viewersJson() const {
    Json list = Json::array();
    for (const auto& [number, viewer] : viewers_)
        if (viewer.isKnown)
            list.push_back({{"client", number},
                            {"name", viewer.name},
                            {"role", nameOf(viewer.link.role)},
                            {"holder", lease_.holder() == number}});
    return list;
}

void PageHub::announceViewers() {
    const Json message = {{"topic", "clients"}, {"dropped", 0}, {"data", viewersJson()}};
    for (const auto& [number, viewer] : viewers_)
        if (viewer.isKnown) viewer.socket->sendText(jsonText(message));
}

PageHub::Numbers PageHub::numbers() const {
    Numbers result;
    for (const auto& [number, viewer] : viewers_)
        if (viewer.isKnown) ++result.viewers[static_cast<size_t>(viewer.link.role)];
    result.invalidMessages = invalidMessages_;
    result.deniedRequests = deniedRequests_;
    result.inputs = inputs_;
    result.droppedInputs = droppedInputs_;
    result.pictures = pictures_.totals();
    return result;
}

// ---- the head

void PageHub::subscribeToHead() {
    constexpr int64_t kMinOfHeadMs = 100; // one subscription serves all viewers
    for (size_t i = 0; i < subscribedMs_.size(); ++i) {
        const auto topic = static_cast<PageTopic>(i);
        int64_t wanted = fan_.wantedIntervalMs(topic);
        if (topic != PageTopic::Status) wanted = kMinOfHeadMs; // kept for the log of each node
        if (wanted > 0) wanted = std::max(wanted, kMinOfHeadMs);
        if (wanted == std::exchange(subscribedMs_[i], wanted)) continue;
        const Json topicOnly = {{"topic", nameOf(topic)}};
        if (wanted == 0)
            quick_->request("unsubscribe", topicOnly, [](const Json&) {});
        else
            quick_->request("subscribe", {{"topic", nameOf(topic)}, {"interval", wanted}}, [](const Json&) {});
    }
}

void PageHub::takeMessage(const Json& message) {
    const auto topic = message.find("topic"), data = message.find("data");
    if (!topic->is_string() || data == message.end()) return;
    const auto known = topicOfName(topic->get_ref<const std::string&>());
    if (!known || !isOfHead(*known)) return;
    const auto dropped = message.find("dropped");
    fan_.offer(*known, *data, dropped != message.end() && dropped->is_number_unsigned() ? dropped->get<uint64_t>() : 0);
    if (*known != PageTopic::Status) remember(*data);
}

void PageHub::remember(const Json& entries) {
    for (const Json& entry : entries) {
        if (!entry.is_object()) continue;
        const std::string line = logLineOf(entry);
        if (!line.empty()) log_.push_back(line);
        if (log_.size() > kMaxLogLines) log_.pop_front();
    }
}

std::string PageHub::nodeLog(int node, size_t lines) const {
    std::vector<const std::string*> chosen;
    for (auto line = log_.rbegin(); line != log_.rend() && chosen.size() < lines; ++line)
        if (namesNode(*line, node)) chosen.push_back(&*line);
    std::string text;
    for (auto line = chosen.rbegin(); line != chosen.rend(); ++line) text += **line + "\n";
    return text;
}

// Requests the frames that are new for the topic `timeline`. The request switches the head's statistics on.
void PageHub::fetchFrames(int64_t nowNs) {
    constexpr int kNewestFirst = 600, kNewestLater = 240;
    if (fan_.wantedIntervalMs(PageTopic::Timeline) == 0) {
        nextFrame_ = 0;
        return;
    }
    if (isFetchingFrames_ || nowNs - framesAtNs_ < kFramesEveryNs) return;
    framesAtNs_ = nowNs;
    isFetchingFrames_ = true;
    const Json arguments = {{"since", std::max<uint64_t>(nextFrame_, 1)},
                            {"newest", nextFrame_ == 0 ? kNewestFirst : kNewestLater}};
    quick_->request("frames", arguments, [this](const Json& reply) {
        isFetchingFrames_ = false;
        const auto result = reply.find("result");
        if (result == reply.end() || !result->is_object()) return;
        const auto next = result->find("next");
        if (next != result->end() && next->is_number_unsigned()) nextFrame_ = next->get<uint64_t>();
        fan_.offer(PageTopic::Timeline, *result, 0);
    });
}

// Requests the proofs for the topic `outputs`, and the wall that they belong to. The first of two requests makes the
// nodes prove their outputs; the second one fetches the proofs.
void PageHub::fetchOutputs(int64_t nowNs) {
    if (fan_.wantedIntervalMs(PageTopic::Outputs) == 0 || isFetchingOutputs_) return;
    if (wall_.is_null() ? nowNs - wallAtNs_ >= kOutputsEveryNs : nowNs - wallAtNs_ >= kWallEveryNs) {
        wallAtNs_ = nowNs;
        describeWall([this](const Json& reply) {
            if (const auto result = reply.find("result"); result != reply.end()) wall_ = *result;
        });
    }
    if (wall_.is_null()) return;
    if (nowNs - outputsAtNs_ >= kOutputsEveryNs) {
        outputsAtNs_ = nowNs;
        isProofDue_ = true;
        return quick_->request("outputs", Json::object(), [](const Json&) {});
    }
    if (!isProofDue_ || nowNs - outputsAtNs_ < kProofTimeNs) return;
    isProofDue_ = false;
    isFetchingOutputs_ = true;
    quick_->request("outputs", {{"areas", areasOf(wall_)}}, [this](const Json& reply) {
        isFetchingOutputs_ = false;
        if (const auto result = reply.find("result"); result != reply.end())
            fan_.offer(PageTopic::Outputs, outputList(wall_, *result), 0);
    });
}

void PageHub::askHead(const std::string& operation, const Json& arguments, OnReply onReply) {
    quick_->request(operation, arguments, std::move(onReply));
}

} // namespace mural::page
