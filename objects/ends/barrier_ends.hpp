// The barriers of a process: they add threads and waiting to the state machines. A barrier is known by its name.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <mural/barrier.hpp>

#include "objects/barrier/object_barrier.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// The leader of all barriers of a session. A process that has joined the hub is a member of every barrier. Thread
// safety: any thread. The sink is called with a lock held.
class BarrierHub {
public:
    explicit BarrierHub(MessageSink& sink) : sink_(sink) {}

    using Awaited = ObjectBarrierLeader::Awaited;
    void join(PeerId member, const std::string& name, Awaited awaited = Awaited::AtOnce);
    // Joins one barrier only.
    void join(std::string_view barrier, PeerId member, const std::string& name);
    void leave(PeerId member);
    // Applies an Enter.
    Result<void> input(PeerId member, std::span<const std::byte> message, int64_t nowNs);
    // Reports missing members to those whose deadline has passed.
    void tick(int64_t nowNs);

private:
    // Returns the leader of a barrier, which has all members; null: there are too many barriers. Requires mutex_.
    ObjectBarrierLeader* leaderOf(uint32_t barrier);

    std::mutex mutex_;
    MessageSink& sink_;
    std::map<PeerId, std::string> members_; // of every barrier
    std::map<uint32_t, ObjectBarrierLeader> leaders_;
};

// The barriers that this process enters. Thread safety: any thread. The sink is called with a lock held, and must live
// until close(). Its messages go to peer kWriter.
class BarrierLine {
public:
    explicit BarrierLine(MessageSink& sink);
    ~BarrierLine() { close(); }
    BarrierLine(const BarrierLine&) = delete;
    BarrierLine& operator=(const BarrierLine&) = delete;

    // Opens the barrier of this name, once per process.
    Barrier open(std::string_view name);
    // Sets the function that waiting calls receive by (ReaderEnd::waitBy).
    void waitBy(std::function<bool(Deadline)> receive);
    // Rounds belong to the frame that this function returns at enter(), and not to the count of rounds. Call before the
    // first enter(). All members must do so.
    void countByFrames(std::function<uint64_t()> frame);
    // Applies a Go or a Late.
    Result<void> input(std::span<const std::byte> message);
    // Makes waiting calls return an error.
    void close();

    struct Core;

private:
    std::shared_ptr<Core> core_;
};

} // namespace mural::objects
