// One session of the head: connects programs, nodes and outputs, from the nodes' start to the report.
//
//   program → CaptureClient → StreamBroadcaster → nodes
//   nodes → NodeConnection → FrameTracker     → credit of the programs
//                    → ReplyAssembler  → replies to the programs
//                    → PictureAssembler → PictureOutput
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "nodes/head/results/reply_assembler.hpp"
#include "nodes/head/capture/capture_server.hpp"
#include "nodes/head/balancing/balancer_control.hpp"
#include "nodes/head/control/control_feed.hpp"
#include "nodes/head/control/control_server.hpp"
#include "nodes/head/session/control_channel.hpp"
#include "nodes/head/session/plan_sequence.hpp"
#include "nodes/head/session/provisional_change.hpp"
#include "nodes/head/frames/credit_pacer.hpp"
#include "nodes/head/frames/frame_tracker.hpp"
#include "nodes/head/results/driver_event_merger.hpp"
#include "nodes/head/membership/node_capabilities.hpp"
#include "nodes/head/membership/job_deadline.hpp"
#include "nodes/head/membership/node_launcher.hpp"
#include "nodes/head/membership/node_restarter.hpp"
#include "nodes/head/membership/start_progress.hpp"
#include "nodes/head/broadcast/stream_broadcaster.hpp"
#include "nodes/head/frames/picture_assembler.hpp"
#include "nodes/head/frames/picture_output.hpp"
#include "nodes/head/capture/program_table.hpp"
#include "nodes/head/planning/plan_change.hpp"
#include "nodes/head/preview/output_proofs.hpp"
#include "nodes/head/preview/preview_server.hpp"
#include "nodes/head/preview/window_pictures.hpp"
#include "nodes/head/recording/session_recording.hpp"
#include "nodes/head/input/shown_program.hpp"
#include "nodes/head/session/session_report.hpp"
#include "nodes/head/session/session_status.hpp"
#include "nodes/head/session/slowdown_advice.hpp"
#include "nodes/head/statistics/frame_statistics.hpp"
#include "nodes/head/statistics/frame_times_file.hpp"
#include "nodes/head/statistics/overlay_numbers.hpp"
#include "nodes/overlay/overlay.hpp"
#include "nodes/session/session_config.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

class WallInput;
class RemoteWalls;

// A program's own window.
struct NativeWindow {
    uint32_t client = 0, window = 0; // ids in the stream
    uint32_t id = 0;                 // XID on its display
    std::string display;             // name in the program; empty: unknown
};

// The windows of a canvas on the head's display.
struct WallPlace {
    int offsetX = 0; // relative to --position
    CanvasMillimetres size;
    std::function<void(const input::InputEvent& event)> onInput; // as WallWindowsConfig
};

struct HeadOptions {
    uint64_t registryDigest = 0;
    std::unique_ptr<PictureSink> file;        // sink of --out; null: none
    std::function<std::string()> lastPicture; // path of the last file; may be empty
    std::function<Result<std::unique_ptr<PictureSink>>(const NativeWindow& window)> openWindow;
    // Requests a redraw of a program's own window. May take a second. May be empty.
    std::function<void(const NativeWindow& window)> requestRedraw;
    std::shared_ptr<Overlay> overlay;                      // of the windows that openWall opens; null: they show none
    std::vector<std::shared_ptr<PictureSink>> canvasFiles; // sinks of --out for the further canvases
    // opens wall windows if the head shows the wall (headShowsWall) or a further canvas
    std::function<Result<std::unique_ptr<PictureSink>>(const WallPlace& place)> openWall;
    std::unique_ptr<trace::StreamRecorder> recorder; // --record; null: none
    std::function<bool()> interrupted;               // returns whether a signal requests the end; may be empty
    // Restarts a lost node. Called by the session's thread. Empty: nodes are not restarted.
    std::function<Result<StartingNode>(const NodePlan&)> startNode;
    // Returns why no node can be started any more, such as the end of a batch job; empty: they can. May be empty.
    std::function<std::string()> whyLaunchesEnd;
    // Returns a notice about the end of the batch job. Called once per second. May be empty.
    std::function<std::optional<JobDeadline::Notice>(int64_t nowNs)> watchJob;
    std::shared_ptr<StartProgress> progress; // of the nodes; null: in tests
    uint32_t chunkCount = capture::kDefaultChunks;
    int64_t readyPatienceMs = 30'000;
    int64_t drainPatienceMs = 10'000;
    int64_t goodbyePatienceMs = 10'000; // silence of a node at the end of the session
    int64_t silencePatienceMs = 20'000; // silence of a node before that; nodes send a heartbeat every 4 s
    int64_t endPatienceMs = 60'000;     // end of all nodes, even if they send messages
    int64_t outputPatienceMs = 150'000; // video encoders buffer frames
    int64_t recordPatienceMs = 60'000;  // limit for writing the end of the recording
};

