#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <unistd.h>
#include <vector>

#include <mural/mural.hpp>

#include "common/base/clock.hpp"
#include "native/runtime/node_main.hpp"
#include "native/session/app_link.hpp"
#include "objects/ends/barrier_ends.hpp"
#include "objects/ends/object_writer.hpp"
#include "objects/ends/queue_ends.hpp"

namespace mural {

namespace {

constexpr int64_t kWelcomeMs = 20'000;
constexpr uint32_t kDefaultWidth = 1280, kDefaultHeight = 720;

// An odd multiplier that spreads consecutive numbers over 64 bits (splitmix64).
constexpr uint64_t kSeedStep = 0x9e3779b97f4a7c15;

// Replaces this process by `mural run` with the same command line. Returns only after a failure.
Error startSession(int argc, char** argv) {
    std::vector<std::string> words = {"mural", "run", "--", argv[0]};
    if (argc > 0) words[3] = "/proc/self/exe";
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length > 0) words[3].assign(path, static_cast<size_t>(length));
    for (int i = 1; i < argc; ++i) words.emplace_back(argv[i]);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execvp("mural", arguments.data());
    return Error{"no session is running, and mural is not in PATH; start the program with mural run -- " +
                 std::string(argc > 0 ? argv[0] : "PROGRAM")};
}

} // namespace

class Session::Impl final : public objects::MessageSink {
public:
    Result<void> connect(const std::string& session) {
        auto link = native::AppLink::connect(session, Deadline::inMs(kWelcomeMs));
        if (!link) return link.error();
        link_ = std::move(*link);
        const capture::Welcome& welcome = link_->welcome();
        objects::MasterOptions options;
        options.keepsPushed = false; // the head serves nodes that join
        // Without multicast, a message to all is one copy per node, also for nodes that do not need it.
        if (welcome.multicasts == 0) options.gatherNs = 0;
        if (welcome.isOneMachine != 0) options.blobs = objects::BlobTransfer::Place;
        options.hasFrames = true;
        options.mostCommitBytes = wire::kMaxObjectBytes / 2; // leaves room for the rest of the message
        writer_ = std::make_unique<objects::ObjectWriter>(*link_, options);
        queues_ = std::make_unique<objects::QueueHub>(*link_);
        barriers_ = std::make_unique<objects::BarrierHub>(*this);
        ownBarriers_ = std::make_unique<objects::BarrierLine>(toLeader_);
        ownBarriers_->countByFrames([this] { return number_; });
        const bool isSized = welcome.width > 0 && welcome.height > 0;
        info_.nodes = static_cast<int>(welcome.nodeCount);
        info_.width = static_cast<int>(isSized ? welcome.width : kDefaultWidth);
        info_.height = static_cast<int>(isSized ? welcome.height : kDefaultHeight);
        wire::WindowConfig window{};
        window.width = static_cast<uint32_t>(info_.width);
        window.height = static_cast<uint32_t>(info_.height);
        window.red = window.green = window.blue = window.alpha = 8;
        window.depth = 24;
        window.stencil = 8;
        window.doubleBuffer = 1;
        for (int i = 0; i < 12; ++i) frame_.head[i] = i % 5 == 0 ? 1 : 0; // three rows of the identity
        startNs_ = monotonicNowNs();
        link_->sendWindow(window);
        // All objects are in the stream from its beginning on, so a node knows that other references are invalid.
        link_->toAll(objects::encode(objects::CatalogueEndMessage{}).bytes());
        startReports();
        // Barriers wait for these nodes from the first round on.
        for (const Deadline deadline = Deadline::inMs(kWelcomeMs); nodesCame_ < welcome.members && !deadline.passed();)
            link_->sleepUntil(Deadline::inMs(1));
        return {};
    }
    ~Impl() override {
        if (!link_) return;
        states_.clear();
        writer_->close();
        queues_->close();
        ownBarriers_->close();
        link_->stop();
    }

    Result<uint64_t> startFrame(Deadline deadline) {
        link_->setDeadline(deadline);
        if (auto ready = link_->awaitCredit(number_); !ready) return ready.error();
        writer_->frameDone(link_->framesDone());
        for (auto& [key, state] : states_)
            if (auto committed = state->commit(deadline); !committed) return committed.error();
        const uint32_t number = number_ + 1;
        frame_.number = number;
        frame_.seconds = static_cast<double>(monotonicNowNs() - startNs_) / kNsPerS;
        frame_.seed = number * kSeedStep;
        if (auto sent = link_->sendFrame(frame_, number); !sent) return sent.error();
        number_ = number;
        writer_->frame(number);
        return uint64_t{number};
    }
    Result<void> finishAll(Deadline deadline) {
        link_->setDeadline(deadline);
        if (auto sent = link_->flush(); !sent) return sent;
        return link_->awaitDone(number_);
    }
    void wait(Deadline deadline) {
        link_->setDeadline(deadline);
        link_->sleepUntil(deadline);
    }
    Barrier barrier(std::string_view name) {
        barriers_->join(name, kApplication, "the application");
        return ownBarriers_->open(name);
    }
    void setHead(const Matrix4& pose) {
        for (const auto& row : pose.m)
            for (const double value : row)
                if (!std::isfinite(value)) return;
        for (size_t i = 0; i < 12; ++i) frame_.head[i] = pose.m[i / 4][i % 4];
    }

