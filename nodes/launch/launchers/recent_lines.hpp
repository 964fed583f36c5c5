// The last lines of a process's output, for the report of its failure.
#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <string_view>

namespace mural::launch {

// Thread-safe.
class RecentLines {
public:
    static constexpr size_t kLines = 5;
    static constexpr size_t kBytes = 300; // of one line; longer ones are cut

    // Ignores empty lines. Replaces control characters, because the line goes to a terminal.
    void add(std::string_view line);
    // "first | second"
    [[nodiscard]] std::string text() const;

private:
    mutable std::mutex mutex_;
    std::deque<std::string> lines_; // guarded by mutex_
};

} // namespace mural::launch
