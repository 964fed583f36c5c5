// Runs the planner of a session (balancer/planner): measured times of nodes → equalizers → areas, ranges and zooms.
//
// FrameTimes selects the window whose times count. A frame counts after all living nodes have finished it. Nodes take
// an assignment over at a frame of their own (nodes/replay/features/dynamic_tiles.cpp, sort_last.cpp) and report its
// number with each frame, so each measurement belongs to the parts that were drawn. The other nodes take over the work
// of a lost node until it returns.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "balancer/planner/frame_planner.hpp"
#include "nodes/head/balancing/equalizer_totals.hpp"
#include "nodes/head/balancing/part_prediction.hpp"
#include "nodes/head/balancing/program_frames.hpp"
#include "nodes/head/frames/frame_times.hpp"
#include "nodes/head/planning/node_plan.hpp"
#include "nodes/session/range_assignment.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

// Thread-safe.
class LoadBalancer {
public:
    // Called with the balancer's lock held; must not block.
    struct Announce {
        std::function<void(const ViewportAssignment&)> viewports;
        std::function<void(const RangeAssignment&)> ranges;
        // The client begins frames at this rate at most; 0: no limit. May be empty.
        std::function<void(uint32_t client, double framesPerSecond)> pace;
        // The client draws no frames, and the latest one of the window is coarse. A further one has full resolution.
        // Called by tick() only. May be empty.
        std::function<void(uint32_t client, uint32_t window)> redraw;
    };

    // plant: fault injection for tests; each value divides at random after each frame and reply of a node. With "areas"
    // and "shares" the picture must stay exact. With "early", "uncleared" and "lateshare" a node also applies
    // assignments at the wrong time, and tests must find wrong pixels.
    LoadBalancer(const SessionPlan& plan, Announce announce, const std::string& plant = {});

    // nowNs: time at which the node's message arrived, on the monotonic clock.
    void frameDone(int node, const wire::FrameDoneMessage& message, int64_t nowNs);
    // True if zooms change. Only then frameSent() and tick() have an effect.
    [[nodiscard]] bool movesZooms() const;
    // Call before the first command of the next frame is sent, so that a zoom applies to that frame.
    void frameSent(const SentFrame& frame);
    void tick(int64_t nowNs);
    void answered();                                   // a reply within a frame; relevant to fault injection only
    void windowGone(uint32_t client, uint32_t window); // or wire::kAllWindows
    void nodeLost(int node);
    void nodeJoined(int node);
    // Gives the area of a living node to others, which draw it from a later frame on. hasGivenUp() reports that.
    // Errors: no other node takes the area. takeBack() revokes it.
    Result<void> giveUp(int node);
    void takeBack(int node);
    // Returns whether the latest frame of each window that the node has finished since giveUp(), at least one, has none
    // of its pixels. Its later frames have none either. True if no program has a window.
    [[nodiscard]] bool hasGivenUp(int node) const;

    [[nodiscard]] ViewportAssignment viewports() const; // the latest ones
    [[nodiscard]] bool isActive() const { return planner_ != nullptr; }
    [[nodiscard]] std::vector<EqualizerTotals> totals() const;
    // Changes of a running session, from the next decision on. name: as in totals(). Errors name the known names.
    Result<void> set(const std::string& name, const std::string& parameter, const std::string& value);
    Result<void> freeze(const std::string& name, bool isFrozen);

private:
    // The parts that one pair of assignments made the nodes draw. The times of the leaves are 0.
    struct Issue {
        uint32_t viewports = 0, ranges = 0; // numbers of the assignments; 0: the parts of Setup
        std::vector<balance::LeafStatistics> leaves;
    };
    struct Watched { // one equalizer of areas, ranges, zooms or the frame rate
        balance::Equalizer* equalizer;
        std::vector<int> nodes;
        EqualizerTotals totals;
        std::deque<double> efficiencies; // of the latest frames
        PartPrediction prediction;
        uint32_t drawn = 0; // number of the assignment of the last frame
    };

    void resize();
    void advance(bool repeats = false);
    void findParts(ViewportAssignment& areas, RangeAssignment& ranges) const;
    void snap(Viewport& area) const;
    void announcePace();
    [[nodiscard]] std::vector<balance::LeafStatistics> leavesOfPlan() const;
    [[nodiscard]] std::optional<Zoom> drawnZoomOf(balance::Index compound) const;
    [[nodiscard]] bool isUnzoomed(const FrameTimes::Frame& frame, balance::Index compound) const;
    void observe(const FrameTimes::Frame& frame, uint32_t number, int64_t nowNs);
    void observeStill(int64_t nowNs);
    [[nodiscard]] bool isCoarse(const balance::FrameStatistics& statistics) const;
    void requestRedraw(int64_t nowNs);
    [[nodiscard]] const Issue* issueOf(const FrameTimes::Frame& frame) const;
    [[nodiscard]] std::vector<double> busyByCompound(const FrameTimes::Frame& frame) const;
    [[nodiscard]] bool drawsInTurn(balance::Index compound) const;
    void addTurns(const FrameTimes::Frame& frame, balance::FrameStatistics& statistics) const;
    void countFrame(const FrameTimes::Frame& frame);
    void count(Watched& watched) const;
    [[nodiscard]] Result<balance::Equalizer*> find(const std::string& name) const;
    void updateAvailable(int node); // after its loss or return
    [[nodiscard]] const NodePlan& planOf(int node) const { return nodes_[static_cast<size_t>(node)]; }

    mutable std::mutex mutex_;
    const Announce announce_;
    const std::vector<NodePlan> nodes_;
    FrameTimes times_;
    std::unique_ptr<balance::FramePlanner> planner_; // null: nothing moves
    compound::DisplaySizes fileSizes_;               // of the configuration, for a picture of the size wall_
    compound::PixelSize wall_{0, 0};
    std::vector<Watched> watched_;
    ViewportAssignment areas_; // the latest ones, per node
    RangeAssignment ranges_;
    std::deque<Issue> issues_; // oldest first; those that frames may still be drawn with
    uint32_t pacedClient_ = 0; // the latest announced pace
    double pace_ = 0;
    uint64_t measured_ = 0; // frames
    ProgramFrames program_; // of the followed window
    bool isStill_ = false;  // as the equalizers of zooms have it
    bool isCoarse_ = false; // the latest frame has fewer pixels than the file permits
    int redraws_ = 0;       // requests since the latest frame that is not coarse
    bool isRandom_ = false;
    struct GivenUp {
        uint32_t number = 0;                                      // of the first assignment without its area
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> latest; // by client and window: assignment of its last frame
    };
    std::map<int, GivenUp> givenUp_; // by node
};

} // namespace mural