    std::unique_ptr<native::AppLink> link_;
    std::unique_ptr<objects::ObjectWriter> writer_; // uses link_, as queues_
    std::unique_ptr<objects::QueueHub> queues_;
    SessionInfo info_;
    std::map<std::pair<std::type_index, std::string>, std::unique_ptr<AnyState>> states_;

private:
    // The application as a member of barriers, among nodes.
    static constexpr objects::PeerId kApplication = UINT32_MAX;

    // The messages of the leader of barriers, to nodes and to the application.
    void toAll(std::span<const std::byte>) override {} // the leader has none
    void toOne(objects::PeerId member, std::span<const std::byte> message) override {
        if (member != kApplication) return link_->toOne(member, message);
        const std::lock_guard lock(fromLeaderMutex_);
        fromLeader_.emplace_back(message.begin(), message.end());
        link_->wake();
    }
    // The link's thread passes them on, because the leader may be called from within the application's enter().
    void passFromLeader() {
        std::vector<std::vector<std::byte>> messages;
        {
            const std::lock_guard lock(fromLeaderMutex_);
            messages.swap(fromLeader_);
        }
        for (const auto& message : messages) (void)ownBarriers_->input(message);
    }
    // The application's messages to the leader.
    struct ToLeader final : objects::MessageSink {
        explicit ToLeader(Impl& owner) : impl(owner) {}
        void toAll(std::span<const std::byte>) override {}
        void toOne(objects::PeerId, std::span<const std::byte> message) override {
            impl.takeMessage(kApplication, message);
        }
        Impl& impl;
    };

    void startReports() {
        native::NodeReports reports;
        reports.message = [this](uint32_t node, std::span<const std::byte> message) { takeMessage(node, message); };
        reports.came = [this](uint32_t node, const std::string& name) {
            writer_->join(node, name);
            // A later node may draw its first frame after the others have passed the barrier of that frame.
            const bool isFirst = nodesCame_++ < link_->welcome().members;
            barriers_->join(node, name,
                            isFirst ? objects::BarrierHub::Awaited::AtOnce
                                    : objects::BarrierHub::Awaited::FromItsFirstRound);
        };
        reports.lost = [this](uint32_t node) {
            writer_->leave(node);
            queues_->leave(node);
            barriers_->leave(node);
        };
        reports.tick = [this](int64_t nowNs) {
            writer_->tick(nowNs);
            barriers_->tick(nowNs);
            passFromLeader();
        };
        link_->start(std::move(reports));
    }
    // Passes a message on by its kind.
    void takeMessage(uint32_t from, std::span<const std::byte> message) {
        const int64_t nowNs = monotonicNowNs();
        Result<void> taken;
        switch (objects::kindOf(message)) {
        case objects::MessageKind::Ask:
        case objects::MessageKind::Done: taken = queues_->input(from, message); break;
        case objects::MessageKind::Enter: taken = barriers_->input(from, message, nowNs); break;
        default: taken = writer_->input(from, message, nowNs);
        }
        constexpr int kMaxComplaints = 10;
        if (!taken && complaints_++ < kMaxComplaints)
            std::fprintf(stderr, "mural: %s\n", taken.error().message.c_str());
    }

    ToLeader toLeader_{*this};
    std::unique_ptr<objects::BarrierHub> barriers_;
    std::unique_ptr<objects::BarrierLine> ownBarriers_;
    std::mutex fromLeaderMutex_;
    std::vector<std::vector<std::byte>> fromLeader_; // to the application; guarded by fromLeaderMutex_
    std::atomic<int> complaints_{0};                 // about messages of nodes
    std::atomic<uint32_t> nodesCame_{0};
    wire::NativeFrame frame_{}; // the next one
    uint32_t number_ = 0;       // of the last sent frame
    int64_t startNs_ = 0;
};

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::open(int argc, char** argv, const Program& program) {
    if (const auto status = native::runNodeIfRequested(argc, argv, program)) std::exit(*status);
    const char* const name = std::getenv("MURAL_SESSION");
    if (!name || !*name) return startSession(argc, argv);
    auto impl = std::make_unique<Impl>();
    if (auto connected = impl->connect(name); !connected) return connected.error();
    return std::unique_ptr<Session>(new Session(std::move(impl)));
}

Session::AnyState* Session::findState(std::type_index type, const std::string& name) const {
    const auto found = impl_->states_.find({type, name});
    return found == impl_->states_.end() ? nullptr : found->second.get();
}
void Session::addState(std::type_index type, const std::string& name, std::unique_ptr<AnyState> state) {
    impl_->states_[{type, name}] = std::move(state);
}
Result<std::unique_ptr<SharedObject>> Session::shareAny(const archive::TypeLayout& layout,
                                                        const ShareOptions& options) {
    if (options.mostUnread > 0)
        return Error{"cannot share object \"" + options.name +
                     "\" with mostUnread: in a session, the latency bounds how far nodes are behind"};
    return impl_->writer_->shareAny(layout, options);
}

Result<uint64_t> Session::startFrame(Deadline deadline) { return impl_->startFrame(deadline); }
Result<void> Session::finishAll(Deadline deadline) { return impl_->finishAll(deadline); }
std::shared_ptr<AnyQueueMaster> Session::queueAny(std::string_view name) { return impl_->queues_->openAny(name); }
Barrier Session::barrier(std::string_view name) { return impl_->barrier(name); }
void Session::wait(Deadline deadline) { impl_->wait(deadline); }
void Session::setHead(const Matrix4& pose) { impl_->setHead(pose); }
const SessionInfo& Session::info() const { return impl_->info_; }
bool Session::isRunning() const { return impl_->link_->isAlive(); }

} // namespace mural
