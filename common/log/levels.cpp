#include "common/log/levels.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace mural::log {

namespace {

constexpr std::array<std::string_view, kTopics> kTopicNames = {
    "session", "node",    "program", "stream", "rsp",       "transport", "replay", "picture", "exchange",
    "output",  "barrier", "launch",  "daemon", "discovery", "affinity",  "trace",  "tool"};

constexpr std::array<std::string_view, 6> kLevelNames = {"trace", "debug", "info", "warning", "error", "off"};

template <size_t kCount> std::string listOf(const std::array<std::string_view, kCount>& names) {
    std::string list;
    for (const std::string_view name : names) list.append(list.empty() ? "" : ", ").append(name);
    return list;
}

std::string quoted(std::string_view word) { return '"' + std::string(word) + '"'; }

Error unknown(const char* what, std::string_view word) {
    return Error{"there is no " + std::string(what) + ' ' + quoted(word) +
                 "; give [TOPIC:]LEVEL,...; topics: " + listOf(kTopicNames) + "; levels: " + listOf(kLevelNames)};
}

template <size_t kCount>
std::optional<size_t> indexOf(const std::array<std::string_view, kCount>& names, std::string_view word) {
    const auto found = std::ranges::find(names, word);
    return found == names.end() ? std::nullopt : std::optional(static_cast<size_t>(found - names.begin()));
}

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

} // namespace

std::string_view nameOf(Topic topic) { return kTopicNames[static_cast<size_t>(topic)]; }

std::string_view nameOf(Level level) {
    return kLevelNames[static_cast<size_t>(static_cast<int>(level) - static_cast<int>(Level::Trace))];
}

Result<Levels> parseLevels(std::string_view text) {
    Level others = Level::Info;
    std::array<std::optional<Level>, kTopics> named;
    while (!text.empty()) {
        const size_t comma = std::min(text.find(','), text.size());
        const std::string_view item = trimmed(text.substr(0, comma));
        text.remove_prefix(std::min(comma + 1, text.size()));
        if (item.empty()) continue;
        const size_t colon = item.find(':');
        const std::string_view word = colon == std::string_view::npos ? item : item.substr(colon + 1);
        const auto level = indexOf(kLevelNames, word);
        std::optional<size_t> topic;
        if (colon != std::string_view::npos) {
            topic = indexOf(kTopicNames, item.substr(0, colon));
            if (!topic) return unknown("topic", item.substr(0, colon));
        }
        if (!level) return unknown("level", word);
        (topic ? named[*topic].emplace() : others) =
            static_cast<Level>(static_cast<int>(*level) + static_cast<int>(Level::Trace));
    }
    Levels levels{};
    for (size_t i = 0; i < kTopics; ++i) levels[i] = named[i].value_or(others);
    return levels;
}

} // namespace mural::log
