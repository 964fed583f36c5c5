// The current link of each node: a list that grows while other threads read it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

namespace mural {

class NodeConnection;

// One thread calls add() at a time. All other calls are thread-safe.
class NodeLinks {
public:
    using Link = std::atomic<NodeConnection*>;
    static constexpr size_t kMaxNodes = 4096; // over the whole session, including nodes of earlier plans

    // Requires size() < kMaxNodes.
    void add(NodeConnection* link) {
        (*links_)[size()] = link;
        count_.fetch_add(1, std::memory_order_release);
    }

    [[nodiscard]] size_t size() const { return count_.load(std::memory_order_acquire); }
    Link& operator[](size_t node) { return (*links_)[node]; }
    Link* begin() { return links_->data(); }
    Link* end() { return links_->data() + size(); }
    [[nodiscard]] const Link* begin() const { return links_->data(); }
    [[nodiscard]] const Link* end() const { return links_->data() + size(); }

private:
    const std::unique_ptr<std::array<Link, kMaxNodes>> links_ = std::make_unique<std::array<Link, kMaxNodes>>();
    std::atomic<size_t> count_{0};
};

} // namespace mural
