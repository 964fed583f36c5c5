// One session of the head: connects programs, nodes and outputs, from the nodes' start to the report.
//
//   program → CaptureClient → NodeSet → nodes
//   nodes → NodeLink → FrameTracker     → credit of the programs
//                    → AnswerAssembler  → replies to the programs
//                    → PictureAssembler → PictureOutput
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "nodes/head/answer_assembler.hpp"
#include "nodes/head/capture_server.hpp"
#include "nodes/head/chunk_dealer.hpp"
#include "nodes/head/control_channel.hpp"
#include "nodes/head/frame_tracker.hpp"
#include "nodes/head/news_merger.hpp"
#include "nodes/head/node_facts.hpp"
#include "nodes/head/node_launcher.hpp"
#include "nodes/head/node_returns.hpp"
#include "nodes/head/node_set.hpp"
#include "nodes/head/picture_assembler.hpp"
#include "nodes/head/picture_output.hpp"
#include "nodes/head/program_table.hpp"
#include "nodes/head/session_report.hpp"
#include "nodes/head/session_status.hpp"
#include "nodes/head/slowdown_advice.hpp"
#include "nodes/head/tile_dealer.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

// A program's own window.
struct NativeWindow {
    uint32_t client = 0, window = 0; // as in the stream
    uint32_t id = 0;                 // on its X display
    std::string display;             // as the program names it; empty: not told
};

struct HeadOptions {
    uint64_t registryDigest = 0;
    std::unique_ptr<PictureSink> file; // of --out; null: none
    std::function<std::string()> lastPicture; // path of the last file; may be empty
    std::function<Result<std::unique_ptr<PictureSink>>(const NativeWindow& window)> openWindow;
    std::vector<std::shared_ptr<PictureSink>> canvasFiles; // of --out, for each canvas beside the first
    std::function<Result<std::unique_ptr<PictureSink>>(int offsetX)> openWall; // where the head shows the wall (headShowsWall), or a canvas beside it
    std::unique_ptr<recording::StreamRecorder> recorder; // of --record; null: none
    std::function<bool()> interrupted; // a signal asks to finish; may be empty
    // Starts a lost node again, by the thread that runs the session; empty: none is.
    std::function<Result<StartingNode>(const NodePlan&)> startNode;
    uint32_t chunkCount = capture::kDefaultChunks;
    int64_t readyPatienceMs = 30'000;
    int64_t drainPatienceMs = 10'000;
    int64_t byePatienceMs = 10'000; // without anything from a node
    int64_t silencePatienceMs = 20'000; // the same, while it is asked nothing; nodes say every 4 s that they live
    int64_t endPatienceMs = 60'000; // with
    int64_t outputPatienceMs = 150'000; // video encoders hold frames back
    int64_t recordPatienceMs = 60'000; // until the end of the recording is written
};

// run() by one thread, the one that has launched the nodes.
class HeadSession : private NodeEvents {
public:
    HeadSession(SessionConfig config,
                SessionPlan plan,
                std::vector<LaunchedNode> nodes,
                ControlChannel& control,
                HeadOptions options);
    ~HeadSession() override;

    int run(); // the exit status of the head

private:
    Result<void> nodeReady(int node, const std::string& json) override;
    Result<void> nodeAnswer(int node, const wire::AnswerHeader& header, ByteBuffer bytes) override;
    Result<void> nodeFrameDone(int node, const wire::FrameDoneMessage& message) override;
    Result<void> nodePicture(int node, const wire::PictureHeader& header, ByteBuffer rows) override;
    Result<void> nodeWindowGone(int node, const wire::WindowGoneMessage& message) override;
    Result<void> nodeNews(int node, const wire::News& news, const std::string& text) override;
    Result<void> nodeLog(int node, const std::string& text) override;
    Result<void> nodeBye(int node, const std::string& json) override;
    Result<void> nodeInView(int node, uint32_t view, const std::vector<wire::ClientFrame>& frames) override;
    Result<void> nodeTurns(int node, uint32_t number, const std::vector<std::byte>& turns) override;
    Result<void> nodeSynchronized(int node, const wire::SynchronizedMessage& message) override;
    void nodeLost(int node, const std::string& why) override;