// run() must be called by the thread that launched the nodes.
class HeadSession : private NodeEvents {
public:
    HeadSession(SessionConfig config, SessionPlan plan, std::vector<LaunchedNode> nodes, ControlChannel& control,
                HeadOptions options);
    ~HeadSession() override;

    int run(); // returns the exit status of the head

private:
    // A change of the plan that the control thread requests.
    struct PendingChange {
        SessionConfig config;
        PlanChange change;
        std::shared_ptr<SessionStage> stage;
        std::shared_ptr<NodeGroup> group;  // null: no node joins
        std::atomic<bool> hasBegun{false}; // the session's thread starts the new nodes
    };

    Result<void> nodeReady(int node, const std::string& json) override;
    Result<void> nodeAnswer(int node, const wire::ReplyPartHeader& header, ByteBuffer bytes) override;
    Result<void> nodeFrameDone(int node, const wire::FrameDoneMessage& message) override;
    Result<void> nodePicture(int node, const wire::PictureHeader& header, ByteBuffer rows) override;
    Result<void> nodeWindowGone(int node, const wire::WindowGoneMessage& message) override;
    Result<void> nodeDriverEvent(int node, const wire::DriverEvent& event, const std::string& text) override;
    Result<void> nodeObjectRequest(int node, uint32_t client, ByteBuffer message) override;
    Result<void> nodeLog(int node, const std::string& text) override;
    Result<void> nodeGoodbye(int node, const std::string& json) override;
    Result<void> nodeInView(int node, uint32_t view, const std::vector<wire::ClientFrame>& frames) override;
    Result<void> nodeTurns(int node, uint32_t number, const std::vector<std::byte>& turns) override;
    Result<void> nodeSynchronized(int node, const wire::SynchronizedMessage& message) override;
    Result<void> nodeFrameSpans(int node, const wire::FrameSpansHeader& header,
                                const std::vector<wire::FrameSpan>& spans) override;
    Result<void> nodeClock(int node, const wire::ClockReplyMessage& message) override;
    Result<void> nodeOutputProof(int node, const wire::OutputProofMessage& message) override;
    Result<void> nodeWindowInput(int node, const input::InputEvent& event) override;
    Result<void> nodePreviewTile(int node, const wire::PreviewTileHeader& header,
                                 const std::vector<std::byte>& jpeg) override;
    void nodeLost(int node, const std::string& why) override;

    // Statistics of frames (head_session_statistics.cpp).
    // Returns complete frames from this number on, with the state of the session. Of more than the given number it
    // returns the newest. Requests statistics for some seconds. Thread-safe.
    nlohmann::json framesJson(uint64_t sinceFrame, size_t newest);
    void addFramesOperation(ControlOperations& operations);
    Result<void> recordFrame(int node, const wire::FrameDoneMessage& message, Result<void> counted);
    void measureClocks();
    void tickStatistics(int64_t nowNs);
    void announceStatistics();
    [[nodiscard]] bool areClocksKnown() const; // of all nodes that live

    // Proofs that outputs are alive (head_session_outputs.cpp).
    void addOutputsOperation(ControlOperations& operations);
    Result<nlohmann::json> outputsJson(const nlohmann::json& arguments);

