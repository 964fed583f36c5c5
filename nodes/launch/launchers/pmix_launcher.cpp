#include "nodes/launch/launchers/pmix_launcher.hpp"

#include <algorithm>
#include <csignal>
#include <poll.h>
#include <iterator>
#include <sstream>
#include <unistd.h>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/launch/launchers/node_process.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/starter/starter_protocol.hpp"

namespace mural {
namespace {

constexpr const char* kKey = "mural.nodes"; // the lines of starter_protocol.hpp
constexpr int kPollMs = 50;

volatile std::sig_atomic_t endRequested = 0;

} // namespace

std::string pmixHostOf(int rank) { return "rank" + std::to_string(rank); }

PmixLauncher::PmixLauncher(int64_t timeoutMs) : timeoutMs_(timeoutMs) {}
PmixLauncher::~PmixLauncher() = default;

Result<void> PmixLauncher::publish(const std::vector<NodeTask>& tasks) {
    auto client = launch::PmixClient::open();
    if (!client) return client.error();
    client_ = std::move(*client);
    std::string lines;
    for (const NodeTask& task : tasks) {
        launch::StarterRequest request;
        request.kind = launch::StarterRequest::Kind::Start;
        request.id = task.node + 1;
        request.host = task.host;
        request.name = task.name;
        request.endpoint = task.endpoint;
        request.secret = task.secret;
        lines += lineOf(request) + "\n";
    }
    if (auto put = client_->put(kKey, lines); !put) return put;
    return client_->fence(Deadline::inMs(timeoutMs_));
}

std::vector<std::unique_ptr<RunningNode>> PmixLauncher::start(const std::vector<NodeTask>& tasks) {
    std::string why = "the processes of mpirun or srun start their nodes only once; --launch ssh and slurm can restart "
                      "nodes";
    if (!std::exchange(isStarted_, true)) {
        const auto published = publish(tasks);
        why = published ? "" : "PMIx: " + published.error().message;
    }
    // Their connections show the ends of started nodes.
    std::vector<std::unique_ptr<RunningNode>> nodes(tasks.size());
    for (auto& node : nodes)
        if (!why.empty()) node = std::make_unique<AbsentNode>(why);
    return nodes;
}

int runPmixRank(int rank, const NodeBinary& binary, int64_t timeoutMs) {
    signal(SIGPIPE, SIG_IGN);
    for (const int number : {SIGTERM, SIGINT, SIGHUP}) signal(number, [](int) { endRequested = 1; });
    const auto failed = [&](const std::string& why) {
        log::error(log::Topic::Launch, "rank ", rank, ": ", why);
        return 1;
    };
    auto client = launch::PmixClient::open();
    if (!client) return failed(client.error().message);
    if (auto met = (*client)->fence(Deadline::inMs(timeoutMs), [] { return endRequested != 0; }); !met)
        return failed(met.error().message);
    const auto lines = (*client)->get(0, kKey);
    if (!lines) return failed("rank 0 has published no nodes: " + lines.error().message);
    struct RankNode {
        std::string name, command;
        std::unique_ptr<NodeProcess> process;
        bool isOver = false;
    };
    std::vector<RankNode> nodes;
    std::istringstream text(lines.value());
    for (std::string line; std::getline(text, line);) {
        const auto request = launch::starterRequestOf(line);
        if (!request || request->host != pmixHostOf(rank)) continue;
        NodeCommand command;
        command.arguments = {binary.program, binary.nodeWord(), "--as", request->name, "--connect", request->endpoint};
        command.standardInput = request->secret + "\n";
        auto started = NodeProcess::start(command);
        if (!started) return failed(started.error().message);
        nodes.push_back(
            {"node " + std::to_string(request->id - 1), launch::joined(command.arguments, " "), std::move(*started)});
    }
    // Nodes end with the head. A failed node does not end the other ranks. The head sees its connection only, so that
    // the exit status comes from here.
    char host[256] = "localhost";
    gethostname(host, sizeof(host) - 1);
    const auto isOver = [&](RankNode& node) {
        const auto how = node.isOver ? std::nullopt : node.process->ended();
        if (!how) return node.isOver;
        if (*how != "exit status 0" && endRequested == 0)
            log::error(log::Topic::Launch, node.name, " (", pmixHostOf(rank), " on ", host, ") ended: ", *how, " of \"",
                       node.command, "\"", node.process->details());
        return node.isOver = true;
    };
    while (endRequested == 0 && std::ranges::count_if(nodes, isOver) < std::ssize(nodes)) poll(nullptr, 0, kPollMs);
    return 0;
}

} // namespace mural
