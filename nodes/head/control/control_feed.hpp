// The way of log lines and events from any thread to the control thread: a bounded queue.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/log/process_log.hpp"
#include "nodes/head/control/control_topic.hpp"

namespace mural {

class ControlFeed {
public:
    struct Entry {
        ControlTopic topic;
        std::string json;
    };
    struct Batch {
        std::vector<Entry> entries;
        std::array<uint64_t, kControlTopics> dropped{}; // entries that found the queue full
    };

    // Thread-safe; never waits for a client. Without a subscription to the topic it has no effect.
    void publish(ControlTopic topic, const nlohmann::json& entry);
    [[nodiscard]] bool isWanted(ControlTopic topic) const { return wanted_[indexOf(topic)].load(); }

    // Used by the control thread.
    void setWanted(ControlTopic topic, bool isWanted) { wanted_[indexOf(topic)] = isWanted; }
    Batch take();

private:
    std::array<std::atomic<bool>, kControlTopics> wanted_{};
    std::mutex mutex_; // guards the batch
    Batch batch_;
};

// Publishes every enabled log line of this process while it lives.
class LogToFeed {
public:
    explicit LogToFeed(ControlFeed& feed);

private:
    const log::Observer observer_;
};

} // namespace mural
