// New nodes that become members together, or not at all.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural {

// Thread-safe.
class NodeGroup {
public:
    // admit: makes all of them members, at one position of the stream. Called by the thread of one node's resync.
    NodeGroup(std::vector<int> nodes, std::function<Result<void>()> admit)
        : nodes_(std::move(nodes)), admit_(std::move(admit)) {}

    [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }
    // Records that the node's capabilities suit the session.
    void ready(int node);
    [[nodiscard]] bool areAllReady() const;
    // Records that a node has received everything, and makes all nodes members if it is the last one. Returns whether
    // they are members. Errors: the group has failed.
    Result<bool> caughtUp(int node);
    // Records why the nodes cannot become members. The first reason counts, and none after they have become members.
    void fail(const std::string& why);

    // Returns nothing until the nodes are members or the group has failed.
    [[nodiscard]] std::optional<Result<void>> outcome() const;
    [[nodiscard]] bool hasFailed() const;

private:
    const std::vector<int> nodes_;
    const std::function<Result<void>()> admit_;
    mutable std::mutex mutex_; // guards the members below
    std::set<int> ready_, caughtUp_;
    bool isAdmitting_ = false;
    std::optional<Result<void>> outcome_;
};

} // namespace mural
