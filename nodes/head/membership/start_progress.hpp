// The progress of starting nodes, and the table that shows which of them are late, in which step, and why.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace mural {

// The steps of a node, in order. The first version check is over when the node has sent its first message.
enum class StartStep { Launched, Connected, Checked, GlReady, FirstFrame };
constexpr size_t kStartSteps = 5;

// Thread-safe. Times are readings of monotonicNowNs().
class StartProgress {
public:
    static constexpr int64_t kLateMs = 5'000; // after this time the table is shown

    explicit StartProgress(int64_t beganNs) : beganNs_(beganNs) {}

    void add(int node, const std::string& host, bool isWaitedFor = true);
    // Records that a node has reached a step, and so all earlier ones. Only the first call for a step counts.
    void reached(int node, StartStep step, int64_t nowNs);
    // Records that the session does not wait for the node any more.
    void giveUp(int node);
    [[nodiscard]] bool isLate(StartStep wanted, int64_t nowNs) const; // any node, after kLateMs

    // Returns the lines to show now. Once per step, the table of the nodes that are late with it. After a table, a line
    // for each of its nodes that has caught up. why: the reason of a late node, may be empty.
    std::vector<std::string> news(StartStep wanted, int64_t nowNs, const std::function<std::string(int)>& why);
    // Returns a summary, a heading, and a line per node that has not reached the step; at any time, for the report of a
    // failure.
    [[nodiscard]] std::vector<std::string> table(StartStep wanted, int64_t nowNs,
                                                 const std::function<std::string(int)>& why) const;

private:
    struct Node {
        int node = 0;
        std::string host;
        bool isWaitedFor = true;
        std::array<int64_t, kStartSteps> atNs{};       // 0: not reached
        std::array<bool, kStartSteps> isShownAsLate{}; // in a table, and has not caught up
    };
    [[nodiscard]] static bool isMissing(const Node& node, StartStep wanted);
    // Returns the time from which nodes are expected to take this step: for GL, when the last node connected; for the
    // first frame, when another node drew one. Requires mutex_.
    [[nodiscard]] int64_t expectedSinceNs(StartStep wanted) const;

    mutable std::mutex mutex_; // guards the members below
    int64_t beganNs_;
    std::vector<Node> nodes_;
    std::array<bool, kStartSteps> isShown_{};
};

} // namespace mural
