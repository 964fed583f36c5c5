// A complete head in one test: its session in a thread, fake nodes on pipes, and the other end of its control
// connection.
#pragma once

#include <fcntl.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <vector>

#include "common/json/json_text.hpp"
#include "nodes/head/planning/make_plan.hpp"
#include "nodes/head/session/head_session.hpp"
#include "nodes/head/session/log_to_control.hpp"
#include "tests/head/support/fake_node.hpp"
#include "tests/head/support/fake_program.hpp"

namespace mural {

class SessionHarness {
public:
    SessionConfig config;
    HeadOptions options;
    std::vector<FakeNodeBehaviour> behaviours; // one per node
    size_t pipeBytes = size_t{1} << 20;

    explicit SessionHarness(int nodes) : behaviours(static_cast<size_t>(nodes)) {
        static std::atomic<int> count{0};
        config.session = "mural-test-" + std::to_string(getpid()) + "-" + std::to_string(++count);
        config.columns = nodes;
        config.localNodes = nodes;
        options.registryDigest = kTestDigest;
        options.chunkCount = 16;
        config.placeThreads = false; // tests do not change CPU affinity
        options.goodbyePatienceMs = 1000;
    }
    ~SessionHarness() {
        mine_ = FileDescriptor(); // the head ends when its control connection breaks
        if (thread_.joinable()) thread_.join();
    }

    void start() {
        connectControl();
        SessionPlan plan = makePlan(config, "here").value();
        std::vector<LaunchedNode> launched;
        for (const NodePlan& node : plan.nodes) {
            auto pipe = makePipe(pipeBytes);
            ASSERT_TRUE(pipe.ok());
            launched.push_back({node, nullptr, std::move(pipe->a)});
            auto& behaviour = behaviours[static_cast<size_t>(node.node)];
            nodes_.push_back(std::make_unique<FakeNode>(std::move(pipe->b), behaviour));
        }
        thread_ = std::thread([this, plan, nodes = std::move(launched)]() mutable {
            HeadSession session(config, plan, std::move(nodes), *control_, std::move(options));
            status_ = session.run();
        });
    }

    // Starts the nodes as processes: `executable node …`.
    void startProcesses(const std::string& executable) {
        connectControl();
        const SessionPlan plan = makePlan(config, "here").value();
        // The session's own thread launches the nodes, which live as long as that thread.
        thread_ = std::thread([this, plan, executable] {
            LaunchOptions launching;
            launching.executable = executable;
            launching.patienceMs = kTestPatienceMs;
            StartProgress progress(monotonicNowNs());
            auto nodes = launchNodes(plan, launching, progress, [] { return false; });
            if (!nodes) {
                control_->error(nodes.error().message);
                status_ = 1;
                return;
            }
            HeadSession session(config, plan, std::move(*nodes), *control_, std::move(options));
            status_ = session.run();
        });
    }

    // Returns the next event of that name; stores others in `seen`.
    nlohmann::json waitFor(const std::string& event) {
        const Deadline deadline = Deadline::inMs(kTestPatienceMs);
        while (!deadline.passed()) {
            const auto line = reader_->receive(Deadline::inMs(100));
            if (!line) {
                if (reader_->broken() && ended()) break;
                continue;
            }
            nlohmann::json json = parseJson(*line);
            seen.push_back(json);
            if (json["event"] == event) return json;
        }
        ADD_FAILURE() << "no event " << event;
        return {};
    }
    std::string waitForMessage(const std::string& part) {
        const Deadline deadline = Deadline::inMs(kTestPatienceMs);
        for (const auto& e : seen)
            if (e["event"] == "say" && e["text"].get<std::string>().find(part) != std::string::npos) return e["text"];
        while (!deadline.passed()) {
            const auto line = reader_->receive(Deadline::inMs(100));
            if (!line) continue;
            seen.push_back(parseJson(*line));
            const auto& e = seen.back();
            if (e["event"] == "say" && e["text"].get<std::string>().find(part) != std::string::npos) return e["text"];
        }
        ADD_FAILURE() << "nothing said of " << part;
        return "";
    }
    nlohmann::json finish() {
        const std::string line = "{\"command\":\"finish\"}\n";
        EXPECT_EQ(send(mine_.get(), line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
        nlohmann::json report = waitFor("report");
        thread_.join();
        return report;
    }
    void breakControl() {
        mine_ = FileDescriptor();
        reader_.reset();
        thread_.join();
    }
    int status() const { return status_; }
    bool ended() const { return status_ >= 0; }
    FakeNode& node(int index) { return *nodes_[static_cast<size_t>(index)]; }

    std::vector<nlohmann::json> seen;

private:
    void connectControl() {
        int ends[2];
        ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
        mine_ = FileDescriptor(ends[0]);
        control_ = std::make_unique<ControlChannel>(FileDescriptor(ends[1]));
        reader_ = std::make_unique<ControlChannel>(FileDescriptor(fcntl(ends[0], F_DUPFD_CLOEXEC, 3)));
        lines_ = std::make_unique<LogToControl>(*control_);
    }

    FileDescriptor mine_;
    std::unique_ptr<ControlChannel> control_;
    std::unique_ptr<ControlChannel> reader_;
    std::unique_ptr<LogToControl> lines_;
    std::vector<std::unique_ptr<FakeNode>> nodes_;
    std::atomic<int> status_{-1};
    std::thread thread_;
};

} // namespace mural
