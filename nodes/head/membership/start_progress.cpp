#include "nodes/head/membership/start_progress.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/base/clock.hpp"

namespace mural {
namespace {

constexpr std::array<const char*, kStartSteps> kNames = {"launched", "connected", "checked", "GL ready", "first frame"};
// The cause of a node's wait before each step.
constexpr std::array<const char*, kStartSteps> kWaits = {"its process", "its connection", "the check of its version",
                                                         "its GL", "its first frame"};

std::string secondsText(int64_t ns) {
    return fmt::format("{:.1f} s", static_cast<double>(ns) / static_cast<double>(kNsPerS));
}

} // namespace

void StartProgress::add(int node, const std::string& host, bool isWaitedFor) {
    const std::lock_guard lock(mutex_);
    nodes_.push_back({node, host, isWaitedFor, {}});
}

void StartProgress::reached(int node, StartStep step, int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    for (Node& n : nodes_) {
        if (n.node != node) continue;
        for (size_t i = 0; i <= static_cast<size_t>(step); ++i)
            if (n.atNs[i] == 0) n.atNs[i] = std::max<int64_t>(nowNs, 1);
    }
}

void StartProgress::giveUp(int node) {
    const std::lock_guard lock(mutex_);
    for (Node& n : nodes_)
        if (n.node == node) n.isWaitedFor = false;
}

bool StartProgress::isMissing(const Node& node, StartStep wanted) {
    return node.isWaitedFor && node.atNs[static_cast<size_t>(wanted)] == 0;
}

int64_t StartProgress::expectedSinceNs(StartStep wanted) const {
    if (wanted == StartStep::FirstFrame) {
        int64_t first = INT64_MAX; // no program draws
        for (const Node& n : nodes_)
            if (const int64_t at = n.atNs[static_cast<size_t>(wanted)]; at != 0) first = std::min(first, at);
        return first;
    }
    int64_t since = beganNs_;
    if (wanted == StartStep::GlReady)
        for (const Node& n : nodes_) since = std::max(since, n.atNs[static_cast<size_t>(StartStep::Connected)]);
    return since;
}

bool StartProgress::isLate(StartStep wanted, int64_t nowNs) const {
    const std::lock_guard lock(mutex_);
    return nowNs - kLateMs * kNsPerMs >= expectedSinceNs(wanted) && !isShown_[static_cast<size_t>(wanted)] &&
           std::ranges::any_of(nodes_, [&](const Node& n) { return isMissing(n, wanted); });
}

std::vector<std::string> StartProgress::news(StartStep wanted, int64_t nowNs,
                                             const std::function<std::string(int)>& why) {
    const auto step = static_cast<size_t>(wanted);
    std::vector<std::string> lines;
    if (isLate(wanted, nowNs)) lines = table(wanted, nowNs, why);
    const std::lock_guard lock(mutex_);
    if (!lines.empty()) {
        isShown_[step] = true;
        for (Node& n : nodes_) n.isShownAsLate[step] = isMissing(n, wanted);
    }
    for (Node& n : nodes_)
        for (size_t i = 0; i < kStartSteps; ++i) {
            if (!n.isShownAsLate[i] || n.atNs[i] == 0) continue;
            n.isShownAsLate[i] = false;
            lines.push_back(fmt::format("node {} ({}) has caught up: {} {} after the start", n.node, n.host, kNames[i],
                                        secondsText(n.atNs[i] - beganNs_)));
        }
    return lines;
}

std::vector<std::string> StartProgress::table(StartStep wanted, int64_t nowNs,
                                              const std::function<std::string(int)>& why) const {
    std::vector<Node> late;
    size_t all = 0, hostColumns = 5;
    int64_t beganNs = 0;
    {
        const std::lock_guard lock(mutex_);
        beganNs = beganNs_;
        all = nodes_.size();
        for (const Node& n : nodes_)
            if (isMissing(n, wanted)) late.push_back(n);
    }
    if (late.empty()) return {};
    for (const Node& n : late) hostColumns = std::max(hostColumns, n.host.size() + 1);
    std::vector<std::string> lines;
    lines.push_back(fmt::format("{} of {} nodes {} late, {} after the start:", late.size(), all,
                                late.size() == 1 ? "is" : "are", secondsText(nowNs - beganNs)));
    const auto steps = static_cast<size_t>(wanted) + 1;
    std::string heading = fmt::format("{:<6}{:<{}}", "node", "host", hostColumns);
    for (size_t i = 0; i < steps; ++i) heading += fmt::format("{:<12}", kNames[i]);
    lines.push_back(heading + "waits for");
    for (const Node& n : late) {
        std::string line = fmt::format("{:<6}{:<{}}", n.node, n.host, hostColumns);
        size_t next = steps - 1;
        for (size_t i = 0; i < steps; ++i) {
            line += fmt::format("{:<12}", n.atNs[i] == 0 ? "-" : secondsText(n.atNs[i] - beganNs));
            if (n.atNs[i] == 0) next = std::min(next, i);
        }
        const std::string reason = why(n.node);
        lines.push_back(line + kWaits[next] + (reason.empty() ? "" : ": " + reason));
    }
    return lines;
}

} // namespace mural
