// The only source that includes spdlog.
#include "common/log/log.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unistd.h>
#include <vector>

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "common/log/process_log.hpp"

namespace mural::log {

namespace detail {
constinit std::array<std::atomic<Level>, kTopics> levels{}; // zero: Info
} // namespace detail

namespace {

using Sink = spdlog::sinks::stderr_sink_mt;

// '%' begins a flag of spdlog's patterns.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result.append(c == '%' ? 2 : 1, c);
    return result;
}

std::string diagnosticPattern(const std::string& role) {
    return "%Y-%m-%dT%H:%M:%S.%fZ " + escaped(role) + "[%P] %n %l: %v";
}

// Appends a text within quotes. Bytes of UTF-8 stay as they are.
void appendQuoted(std::string& line, std::string_view text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    line += '"';
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            (line += '\\') += c;
        } else if (byte < 0x20) {
            line.append("\\u00");
            (line += kDigits[byte >> 4]) += kDigits[byte & 15];
        } else {
            line += c;
        }
    }
    line += '"';
}

std::string timeText() {
    const auto now = std::chrono::time_point_cast<std::chrono::microseconds>(std::chrono::system_clock::now());
    const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    std::array<char, 40> text{};
    const auto micros = static_cast<int>(now.time_since_epoch().count() % 1'000'000);
    const size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &utc);
    std::snprintf(text.data() + size, text.size() - size, ".%06dZ", micros);
    return text.data();
}

class Outputs {
public:
    Outputs() : lines_(std::make_shared<Sink>()), diagnostics_(std::make_shared<Sink>()) {
        for (size_t i = 0; i < kTopics; ++i) {
            const auto name = std::string(nameOf(static_cast<Topic>(i)));
            loggers_.push_back(std::make_unique<spdlog::logger>(name, diagnostics_));
            loggers_.back()->set_level(spdlog::level::trace); // enabled() filters
        }
        setPrefix("mural: ");
        setRole("mural");
    }

    void setPrefix(const std::string& prefix) { lines_->set_pattern(escaped(prefix) + "%v"); }
    // Call before other threads log.
    void setJson(bool isJson) {
        isJson_ = isJson;
        if (isJson) setPrefix("");
    }
    void setRole(const std::string& role) {
        {
            const std::lock_guard lock(roleMutex_);
            role_ = role;
        }
        diagnostics_->set_formatter(
            std::make_unique<spdlog::pattern_formatter>(diagnosticPattern(role), spdlog::pattern_time_type::utc));
    }

    void write(Topic topic, Level level, std::string_view text) {
        if (isJson_) {
            user_.log(spdlog::level::info, jsonOf(topic, level, text));
            return;
        }
        if (level < Level::Info) {
            loggers_[static_cast<size_t>(topic)]->log(level == Level::Trace ? spdlog::level::trace
                                                                            : spdlog::level::debug,
                                                      spdlog::string_view_t(text.data(), text.size()));
            return;
        }
        user_.log(spdlog::level::info, spdlog::string_view_t(text.data(), text.size()));
    }

private:
    std::string jsonOf(Topic topic, Level level, std::string_view text) {
        std::string line = "{\"ts\":\"" + timeText() + "\",\"level\":\"";
        line.append(nameOf(level)).append("\",\"topic\":\"").append(nameOf(topic)).append("\",\"process\":");
        {
            const std::lock_guard lock(roleMutex_);
            appendQuoted(line, role_);
        }
        line.append(",\"pid\":").append(std::to_string(getpid())).append(",\"text\":");
        appendQuoted(line, text);
        return line + "}";
    }

    std::atomic<bool> isJson_{false};
    std::mutex roleMutex_; // guards role_
    std::string role_;
    const std::shared_ptr<Sink> lines_, diagnostics_;
    spdlog::logger user_{"user", lines_};
    std::vector<std::unique_ptr<spdlog::logger>> loggers_; // by topic
};

struct State {
    Outputs outputs;
    std::shared_mutex mutex; // held shared by calls of receivers and observers
    std::vector<const Receiver*> receivers;
    std::vector<const Observer*> observers;
};

