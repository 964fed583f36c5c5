// Settings of this process's log: levels, name, and the destination of lines.
//
// Lines for the user (Level::Info and above) go to the innermost Receiver, otherwise to standard error, as
// "PREFIXtext". Diagnostics go to standard error with time (UTC), process, topic and level. With MURAL_LOG_FORMAT=json
// each line is an object instead.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/log/levels.hpp"

namespace mural::log {

// Names the process and applies MURAL_LOG and MURAL_LOG_FORMAT. Errors: one of them is invalid.
Result<void> start(const std::string& role, const std::string& prefix);
// Changes the name in diagnostics, such as "node 3".
void setRole(const std::string& role);
void setLevels(const Levels& levels);
[[nodiscard]] Levels currentLevels();
// Returns the value of MURAL_LOG; empty: not set.
[[nodiscard]] std::string environmentLevels();

// Receives the lines of at least one level instead of standard error, while it lives. Receivers nest; they are
// destroyed in any order.
class Receiver {
public:
    // Called by the thread that logs, also by several at a time. Returns false if it could not deliver the line, which
    // then goes to standard error. Lines that it logs itself go to standard error, too.
    using Take = std::function<bool(Topic topic, Level level, std::string_view text)>;

    Receiver(Level least, Take take);
    ~Receiver(); // waits for calls in progress
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;

    [[nodiscard]] bool wants(Level level) const { return level >= least_; }
    [[nodiscard]] bool take(Topic topic, Level level, std::string_view text) const { return take_(topic, level, text); }

private:
    const Level least_;
    const Take take_;
};

// Receives a copy of each enabled line of at least one level while it lives. The line still goes to its destination.
class Observer {
public:
    // Called by the thread that logs, also by several at a time. Lines that it logs itself are not observed.
    using See = std::function<void(Topic topic, Level level, std::string_view text)>;

    Observer(Level least, See see);
    ~Observer(); // waits for calls in progress
    Observer(const Observer&) = delete;
    Observer& operator=(const Observer&) = delete;

    [[nodiscard]] bool wants(Level level) const { return level >= least_; }
    void see(Topic topic, Level level, std::string_view text) const { see_(topic, level, text); }

private:
    const Level least_;
    const See see_;
};

} // namespace mural::log
