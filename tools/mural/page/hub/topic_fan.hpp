// Distributes messages of topics to the viewers that subscribe to them, each at its own interval. Pure; not
// thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace mural::page {

enum class PageTopic : uint8_t {
    Status,   // of the head: the newest message counts
    Log,      // of the head: an array of entries
    Events,   // of the head: an array of entries
    Timeline, // of the page: results of the operation `frames`
    Clients,  // of the page: its viewers
    Outputs   // of the page: hashes of the pictures that outputs show
};
inline constexpr size_t kPageTopics = 6;
inline constexpr std::array<std::string_view, kPageTopics> kPageTopicNames = {"status",   "log",     "events",
                                                                              "timeline", "clients", "outputs"};
[[nodiscard]] std::optional<PageTopic> topicOfName(std::string_view name);
[[nodiscard]] inline std::string_view nameOf(PageTopic topic) { return kPageTopicNames[static_cast<size_t>(topic)]; }
[[nodiscard]] inline bool isOfHead(PageTopic topic) { return topic <= PageTopic::Events; }

class TopicFan {
public:
    static constexpr int64_t kMinIntervalMs = 50, kMaxIntervalMs = 3'600'000;
    static constexpr size_t kMaxEntries = 256; // of an array between two messages of a viewer
    static constexpr size_t kMaxFrames = 600;  // of the timeline between two messages

    // Performs the operation `subscribe` with the arguments topic and interval, and returns its result. The viewer
    // receives the latest message of a topic without entries at once.
    Result<nlohmann::json> subscribe(int viewer, const nlohmann::json& arguments, int64_t nowNs);
    Result<nlohmann::json> unsubscribe(int viewer, const nlohmann::json& arguments);
    void forget(int viewer);

    // Returns the smallest interval that a viewer wants, in ms; 0: nobody subscribes.
    [[nodiscard]] int64_t wantedIntervalMs(PageTopic topic) const;
    // Adds a message for all subscribers.
    void offer(PageTopic topic, const nlohmann::json& data, uint64_t dropped);
    // Calls `send` with each message that is due.
    void flush(int64_t nowNs, const std::function<void(int viewer, nlohmann::json message)>& send);

private:
    struct Subscription {
        int64_t intervalNs = 0; // 0: none
        int64_t nextNs = 0;
        std::shared_ptr<const nlohmann::json> latest; // of topics without entries
        nlohmann::json entries = nullptr;             // of the others
        uint64_t dropped = 0;
    };
    using Subscriptions = std::array<Subscription, kPageTopics>;

    static void addEntries(Subscription& subscription, const nlohmann::json& data, uint64_t dropped);
    static void addFrames(Subscription& subscription, const nlohmann::json& data);

    std::map<int, Subscriptions> viewers_;
    std::array<std::shared_ptr<const nlohmann::json>, kPageTopics> latest_;
};

} // namespace mural::page
