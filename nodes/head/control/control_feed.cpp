#include "nodes/head/control/control_feed.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr size_t kMaxEntries = 1024;
constexpr size_t kMaxTextBytes = 2048; // of a log line

} // namespace

void ControlFeed::publish(ControlTopic topic, const Json& entry) {
    if (!isWanted(topic)) return;
    std::string json = jsonText(entry);
    const std::lock_guard lock(mutex_);
    if (batch_.entries.size() < kMaxEntries)
        batch_.entries.push_back({topic, std::move(json)});
    else
        ++batch_.dropped[indexOf(topic)];
}

ControlFeed::Batch ControlFeed::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(batch_, {});
}

LogToFeed::LogToFeed(ControlFeed& feed)
    : observer_(log::Level::Trace, [&feed](log::Topic topic, log::Level level, std::string_view text) {
          if (!feed.isWanted(ControlTopic::Log)) return;
          feed.publish(ControlTopic::Log,
                       {{"atSeconds", static_cast<double>(monotonicNowNs()) / static_cast<double>(kNsPerS)},
                        {"topic", nameOf(topic)},
                        {"level", nameOf(level)},
                        {"text", text.substr(0, kMaxTextBytes)}});
      }) {}

} // namespace mural