    // Nodes that come back (head_session_returns.cpp).
    NodeReturns::Hooks returnHooks();
    void linkAgain(int node, StartingNode& starting);
    void introduceAgain(int node);
    Result<void> takeAgain(int node, NodeFacts facts);
    NodeSet::Admission admit(int node, uint32_t view);
    void loseMember(int node, const std::string& why);
    void goOnWithoutAbsent();
    void goOnWithout(int node);
    bool noneIsLeft();

    Result<void> bringUp();
    void openMulticast();
    Result<void> openEconomy();
    void introduceNodes();
    NodeSetup setupFor(const NodePlan& plan);
    Result<void> awaitReady();
    Result<void> checkSize();
    void openTables();
    void beginRecording();
    void announceReady();
    std::string placeOwnThreads() const;
    std::vector<std::string> explainLines();

    void serve();
    bool askedToFinish(Deadline deadline); // waits until then for the control connection
    void tick();
    void watchNodes(int64_t nowNs);
    Result<std::unique_ptr<PictureSink>> openNativeWindow(const WindowPicture& picture); // by the output's thread
    void windowGone(const std::pair<uint32_t, uint32_t>& window, int node); // client, window
    void reportProgress(int64_t nowNs);

    void finish();
    void finishNodes();
    void finishOutput();
    void loseSilentNodes(int64_t sinceNs, bool all);
    bool allReadersEnded();
    SessionNumbers numbers();
    SessionStatus status();
    [[nodiscard]] std::vector<QueueTotals> queues() const;
    std::vector<int> waitsFor(const ProgramStatus& program);
    std::string streamOf(const NodePlan& plan); // with the mutex
    void noNodeIsLeft();

    const SessionConfig config_;
    const SessionPlan plan_;
    ControlChannel& control_;
    HeadOptions options_;
    const int nodeCount_;
    const bool sendsPictures_;
    std::string placement_; // of the head's threads
    std::string economyLine_; // which nodes are spared what they have had, for --explain
    std::string streamLine_; // how the stream travels, for --explain; empty: in this machine's memory

    // In the order of construction; the nodes' readers use all of it and are ended before.
    FrameTracker frames_;
    AnswerAssembler answers_;
    NewsMerger news_;
    std::unique_ptr<PictureOutput> output_; // null: no pictures come
    PictureAssembler pictures_;
    TileDealer dealer_;
    ChunkDealer chunks_;
    SlowdownAdvice advice_;
    NodeSet nodes_;
    std::unique_ptr<NodeReturns> returns_;
    std::unique_ptr<ProgramTable> programs_; // once the nodes are ready
    std::unique_ptr<CaptureServer> server_;

    std::atomic<bool> finishing_{false};
    std::atomic<bool> tearingDown_{false};
    std::atomic<bool> serving_{false};
    const std::map<int, std::string> absences_; // nodes that were not there at the start, and why
    std::set<int> multicastNodes_; // nodes whose stream comes by multicast where that reaches them
    std::set<int> economical_; // nodes that are spared what they have had
    std::string exchangeSecret_;   // of nodes that send each other parts of pictures or wait for each other, in hex
    ProgressMeter meter_;
    int64_t lastProgressNs_ = 0;
    int64_t lastProgressFrame_ = 0;
    bool framesReached_ = false;
    recording::WriterTotals recorded_;

    std::mutex membership_; // held while a node becomes a member, or is lost: before mutex_
    std::mutex mutex_; // what follows
    NodeViews views_;
    int promisedGlVersion_ = 0;       // to the programs…
    std::string promisedExtensions_;  // …by the nodes of the start
    std::vector<NodeFacts> facts_;
    std::vector<bool> ready_;
    std::vector<bool> introduced_; // nodes that know where the others of their picture are
    std::vector<uint32_t> lives_;  // how often each was started again
    std::set<int> rerouted_; // nodes that multicast does not reach
    std::vector<std::string> refusals_; // what nodes said before they were ready
    std::vector<NodeTotals> totals_;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<bool>> gone_; // windows, and which nodes have not said so yet
    std::string startFailure_;
};

} // namespace mural