    // The overlay (head_session_overlay.cpp).
    static std::shared_ptr<Overlay> makeOverlay(std::shared_ptr<Overlay> given, OverlayMode mode);
    void addOverlayOperation(ControlOperations& operations);
    Result<nlohmann::json> changeOverlay(const nlohmann::json& arguments);
    nlohmann::json overlayJson();
    [[nodiscard]] OverlayMode overlayOf(int node) const; // requires announceMutex_
    bool showsStatistics();
    void announceOverlay();
    void tickOverlay(int64_t nowNs);

    // Restarts of nodes (head_session_restarts.cpp).
    NodeRestarter::Hooks returnHooks();
    void linkAgain(int node, StartingNode& starting);
    void introduceAgain(int node);
    Result<void> takeAgain(int node, NodeCapabilities facts);
    StreamBroadcaster::Admission admit(int node, uint32_t view);
    StreamBroadcaster::Admission admission(int node, uint32_t view);
    void loseMember(int node, const std::string& why);
    void goOnWithoutAbsent();
    void goOnWithout(int node);
    bool noneIsLeft();

    // The control interface (head_session_control.cpp). The control thread calls the operations.
    void openControl();
    void openPreview();
    // Remote walls, and input of windows for the program (head_session_remote.cpp).
    Result<void> openRemoteWalls();
    void openWallInput();
    void takeWindowInput(const input::InputEvent& event);
    [[nodiscard]] WallPlace wallPlace(int offsetX, const CanvasMillimetres& size);
    Result<ShownProgram> shownProgram();
    [[nodiscard]] std::optional<Viewport> areaOnWall(int node) const; // of the first canvas
    ControlOperations controlOperations();
    Result<nlohmann::json> programWindow();
    void addNodeOperations(ControlOperations& operations);
    // Changes to the running session (head_session_changes.cpp).
    void addChangeOperations(ControlOperations& operations);
    Result<nlohmann::json> changeLatency(const nlohmann::json& arguments);
    Result<nlohmann::json> startRecording(const nlohmann::json& arguments);
    Result<nlohmann::json> stopRecording();
    // Changes of the plan (head_session_plans.cpp).
    void addPlanOperations(ControlOperations& operations);
    struct ChangeTerms {
        bool isDryRun = false;
        int64_t revertAfterSeconds = 0; // 0: the change stays
        bool isReversion = false;       // of a provisional change
    };
    static Result<ChangeTerms> termsOf(const nlohmann::json& arguments);
    Result<nlohmann::json> moveNodes(const std::string& from, const std::string& to, ChangeTerms terms);
    void takeSpareFor(int node);
    Result<nlohmann::json> undoChange(ChangeTerms terms);
    Result<nlohmann::json> changeLayout(const nlohmann::json& arguments);
    Result<nlohmann::json> changePlan(SessionConfig config, ChangeTerms terms);
    Result<nlohmann::json> keepChange();
    void revertChange();
    Result<void> canTakeNodes(size_t members);
    Result<void> carryOut(SessionConfig config, PlanChange change);
    void beginPlanChange();
    Result<void> exchangeNodes(PendingChange& change);
    void endLeftNodes(int64_t nowNs);
    void forgetNode(int node);
    void checkForNodes();
    void addStopOperations(ControlOperations& operations);
    bool hasOtherMembers(int node);
    Result<void> stopNode(int node, bool isForced);
    Result<void> handOver(int node, Deadline deadline); // to the nodes that take its area
    Result<void> leaveAt(int node, Deadline deadline);
    void memberLeft(int node);
    Result<void> startNode(int node);
    [[nodiscard]] int nodeCount() const { return plans_.nodeCount(); }
    [[nodiscard]] std::shared_ptr<const SessionPlan> currentPlan() const {
        const auto stage = plans_.current();
        return {stage, &stage->plan};
    }
    [[nodiscard]] std::shared_ptr<LoadBalancer> balancer() const {
        const auto stage = plans_.current();
        return {stage, &stage->balancer};
    }
    // Returns an operation that changes a node. canForce: it has the argument `force`.
    ControlOperation nodeOperation(std::string name, std::string meaning, bool canForce,
                                   std::function<Result<void>(int node, bool isForced)> change);
    Result<void> checkNode(int64_t node); // that an operation may change it
    Result<void> restartNode(int node);
    Result<void> removeNode(int node, bool isForced);
    // Sends an event to `mural run` and to the clients of the control interface. Thread-safe.
    void announce(const nlohmann::json& event);

