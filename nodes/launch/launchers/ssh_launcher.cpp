#include "nodes/launch/launchers/ssh_launcher.hpp"

#include <csignal>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/launchers/shell_words.hpp"
#include "nodes/launch/launchers/starter/starter_link.hpp"

namespace mural {
namespace {

constexpr int64_t kEndMs = 3'000; // of all starters

std::string sshRemedy(const std::string& lines) {
    const auto says = [&](const char* text) { return lines.find(text) != std::string::npos; };
    if (says("Could not resolve hostname")) return "; check the host's name, or add it to ~/.ssh/config";
    if (says("Permission denied")) return "; ssh must log in without a password: add a key with ssh-copy-id";
    if (says("Host key verification failed")) return "; connect once with ssh and accept the host's key";
    if (says("Connection refused") || says("No route to host") || says("timed out"))
        return "; check that the host runs and accepts ssh connections";
    if (says("unknown command starter")) return "; install the same version of mural there";
    if (says("not found") || says("No such file")) return "; install mural there, or give its path with --remote-mural";
    return "";
}

} // namespace

std::vector<std::string> starterCommandOf(const NodeBinary& binary) {
    std::vector<std::string> command{binary.mural, "starter"};
    if (binary.isNative) {
        command.emplace_back("--program");
        command.push_back(binary.program);
    }
    return command;
}

// ServerAlive: a connection without an answer ends after 15 s, and the nodes with it. The host cannot ask for anything,
// because no terminal exists.
std::vector<std::string> sshCommandOf(const std::string& host, const NodeBinary& binary) {
    std::vector<std::string> command{"ssh", "-T",
                                     "-o",  "BatchMode=yes",
                                     "-o",  "ConnectTimeout=10",
                                     "-o",  "ServerAliveInterval=5",
                                     "-o",  "ServerAliveCountMax=3",
                                     "--",  host,
                                     "exec"};
    for (const std::string& word : starterCommandOf(binary)) command.push_back(launch::quoted(word));
    return command;
}

SshLauncher::SshLauncher(NodeBinary binary, StarterVersion version)
    : binary_(std::move(binary)), version_(std::move(version)) {}

SshLauncher::~SshLauncher() {
    for (auto& [host, link] : links_)
        if (link) link->closeInput();
    const Deadline deadline = Deadline::inMs(kEndMs);
    for (auto& [host, link] : links_)
        if (link) link->end(deadline);
}

std::shared_ptr<launch::StarterLink> SshLauncher::linkTo(const std::string& host, std::string& why) {
    auto& link = links_[host];
    if (link && !link->isGone(host)) return link;
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    launch::StarterCommand command;
    command.arguments = sshCommandOf(host, binary_);
    command.environment = environment.entries();
    command.name = "ssh to " + host;
    command.version = version_.version;
    command.build = version_.build;
    command.onlyHost = host;
    command.signalWhenWeDie = SIGKILL; // the host notices the end of the connection
    command.addRemedy = sshRemedy;
    auto started = launch::StarterLink::start(std::move(command));
    if (!started) why = started.error().message;
    link = started ? *started : nullptr;
    return link;
}

std::vector<std::unique_ptr<RunningNode>> SshLauncher::start(const std::vector<NodeTask>& tasks) {
    std::vector<std::unique_ptr<RunningNode>> nodes;
    nodes.reserve(tasks.size());
    for (const NodeTask& task : tasks) {
        std::string why;
        const auto link = linkTo(task.host, why);
        if (!link) {
            nodes.push_back(std::make_unique<AbsentNode>(why));
            continue;
        }
        auto prepared = link->prepare(task, "*");
        link->send(prepared.line);
        nodes.push_back(std::move(prepared.node));
    }
    return nodes;
}

} // namespace mural
