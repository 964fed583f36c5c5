// Records the log lines of a test instead of printing them.
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "common/log/process_log.hpp"

namespace mural {

class RecordedLog {
public:
    // levels: as in MURAL_LOG, while this object lives.
    explicit RecordedLog(std::string_view levels = "") { log::setLevels(log::parseLevels(levels).value()); }
    ~RecordedLog() { log::setLevels(before_); }
    RecordedLog(const RecordedLog&) = delete;
    RecordedLog& operator=(const RecordedLog&) = delete;

    [[nodiscard]] std::vector<std::string> texts() const {
        const std::lock_guard lock(mutex_);
        return texts_;
    }
    // Returns all lines, each with '\n'.
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const std::string& line : texts()) all += line + "\n";
        return all;
    }

private:
    const log::Levels before_ = log::currentLevels();
    mutable std::mutex mutex_;
    std::vector<std::string> texts_;
    const log::Receiver receiver_{log::Level::Trace, [this](log::Topic, log::Level, std::string_view text) {
                                      const std::lock_guard lock(mutex_);
                                      texts_.emplace_back(text);
                                      return true;
                                  }};
};

} // namespace mural
