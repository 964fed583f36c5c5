// An in-memory network between nodes that are threads. Nodes can be lost and return: messages from and to a lost node
// do not reach its successor.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "nodes/exchange/part_routes.hpp"

namespace mural::test {

struct FakeNode {
    int rank = 0;
    int incarnation = 0; // incarnation
    friend auto operator<=>(const FakeNode&, const FakeNode&) = default;
};

class FakeNetwork {
public:
    void put(FakeNode from, FakeNode to, std::vector<std::byte> message) {
        const std::lock_guard lock(mutex_);
        if (isCut(from.rank, to.rank)) return;
        ++sent_[from.rank];
        under_[{from, to}].push_back(std::move(message));
        changed_.notify_all();
    }
    Result<std::vector<std::byte>> take(FakeNode from, FakeNode to, Deadline deadline) {
        std::unique_lock lock(mutex_);
        auto& coming = under_[{from, to}];
        if (!changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs()),
                               [&] { return !coming.empty() || gone_.contains(from) || isCut(from.rank, to.rank); }) ||
            coming.empty())
            return Error{"range " + std::to_string(from.rank + 1) + " is disconnected"};
        auto message = std::move(coming.front());
        coming.pop_front();
        return message;
    }
    void lose(FakeNode node) {
        const std::lock_guard lock(mutex_);
        gone_.insert(node);
        changed_.notify_all();
    }
    // Replaces the lost node.
    FakeNode comeAgain(int rank) {
        const std::lock_guard lock(mutex_);
        changed_.notify_all();
        return {rank, ++incarnations_[rank]};
    }
    void awaitIncarnation(int rank, int incarnation) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return incarnations_[rank] >= incarnation; });
    }
    [[nodiscard]] int sentBy(int rank) {
        const std::lock_guard lock(mutex_);
        return sent_[rank];
    }
    // Drops all messages between the two nodes.
    void cut(int a, int b) { cut_ = {a, b}; }

private:
    [[nodiscard]] bool isCut(int a, int b) const { return cut_ == std::pair(std::min(a, b), std::max(a, b)); }
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::pair<FakeNode, FakeNode>, std::deque<std::vector<std::byte>>> under_;
    std::map<int, int> incarnations_, sent_; // by rank
    std::set<FakeNode> gone_;
    std::pair<int, int> cut_{-1, -1};
};

class FakeRoutes final : public PartRoutes {
public:
    // lives: incarnations of the connected peers; 0 if not listed.
    FakeRoutes(FakeNetwork& network, FakeNode own, std::map<int, int> incarnations = {})
        : network_(network), own_(own), incarnations_(std::move(incarnations)) {}
    Result<void> send(int rank, std::vector<std::byte> message, Deadline) override {
        network_.put(own_, peer(rank), std::move(message));
        return {};
    }
    Result<std::vector<std::byte>> receive(int rank, size_t maxBytes, Deadline deadline) override {
        auto message = network_.take(peer(rank), own_, deadline);
        if (message && message->size() > maxBytes) return Error{"too large"};
        return message;
    }
    LinkTransfer takeTransfer(int) override { return {}; }
    void giveUp(int) override {}
    void renew(int rank, uint32_t incarnation) override { incarnations_[rank] = static_cast<int>(incarnation); }

private:
    [[nodiscard]] FakeNode peer(int rank) { return {rank, incarnations_[rank]}; }
    FakeNetwork& network_;
    const FakeNode own_;
    std::map<int, int> incarnations_; // by rank
};

} // namespace mural::test
