// The topics to which clients of the control interface subscribe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mural {

enum class ControlTopic : uint8_t {
    Status, // the result of the operation `status`, at an interval
    Log,    // log lines of the head
    Events, // changes of the session: programs, frames, nodes
};
inline constexpr size_t kControlTopics = 3;
inline constexpr std::array<std::string_view, kControlTopics> kControlTopicNames = {"status", "log", "events"};

inline size_t indexOf(ControlTopic topic) { return static_cast<size_t>(topic); }
inline std::string_view nameOf(ControlTopic topic) { return kControlTopicNames[indexOf(topic)]; }

} // namespace mural