// Never destroyed: threads may log while the process exits.
State& state() {
    static State* const state = new State;
    return *state;
}

thread_local bool inReceiver = false;

struct InReceiver {
    InReceiver() { inReceiver = true; }
    ~InReceiver() { inReceiver = false; }
};

// Returns true if a receiver has taken the line.
bool receiverTook(Topic topic, Level level, std::string_view text) {
    if (inReceiver) return false;
    State& s = state();
    const std::shared_lock lock(s.mutex);
    const auto wants = [level](const Receiver* r) { return r->wants(level); };
    const auto innermost = std::find_if(s.receivers.rbegin(), s.receivers.rend(), wants);
    if (innermost == s.receivers.rend()) return false;
    const InReceiver inside;
    return (*innermost)->take(topic, level, text);
}

void showToObservers(Topic topic, Level level, std::string_view text) {
    if (inReceiver) return;
    State& s = state();
    const std::shared_lock lock(s.mutex);
    const InReceiver inside;
    for (const Observer* const observer : s.observers)
        if (observer->wants(level)) observer->see(topic, level, text);
}

template <class Number, class... Format> void appendNumber(std::string& line, Number number, Format... format) {
    std::array<char, 340> digits; // the longest double has 309 digits before its point
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, format...).ptr;
    line.append(digits.data(), end);
}

} // namespace

void Part::appendTo(std::string& line) const {
    switch (kind_) {
    case Kind::Text: line.append(text_); return;
    case Kind::Signed: appendNumber(line, number_); return;
    case Kind::Unsigned: appendNumber(line, static_cast<uint64_t>(number_)); return;
    case Kind::Real: appendNumber(line, real_, std::chars_format::fixed, 2); return;
    }
}

void detail::write(Topic topic, Level level, std::initializer_list<Part> parts) {
    std::string line;
    for (const Part& part : parts) part.appendTo(line);
    showToObservers(topic, level, line);
    if (!receiverTook(topic, level, line)) state().outputs.write(topic, level, line);
}

Result<void> start(const std::string& role, const std::string& prefix) {
    state().outputs.setPrefix(prefix);
    setRole(role);
    const std::string text = environmentLevels();
    const auto levels = parseLevels(text);
    if (!levels) return Error{"MURAL_LOG=" + text + ": " + levels.error().message};
    setLevels(levels.value());
    const char* const form = std::getenv("MURAL_LOG_FORMAT");
    const std::string_view format = form != nullptr ? form : "";
    if (!format.empty() && format != "text" && format != "json")
        return Error{"MURAL_LOG_FORMAT=" + std::string(format) + ": expected text or json"};
    state().outputs.setJson(format == "json");
    return {};
}

void setRole(const std::string& role) { state().outputs.setRole(role); }

void setLevels(const Levels& levels) {
    for (size_t i = 0; i < kTopics; ++i) detail::levels[i].store(levels[i], std::memory_order_relaxed);
}

Levels currentLevels() {
    Levels levels{};
    for (size_t i = 0; i < kTopics; ++i) levels[i] = detail::levels[i].load(std::memory_order_relaxed);
    return levels;
}

std::string environmentLevels() {
    const char* const text = std::getenv("MURAL_LOG");
    return text != nullptr ? text : "";
}

Receiver::Receiver(Level least, Take take) : least_(least), take_(std::move(take)) {
    State& s = state();
    const std::unique_lock lock(s.mutex);
    s.receivers.push_back(this);
}

Receiver::~Receiver() {
    State& s = state();
    const std::unique_lock lock(s.mutex);
    std::erase(s.receivers, this);
}

Observer::Observer(Level least, See see) : least_(least), see_(std::move(see)) {
    State& s = state();
    const std::unique_lock lock(s.mutex);
    s.observers.push_back(this);
}

Observer::~Observer() {
    State& s = state();
    const std::unique_lock lock(s.mutex);
    std::erase(s.observers, this);
}

} // namespace mural::log
