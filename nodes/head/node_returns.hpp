// Starts lost nodes again, and makes them members when they have what the others have. For how long it tries, and with what
// pauses, is said in docs/user-guide.md.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/head/node_catch_up.hpp"
#include "nodes/head/node_launcher.hpp"

namespace mural {

struct ReturnTerms {
    int tries = 0;                // in a row, of each node
    int64_t steadyMs = 30'000;    // who was back for so long has all tries again
    int64_t readyPatienceMs = 30'000;
    std::vector<int64_t> pausesMs = {0, 1'000, 3'000, 10'000, 30'000}; // before each try; the last before all further
};

// tick(), stop() and the destructor by one thread, the others by any.
class NodeReturns {
public:
    struct Hooks {
        std::function<Result<StartingNode>(int node)> start;    // by tick(); empty: none is started again
        std::function<void(int node, StartingNode&)> connected; // makes its link and sends its setup
        std::function<std::string(int node)> whyNever;          // for a reason of the session; empty: it may come back
        std::function<void(int node)> introduce; // to the others of its picture, before it catches up
        std::function<NodeSet::Turns(int node)> turns;
        std::function<std::string(int node)> tilesOfLost; // what becomes of them while it is
        std::function<NodeSet::Admission(int node, uint32_t view)> admitted; // under the lock that orders packets
        std::function<void(int node, const std::string&)> gaveUp; // with the line for the user; it stays lost
        std::function<void(const std::string&)> say;
    };

    NodeReturns(ReturnTerms terms, NodeSet& nodes, Hooks hooks);
    ~NodeReturns();

    // A member was lost. What follows of it, for the line that says so: "its tiles stay as they were until it is back".
    std::string memberLost(int node);
    // One was not there when the session began: it is started again, too.
    void notThere(int node);
    // Was it one that was on its way? Then it was not lost, but did not come back, and that is seen to.
    bool lostOnItsWay(int node, const std::string& why);
    void ready(int node); // with facts that suit the session
    void synchronized(int node, const wire::SynchronizedMessage& message);
    void turns(uint32_t number, const std::vector<std::byte>& turns);
    // Nodes that catch up do not draw the frames that nobody waits for; not once that has failed.
    [[nodiscard]] bool skipsFrames() const;
    // Called by Hooks::admitted when it agrees; false: it is gone already.
    bool becomesMember(int node);
    [[nodiscard]] bool awaited() const; // some node may come back
    [[nodiscard]] bool onItsWay(int node) const;

    struct Numbers {
        double secondsToBack = 0; // from the loss to membership
        uint64_t snapshotBytes = 0, queuedBytes = 0;
        std::vector<wire::ClientFrame> framesGiven;
    };
    [[nodiscard]] Numbers numbers(int node) const; // of its last return

    void tick(int64_t nowNs);
    // No node comes back any more; who is on its way is ended. `watch` is called meanwhile.
    void stop(const std::function<void()>& watch);

private:
    enum class Phase { Member, Waiting, Starting, Readying, Ready, CatchingUp, Over };
    struct Node {
        Phase phase = Phase::Member;
        int tries = 0; // since it was steady
        int64_t lostNs = 0, nextNs = 0, memberNs = 0;
        Deadline readyBy = Deadline::never();
        std::unique_ptr<StartingNode> starting; // tick()'s
        std::shared_ptr<NodeCatchUp> catchUp;
        std::string problem; // why the last try failed, to be seen to by tick()
        Numbers numbers;
    };

    Node& at(int node) { return nodes_[static_cast<size_t>(node)]; }
    [[nodiscard]] bool settled() const;
    void catchUp(int node);
    void fail(int node, const std::string& why, int64_t nowNs);
    void tickNode(int node, int64_t nowNs);
    void start(int node, int64_t nowNs);
    void look(int node, int64_t nowNs);

    const ReturnTerms terms_;
    NodeSet& set_;
    const Hooks hooks_;
    mutable std::mutex mutex_; // what follows
    std::vector<Node> nodes_;
    bool stopped_ = false;
    bool skipsFrames_ = true;
    uint32_t turnsAsked_ = 0; // tick()'s
};

} // namespace mural
