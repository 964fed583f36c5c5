#include "tools/mural/page/hub/topic_fan.hpp"

#include <algorithm>

#include "common/base/clock.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr std::array<int64_t, kPageTopics> kDefaultIntervalMs = {1000, 100, 100, 250, 100, 1000};

constexpr const char* kTopicList = "expected status, log, events, timeline, clients or outputs";

Result<PageTopic> topicOf(const Json& arguments) {
    const auto topic = arguments.find("topic");
    if (topic == arguments.end() || !topic->is_string()) return Error{std::string("topic: ") + kTopicList};
    const auto found = topicOfName(topic->get_ref<const std::string&>());
    if (!found) return Error{std::string("topic: ") + kTopicList};
    return *found;
}

Result<void> checkNames(const Json& arguments, bool hasInterval) {
    for (const auto& [name, value] : arguments.items())
        if (name != "topic" && (name != "interval" || !hasInterval))
            return Error{"unknown argument \"" + name.substr(0, 40) + "\""};
    return {};
}

} // namespace

std::optional<PageTopic> topicOfName(std::string_view name) {
    const auto found = std::ranges::find(kPageTopicNames, name);
    if (found == kPageTopicNames.end()) return std::nullopt;
    return static_cast<PageTopic>(found - kPageTopicNames.begin());
}

Result<Json> TopicFan::subscribe(int viewer, const Json& arguments, int64_t nowNs) {
    if (const auto named = checkNames(arguments, true); !named) return named.error();
    auto topic = topicOf(arguments);
    if (!topic) return topic.error();
    const auto index = static_cast<size_t>(*topic);
    int64_t intervalMs = kDefaultIntervalMs[index];
    if (const auto interval = arguments.find("interval"); interval != arguments.end()) {
        if (!interval->is_number_unsigned() || interval->get<uint64_t>() < kMinIntervalMs ||
            interval->get<uint64_t>() > kMaxIntervalMs)
            return Error{"interval: expected a whole number of milliseconds from 50 to 3600000"};
        intervalMs = interval->get<int64_t>();
    }
    Subscription& subscription = viewers_[viewer][index];
    subscription.intervalNs = intervalMs * kNsPerMs;
    subscription.nextNs = nowNs;
    if (subscription.latest == nullptr) subscription.latest = latest_[index];
    return Json{{"topic", nameOf(*topic)}, {"interval", intervalMs}};
}

Result<Json> TopicFan::unsubscribe(int viewer, const Json& arguments) {
    if (const auto named = checkNames(arguments, false); !named) return named.error();
    auto topic = topicOf(arguments);
    if (!topic) return topic.error();
    viewers_[viewer][static_cast<size_t>(*topic)] = {};
    return Json::object();
}

void TopicFan::forget(int viewer) { viewers_.erase(viewer); }

int64_t TopicFan::wantedIntervalMs(PageTopic topic) const {
    int64_t smallest = 0;
    for (const auto& [viewer, subscriptions] : viewers_) {
        const int64_t interval = subscriptions[static_cast<size_t>(topic)].intervalNs / kNsPerMs;
        if (interval > 0 && (smallest == 0 || interval < smallest)) smallest = interval;
    }
    return smallest;
}

void TopicFan::addEntries(Subscription& subscription, const Json& data, uint64_t dropped) {
    subscription.dropped += dropped;
    if (!subscription.entries.is_array()) subscription.entries = Json::array();
    for (const Json& entry : data) {
        if (subscription.entries.size() < kMaxEntries)
            subscription.entries.push_back(entry);
        else
            ++subscription.dropped;
    }
}

// Joins two results of `frames`: the frames of both, and the other members of the newer one.
void TopicFan::addFrames(Subscription& subscription, const Json& data) {
    const Json earlier = std::move(subscription.entries);
    subscription.entries = data;
    if (!earlier.is_object() || !earlier.contains("frames") || !data.contains("frames")) return;
    Json frames = earlier.at("frames");
    for (const Json& frame : data.at("frames")) frames.push_back(frame);
    if (frames.size() > kMaxFrames) {
        const auto surplus = static_cast<std::ptrdiff_t>(frames.size() - kMaxFrames);
        frames.erase(frames.begin(), frames.begin() + surplus);
        subscription.dropped += static_cast<uint64_t>(surplus);
    }
    subscription.entries["frames"] = std::move(frames);
}

void TopicFan::offer(PageTopic topic, const Json& data, uint64_t dropped) {
    const auto index = static_cast<size_t>(topic);
    const bool isList = topic == PageTopic::Log || topic == PageTopic::Events;
    if (isList && !data.is_array()) return;
    const bool isLatest = !isList && topic != PageTopic::Timeline;
    if (isLatest) latest_[index] = std::make_shared<const Json>(data);
    for (auto& [viewer, subscriptions] : viewers_) {
        Subscription& subscription = subscriptions[index];
        if (subscription.intervalNs == 0) continue;
        if (isLatest)
            subscription.latest = latest_[index];
        else if (isList)
            addEntries(subscription, data, dropped);
        else
            addFrames(subscription, data);
    }
}

void TopicFan::flush(int64_t nowNs, const std::function<void(int viewer, Json message)>& send) {
    for (auto& [viewer, subscriptions] : viewers_) {
        for (size_t i = 0; i < kPageTopics; ++i) {
            Subscription& subscription = subscriptions[i];
            const bool has = subscription.latest != nullptr || !subscription.entries.is_null();
            if (subscription.intervalNs == 0 || !has || nowNs < subscription.nextNs) continue;
            Json data = std::move(subscription.entries);
            if (subscription.latest != nullptr) data = *subscription.latest;
            subscription.latest = nullptr;
            subscription.entries = nullptr;
            subscription.nextNs = nowNs + subscription.intervalNs;
            Json message = {{"topic", kPageTopicNames[i]},
                            {"dropped", std::exchange(subscription.dropped, uint64_t{0})},
                            {"data", std::move(data)}};
            send(viewer, std::move(message));
        }
    }
}

} // namespace mural::page
