// The plans of a session: the one of its start, and a further one for each change. A stage is one plan with the modules
// that depend on its nodes.
//
// A change has one position in the stream (StreamBroadcaster::exchangeMembers). Frames before it belong to the earlier
// stage, later ones to the new stage. The messages of each node pass that position at a time of their own. The stage of
// a message therefore follows from its node.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "nodes/head/balancing/load_balancer.hpp"
#include "nodes/head/frames/picture_assembler.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

struct SessionStage {
    // outputs: the plan whose canvases the session shows. A canvas that is off in `plan` is black.
    SessionStage(SessionConfig config, SessionPlan plan, const SessionPlan& outputs, PictureAssembler::Deliver deliver,
                 LoadBalancer::Announce announce);

    const SessionConfig config;
    const SessionPlan plan;
    const bool takesPictures;   // nodes send their pictures to the head
    const bool ownsWallWindows; // the head shows the wall in windows
    PictureAssembler pictures;
    LoadBalancer balancer;
};

// Thread-safe. The sequence drops a stage at the first change after the stage is over. It drops a stage that never
// became current when it prepares the next one. Others may keep stages longer.
class PlanSequence {
public:
    struct Hooks {
        std::function<void(const WindowPicture& picture)> isWhole; // called before the frame counts as finished
        std::function<void(WindowPicture picture)> output;         // the same pictures, in the order of the frames
        std::function<void()> closeWall;                           // nodes show the wall from now on
        LoadBalancer::Announce announce;                           // of the current stage
    };

    PlanSequence(SessionConfig config, SessionPlan plan, Hooks hooks);

    // The plan of the start, whose canvases the session shows.
    [[nodiscard]] const SessionPlan& outputs() const { return outputs_; }
    [[nodiscard]] std::shared_ptr<SessionStage> current() const;
    // Returns the stage of the node's latest message; before it is a member, the stage that it joins. After it has
    // left, a stage in which its number is vacant.
    [[nodiscard]] std::shared_ptr<SessionStage> of(int node) const;
    [[nodiscard]] std::shared_ptr<const NodePlan> nodePlan(int node) const {
        const auto stage = of(node);
        return {stage, &stage->plan.nodes[static_cast<size_t>(node)]};
    }
    // The next number of a node. Lower numbers are in use, or vacant.
    [[nodiscard]] int nodeCount() const { return nodeCount_.load(std::memory_order_acquire); }

    // Returns a stage whose plan has further nodes. change() makes it the current one. At most one stage is prepared at
    // a time, and no earlier change is in progress.
    std::shared_ptr<SessionStage> prepare(SessionConfig config, SessionPlan plan);
    // kept: members of both stages; other nodes of both are lost at the moment. leaving: other members of the current
    // stage. view: the view of the first joining node. Call at the position of the change, after everyone has passed
    // the one before.
    void change(const std::shared_ptr<SessionStage>& next, std::set<int> kept, const std::vector<int>& leaving,
                uint32_t view);
    // Returns whether all nodes have passed the latest change.
    [[nodiscard]] bool isSettled() const;

    void nodeJoins(int node, uint32_t view); // the current stage
    void nodeInView(int node, uint32_t view);
    void nodeLost(int node); // or it has left
    void windowGone(uint32_t client, uint32_t window);
    void clientGone(uint32_t client);

private:
    struct Entry { // in the order of the changes
        std::shared_ptr<SessionStage> stage;
        std::set<int> draining;         // nodes that have not passed its end
        std::deque<WindowPicture> held; // until the earlier stage is over
        bool isOver = false;
    };
    std::shared_ptr<SessionStage> addStage(SessionConfig config, SessionPlan plan);
    void deliver(const SessionStage& stage, WindowPicture picture);
    void passed(int node);
    void assign(int node, std::shared_ptr<SessionStage> stage);
    [[nodiscard]] std::vector<std::shared_ptr<SessionStage>> stagesWith(int node) const;
    [[nodiscard]] std::vector<std::shared_ptr<SessionStage>> stagesInUse() const;
    [[nodiscard]] LoadBalancer::Announce announceOf(const std::shared_ptr<SessionStage*>& stage);

    const Hooks hooks_;
    const SessionPlan outputs_;
    std::atomic<int> nodeCount_{0};
    std::mutex announceMutex_;       // held while the current stage announces, and by change()
    mutable std::mutex mutex_;       // guards the members below; locked after those of a stage
    std::deque<Entry> entries_;      // the current stage, and earlier ones since the change before the latest
    std::set<int> kept_;             // nodes that have not passed the latest change
    uint32_t view_ = 0;              // of the latest change
    mutable std::mutex stagesMutex_; // guards the members below; locked last
    std::shared_ptr<SessionStage> current_;
    std::vector<std::shared_ptr<SessionStage>> ofNodes_;
};

} // namespace mural