    Result<void> bringUp();
    void openMulticast();
    Result<void> openDeltaStream();
    void introduceNodes();
    PictureOutputConfig outputConfig();
    NodeSetup setupFor(const NodePlan& plan);
    Result<void> awaitReady();
    void watchStart(StartStep wanted);
    void watchLaunches(int64_t nowNs);
    Result<void> checkSize();
    void openTables();
    [[nodiscard]] compound::PixelSize sizeOfWall() const;
    // Whether the nodes run a program with the native API.
    [[nodiscard]] bool isNative() const { return !config_.nodeProgram.empty(); }
    // Whether all nodes are processes of this machine, connected by shared memory.
    [[nodiscard]] bool isOneMachine() const;
    trace::About aboutTrace();
    void announceReady();
    std::string placeOwnThreads() const;
    std::vector<std::string> explainLines();

    void serve();
    bool finishRequested(Deadline deadline); // waits for the control connection until the deadline
    void tick();
    void watchNodes(int64_t nowNs);
    // called by the output's thread
    Result<std::unique_ptr<PictureSink>> openNativeWindow(const WindowPicture& picture);
    // Returns the X window; `native` as in WindowPicture. Empty: on a display that has no number.
    std::optional<NativeWindow> nativeWindowOf(uint32_t client, uint32_t window, uint64_t native);
    void redrawStillWindow();
    void windowGone(const std::pair<uint32_t, uint32_t>& window, int node); // window: client, window
    void reportProgress(int64_t nowNs);

    void finish();
    void finishNodes();
    void finishOutput();
    void loseSilentNodes(int64_t sinceNs, bool all);
    bool allReadersEnded();
    SessionNumbers numbers();
    SessionStatus status();
    std::vector<int> waitsFor(const ProgramStatus& program);
    std::string streamOf(const NodePlan& plan); // requires mutex_
    [[nodiscard]] bool hasLeft(int node);       // with a change of the plan
    // It comes with a change of the plan, and was no member yet. Requires mutex_.
    [[nodiscard]] bool isNew(int node) const { return newNodes_.contains(node); }
    void noNodeIsLeft();

    const SessionConfig config_;
    ControlChannel& control_;
    HeadOptions options_;
    ControlFeed feed_;
    const LogToFeed logToFeed_{feed_};
    std::string placement_;  // placement of the head's threads
    std::string deltaLine_;  // for --explain: nodes with delta coding
    std::string streamLine_; // for --explain: transport of the stream; empty: shared memory only

    // Declared in the order of construction. The readers of the nodes use all of them and end first.
    FrameStatistics statistics_;
    FrameTimesFile frameTimes_;
    SentFrames sentFrames_;    // for equalizers of zooms
    std::mutex announceMutex_; // orders announcements of the statistics' state and of the overlay; guards overlayMode_
                               // and overlayOfNodes_
    const std::shared_ptr<Overlay> overlay_;         // of the head's windows
    OverlayMode overlayMode_ = OverlayMode::Off;     // of all windows except these:
    std::map<int, OverlayMode> overlayOfNodes_;      // of the windows of single nodes
    std::shared_ptr<const SessionPlan> overlayPlan_; // the plan of overlayNumbers_
    std::optional<OverlayNumbers> overlayNumbers_; // while the head's windows show statistics; used by the main thread
    int64_t overlayNumbersNs_ = 0;                 // the latest numbers
    int64_t launchesWatchedNs_ = 0;                // the latest call of watchLaunches()
    int64_t probedNs_ = 0;                         // the latest ClockProbe
    CreditPacer pacer_;
    FrameTracker frames_;
    ReplyAssembler answers_;
    DriverEventMerger driverEvents_;
    OutputProofs outputProofs_;
    WindowPictures windowPictures_{[this](const WindowPictures::Composed& composed) {
        if (preview_) preview_->offer(composed.frame, composed.picture, composed.wallWidth, composed.wallHeight);
    }};
    std::unique_ptr<PreviewServer> preview_;   // null: the head receives no pictures, or has no socket for pages
    std::unique_ptr<WallInput> wallInput_;     // null: no windows send input
    std::unique_ptr<RemoteWalls> remoteWalls_; // null: none
    std::unique_ptr<PictureOutput> output_;    // null: the head receives no pictures
    PlanSequence plans_;
    BalancerControl equalizers_{[this] { return balancer(); }};
    SlowdownAdvice advice_;
    StreamBroadcaster nodes_;
    SessionRecording recording_{nodes_};
    bool fetchesCopies_ = false; // programs send the pixels that they copy from windows, as a trace needs them
    std::unique_ptr<NodeRestarter> returns_;
    std::unique_ptr<ProgramTable> programs_; // set when the nodes are ready
    std::unique_ptr<CaptureServer> server_;
    std::unique_ptr<ControlServer> controlServer_; // null: the session has no folder for its socket

