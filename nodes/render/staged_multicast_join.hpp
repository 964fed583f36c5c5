// A multicast group that a node joins while packets still arrive on its connection. Buffers the group's stream until
// the switching position is known. Reading at once keeps the writer from waiting.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural {

class StagedMulticastJoin {
public:
    // Joins on its own thread. `failed`: called by that thread with the reason if the node cannot join, or leaves
    // because goOn() was not called in time.
    StagedMulticastJoin(rsp::GroupOptions options, std::function<void(const std::string&)> failed);
    ~StagedMulticastJoin();
    StagedMulticastJoin(const StagedMulticastJoin&) = delete;
    StagedMulticastJoin& operator=(const StagedMulticastJoin&) = delete;

    // Returns the stream without its first `skipBytes`. Call once. Errors: not a member; too little data before the
    // deadline.
    Result<std::unique_ptr<Connection>> goOn(uint64_t skipBytes, Deadline deadline);

private:
    void work();
    bool readSome();

    const rsp::GroupOptions options_;
    const std::function<void(const std::string&)> failed_;
    std::unique_ptr<rsp::Group> group_; // owned by work(), then by goOn()
    std::vector<std::byte> come_;       // the same
    std::atomic<bool> stop_{false};
    std::thread thread_; // declared last: uses the members above
};

} // namespace mural
