// Writes log lines. Each line has a topic and a level. A disabled line costs one load and allocates nothing; its
// arguments are evaluated, so expensive ones need enabled() first.
//
//   log::debug(Topic::Rsp, "member ", id, " lost ", count, " datagrams");
//
// Thread-safe. process_log.hpp selects the levels and the destination.
#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "common/log/levels.hpp"

namespace mural::log {

// One argument of a line: text or a number. Valid while the argument lives.
class Part {
public:
    Part(std::string_view text) : text_(text) {}   // NOLINT(google-explicit-constructor)
    Part(const std::string& text) : text_(text) {} // NOLINT(google-explicit-constructor)
    Part(const char* text) : text_(text) {}        // NOLINT(google-explicit-constructor)
    Part(char) = delete;                           // text or number?
    template <std::signed_integral Number> Part(Number number) : kind_(Kind::Signed), number_(number) {}
    template <std::unsigned_integral Number>
    Part(Number number) : kind_(Kind::Unsigned), number_(static_cast<int64_t>(uint64_t{number})) {}
    Part(double number) : kind_(Kind::Real), real_(number) {} // NOLINT(google-explicit-constructor)

    void appendTo(std::string& line) const; // a real number has two decimals

private:
    enum class Kind : uint8_t { Text, Signed, Unsigned, Real };
    Kind kind_ = Kind::Text;
    std::string_view text_;
    int64_t number_ = 0;
    double real_ = 0;
};

namespace detail {
extern std::array<std::atomic<Level>, kTopics> levels;
void write(Topic topic, Level level, std::initializer_list<Part> parts);
} // namespace detail

[[nodiscard]] inline bool enabled(Topic topic, Level level) {
    return level >= detail::levels[static_cast<size_t>(topic)].load(std::memory_order_relaxed);
}

template <class... Parts> void line(Topic topic, Level level, const Parts&... parts) {
    if (enabled(topic, level)) detail::write(topic, level, {Part(parts)...});
}
template <class... Parts> void trace(Topic topic, const Parts&... parts) { line(topic, Level::Trace, parts...); }
template <class... Parts> void debug(Topic topic, const Parts&... parts) { line(topic, Level::Debug, parts...); }
// For the user: complete sentences without a trailing period, as docs/guide/troubleshooting.md lists them.
template <class... Parts> void info(Topic topic, const Parts&... parts) { line(topic, Level::Info, parts...); }
template <class... Parts> void warning(Topic topic, const Parts&... parts) { line(topic, Level::Warning, parts...); }
template <class... Parts> void error(Topic topic, const Parts&... parts) { line(topic, Level::Error, parts...); }

} // namespace mural::log
