// Restarts lost nodes, and makes them members after their resync. docs/guide/nodes.md states the number of attempts and
// the pauses between them.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/head/membership/node_resync.hpp"
#include "nodes/head/membership/node_group.hpp"
#include "nodes/head/membership/node_launcher.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

struct ReturnTerms {
    int tries = 0;             // consecutive attempts per node
    int64_t steadyMs = 30'000; // after this time as a member a node has all attempts again
    int64_t readyPatienceMs = 30'000;
    std::vector<int64_t> pausesMs = {0, 1'000, 3'000, 10'000, 30'000}; // before each attempt; the last value repeats
};

// tick(), stop() and the destructor need one thread. All other calls are thread-safe.
class NodeRestarter {
public:
    struct Hooks {
        std::function<Result<StartingNode>(int node)> start;    // called by tick(); empty: nodes are never restarted
        std::function<void(int node, StartingNode&)> connected; // creates the link and sends the setup
        // Returns the reason why the session can't take the node back. Empty: it can.
        std::function<std::string(int node)> whyNever;
        std::function<void(int node)> introduce; // introduces the node to the others of its picture, before the resync
        std::function<StreamBroadcaster::Turns(int node)> turns;
        // returns the consequence for the node's tiles while it is lost
        std::function<std::string(int node)> tilesOfLost;
        std::function<StreamBroadcaster::Admission(int node, uint32_t view)>
            admitted;                         // called with the lock that orders packets
        std::function<void(int node)> gaveUp; // called when the node stays lost
        std::function<void(int node)> isOver; // called when a node of a failed group has ended
    };

    NodeRestarter(ReturnTerms terms, StreamBroadcaster& nodes, Hooks hooks);
    ~NodeRestarter();

    // Records the loss of a member. Returns the consequence for the user's line: "its tiles stay as they were until it
    // is back".
    std::string memberLost(int node);
    // Returns an error if a member that is lost now would not be restarted at once.
    [[nodiscard]] Result<void> canRestart(int node) const;
    // Ends the restarts of a node for good. The caller loses its link. Errors: the node is being restarted.
    Result<void> retire(int node);
    // Begins and revokes the stop of a member: after its loss it is not restarted until bringBack(). Errors: it is no
    // member.
    Result<void> leave(int node);
    void stay(int node);
    // Starts a node again that has been stopped or removed, or that stays lost, with all attempts. Errors: it is a
    // member or being restarted; the session cannot take it back.
    Result<void> bringBack(int node);
    // Adds new nodes, which become members together. They are started once. Call from the thread of tick().
    void addGroup(const std::shared_ptr<NodeGroup>& group);
    // Makes all nodes of a group members, at the current position, and ends the restarts of the leaving ones. group:
    // null: none. Errors: a node of the group is lost already, or a leaving one is being restarted; nothing has
    // happened then.
    Result<void> exchange(const NodeGroup* group, const std::vector<int>& leaving);
    // Records that a node was absent when the session began. It is restarted as well.
    void notThere(int node);
    // Returns true if the node was being restarted: the attempt has failed, and no member was lost.
    bool lostWhileRestarting(int node, const std::string& why);
    void ready(int node); // its capabilities suit the session
    void synchronized(int node, const wire::SynchronizedMessage& message);
    void turns(uint32_t number, const std::vector<std::byte>& turns);
    // Returns whether nodes skip frames during their resync if no component waits for them. False after a resync
    // failed.
    [[nodiscard]] bool skipsFrames() const;
    // Called by Hooks::admitted when it agrees. Returns false if the node is lost already.
    bool becomesMember(int node);
    [[nodiscard]] bool awaited() const; // a node may return
    [[nodiscard]] bool isRestarting(int node) const;

    struct Numbers {
        double secondsToRejoin = 0; // time from the loss to membership
        uint64_t snapshotBytes = 0, queuedBytes = 0;
        std::vector<wire::ClientFrame> framesGiven;
    };
    [[nodiscard]] Numbers numbers(int node) const; // numbers of its last resync

    void tick(int64_t nowNs);
    // Ends all restarts in progress and starts no more. Calls `watch` meanwhile.
    void stop(const std::function<void()>& watch);

private:
    enum class Phase { Member, Waiting, Starting, Readying, Ready, CatchingUp, Over };
    struct Node {
        Phase phase = Phase::Member;
        int tries = 0; // attempts since it was last steady
        bool isRetired = false;
        std::shared_ptr<NodeGroup> group; // null: it becomes a member alone
        int64_t lostNs = 0, nextNs = 0, memberNs = 0;
        Deadline readyBy = Deadline::never();
        std::unique_ptr<StartingNode> starting; // accessed by tick() only
        std::shared_ptr<NodeResync> catchUp;
        bool givesUp = false;     // tick() reports that it stays lost
        bool isDiscarded = false; // its group has failed; tick() reports its end
        std::string problem;      // why the last attempt failed, for tick()
        Numbers numbers;
    };

    Node& at(int node) { return nodes_[static_cast<size_t>(node)]; }
    [[nodiscard]] bool settled() const;
    void catchUp(int node);
    void fail(int node, const std::string& why, int64_t nowNs);
    void failGroup(int node, const std::string& why);
    bool cancels(int node, Phase phase);
    void becomeMember(Node& n);
    NodeResync::Join joinOf(int node);
    void tickNode(int node, int64_t nowNs);
    void start(int node, int64_t nowNs);
    void pollStart(int node, int64_t nowNs);

    const ReturnTerms terms_;
    StreamBroadcaster& set_;
    const Hooks hooks_;
    mutable std::mutex mutex_; // guards the members below
    std::deque<Node> nodes_;
    bool stopped_ = false;
    bool skipsFrames_ = true;
    uint32_t phaseRequests_ = 0; // accessed by tick() only
};

} // namespace mural