    std::atomic<bool> finishing_{false};
    std::atomic<bool> tearingDown_{false};
    std::atomic<bool> serving_{false};
    std::vector<std::string> spares_;  // remaining hosts of --spare-nodes; used by the session's thread
    std::vector<int> waitingForSpare_; // lost nodes; used by the session's thread
    std::optional<std::pair<uint32_t, uint32_t>> wantedRedraw_; // client, window; used by the session's thread
    std::thread redrawing_;                                     // runs options_.requestRedraw
    std::atomic<bool> isRedrawing_{false};
    std::thread spareMove_; // moves nodes to a spare host
    std::atomic<bool> isMovingToSpare_{false};
    std::atomic<int> lostAfterMove_{-1}; // node whose move to a spare host failed; -1: none
    std::atomic<bool> wallLost_{false};
    std::atomic<bool> checksForNodes_{false}; // tick() checks whether any node is left
    std::mutex changing_;                     // held during a change of the plan
    std::shared_ptr<PendingChange> pending_;  // guarded by mutex_; for the session's thread to begin
    ProvisionalChange provisional_{[this] { revertChange(); }};
    std::deque<SessionConfig> history_;   // guarded by mutex_; configurations before the changes, the latest last
    std::set<int> refusedNodes_;          // guarded by mutex_; of refused changes of the plan: they never joined
    std::set<int> newNodes_;              // guarded by mutex_; come with a change of the plan, and were no members yet
    std::map<int, int64_t> leavingSince_; // guarded by mutex_; nodes of earlier plans, since their Leave
    const std::map<int, std::string> absences_; // nodes absent at the start, with the reason
    std::set<int> multicastNodes_;              // nodes that receive the stream by multicast if it reaches them
    std::set<int> deltaNodes_;                  // nodes with delta coding
    std::string exchangeSecret_; // in hex; for nodes that exchange parts of pictures or share a swap barrier
    ProgressMeter meter_;
    int64_t lastProgressNs_ = 0;
    int64_t lastProgressFrame_ = 0;
    bool framesReached_ = false;

    std::mutex membership_; // held while a node becomes a member or is lost; locked before mutex_
    std::mutex mutex_;      // guards the members below
    ReplySenders views_;
    int promisedGlVersion_ = 0;      // announced to programs…
    std::string promisedExtensions_; // …from the nodes of the start
    std::vector<NodeCapabilities> facts_;
    std::vector<bool> ready_;
    std::vector<bool> introduced_;       // nodes that have the addresses of the other nodes of their picture
    std::vector<uint32_t> incarnations_; // number of restarts by node
    std::set<int> rerouted_;             // nodes that multicast does not reach
    std::set<int> leaving_, stopped_;    // nodes that finish their last frames for stop-node, and that have done so
    std::condition_variable nodeStopped_;
    std::vector<std::string> refusals_; // latest log line of each node before it was ready
    std::vector<NodeTotals> totals_;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<bool>> gone_; // by window: nodes that have not reported its end
    std::string startFailure_;
};

} // namespace mural
