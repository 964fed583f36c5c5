#include "nodes/launch/launchers/starter/starter_link.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "common/log/log.hpp"
#include "nodes/launch/launchers/shell_words.hpp"

namespace mural::launch {
namespace {

constexpr int64_t kBeatMs = 10'000;     // a third of the silence that a starter tolerates
constexpr int64_t kSendMs = 5'000;      // the command reads its input
constexpr int64_t kEndMs = 3'000;       // of the starters, after the end of their input
constexpr int64_t kLastLinesMs = 500;   // another process may hold the output open
constexpr int64_t kTerminateMs = 1'000; // of the command, after SIGTERM

struct Pipe {
    FileDescriptor reader, writer;
};

Result<Pipe> makePipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return Error{std::string("pipe: ") + std::strerror(errno)};
    return Pipe{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

} // namespace

// A node that a starter runs.
class StarterLink::Node : public RunningNode {
public:
    Node(std::shared_ptr<StarterLink> link, std::shared_ptr<State> state, int id)
        : link_(std::move(link)), state_(std::move(state)), id_(id) {}
    ~Node() override { kill(); }

    [[nodiscard]] pid_t pid() const override {
        const std::lock_guard lock(link_->mutex_);
        return state_->pid;
    }
    std::optional<std::string> ended() override { return link_->endOf(*state_); }
    void kill() override {
        if (ended() || isKilled_.exchange(true)) return;
        StarterRequest stop;
        stop.kind = StarterRequest::Kind::Stop;
        stop.id = id_;
        link_->send(lineOf(stop));
        const std::lock_guard lock(link_->mutex_);
        if (!state_->ended) state_->ended = "it was stopped";
        link_->states_.erase(id_);
    }
    [[nodiscard]] std::string details() const override {
        std::string lines = state_->lines.text();
        {
            const std::lock_guard lock(link_->mutex_);
            if (state_->isHostGone) lines = link_->noise_.text();
            if (state_->ended) return lines.empty() ? "" : ": " + lines;
        }
        lines = link_->noise_.text();
        const auto end = link_->ended();
        const std::string remedy = end && link_->command_.addRemedy ? link_->command_.addRemedy(lines) : "";
        return " of \"" + joined(link_->command_.arguments, " ") + "\"" +
               (lines.empty() ? ", without a message" : ": " + lines) + remedy;
    }

private:
    const std::shared_ptr<StarterLink> link_;
    const std::shared_ptr<State> state_;
    const int id_;
    std::atomic<bool> isKilled_{false};
};

Result<std::shared_ptr<StarterLink>> StarterLink::start(StarterCommand command) {
    auto input = makePipe();
    auto output = input ? makePipe() : Result<Pipe>(input.error());
    auto errors = output ? makePipe() : Result<Pipe>(output.error());
    if (!errors) return errors.error();
    SpawnRequest request;
    request.file = command.arguments.front();
    request.arguments = command.arguments;
    request.environment = command.environment;
    request.inputFd = input->reader.get();
    request.outputFd = output->writer.get();
    request.errorFd = errors->writer.get();
    request.ownSession = true; // without a terminal, so that the command cannot ask for a password
    request.signalWhenWeDie = command.signalWhenWeDie;
    auto process = ChildProcess::start(request);
    if (!process) return process.error();
    fcntl(input->writer.get(), F_SETFL, O_NONBLOCK);
    std::shared_ptr<StarterLink> link(new StarterLink(std::move(command), *process, std::move(input->writer)));
    link->read(std::move(output->reader), std::move(errors->reader));
    return link;
}

StarterLink::StarterLink(StarterCommand command, ChildProcess process, FileDescriptor input)
    : command_(std::move(command)), input_(std::move(input)), process_(process) {}

StarterLink::~StarterLink() {
    closeInput();
    end(Deadline::inMs(kEndMs));
}

void StarterLink::closeInput() {
    const std::lock_guard lock(writing_);
    input_ = FileDescriptor();
}

void StarterLink::end(Deadline deadline) {
    while (true) {
        const std::lock_guard lock(mutex_);
        if (!process_.running()) return;
        if (deadline.passed() || !isGreeted_) break; // without a starter there is nothing to wait for
        poll(nullptr, 0, 2);
    }
    const std::lock_guard lock(mutex_);
    process_.end(Deadline::inMs(kTerminateMs));
    process_.signalGroup(SIGKILL);
}

void StarterLink::read(FileDescriptor output, FileDescriptor errors) {
    StarterRequest alive;
    output_ = std::make_unique<OutputLines>(
        std::move(output), [this](std::string_view line) { takeOutput(line); },
        [this, line = lineOf(alive)] { send(line); }, kBeatMs);
    errors_ = std::make_unique<OutputLines>(std::move(errors), [this](std::string_view line) { takeNoise(line); });
}

StarterLink::Prepared StarterLink::prepare(const NodeTask& task, const std::string& host) {
    auto state = std::make_shared<State>();
    state->node = task.node;
    state->host = task.host;
    StarterRequest start;
    start.kind = StarterRequest::Kind::Start;
    start.host = host;
    start.name = task.name;
    start.endpoint = task.endpoint;
    start.secret = task.secret;
    {
        const std::lock_guard lock(mutex_);
        start.id = nextId_++;
        states_[start.id] = state;
        if (const auto gone = gone_.find(task.host); gone != gone_.end()) {
            state->ended = gone->second;
            state->isHostGone = true;
            state->lastLines = Deadline::inMs(0);
        }
    }
    return {std::make_unique<Node>(shared_from_this(), state, start.id), lineOf(start)};
}

void StarterLink::send(const std::string& line) {
    const std::string text = line + "\n";
    const Deadline deadline = Deadline::inMs(kSendMs);
    const std::lock_guard lock(writing_);
    for (size_t at = 0; at < text.size() && input_.valid();) {
        const ssize_t n = write(input_.get(), text.data() + at, text.size() - at);
        if (n > 0) {
            at += static_cast<size_t>(n);
        } else if (errno == EAGAIN && !deadline.passed()) {
            pollfd room{input_.get(), POLLOUT, 0};
            poll(&room, 1, 50);
        } else if (errno != EINTR) {
            input_ = FileDescriptor(); // the command is gone, or hangs: it loses its starters
        }
    }
}

std::optional<std::string> StarterLink::ended() {
    std::string how;
    {
        const std::lock_guard lock(mutex_);
        if (end_) return end_;
        if (process_.running()) return std::nullopt;
        how = process_.describeEnd();
    }
    const Deadline deadline = Deadline::inMs(kLastLinesMs);
    (void)(output_->drain(deadline) && errors_->drain(deadline)); // without the lock: the threads need it
    const std::lock_guard lock(mutex_);
    if (!end_) log::debug(log::Topic::Launch, command_.name, " has ended: ", how);
    if (!end_) end_ = how;
    return end_;
}

bool StarterLink::isGone(const std::string& host) {
    if (ended()) return true;
    const std::lock_guard lock(mutex_);
    return gone_.contains(host);
}

void StarterLink::setGone(const std::string& host, const std::string& why) {
    const std::lock_guard lock(mutex_);
    gone_.try_emplace(host, why);
    for (auto& [id, state] : states_)
        if (state->host == host && !state->ended) {
            state->ended = why;
            state->isHostGone = true;
            state->lastLines = Deadline::inMs(kLastLinesMs);
        }
}

std::optional<std::string> StarterLink::endOf(State& state) {
    {
        const std::lock_guard lock(mutex_);
        if (state.ended && (!state.isHostGone || state.lastLines.passed())) return state.ended;
    }
    return ended();
}

std::shared_ptr<StarterLink::State> StarterLink::stateOf(int id) {
    const std::lock_guard lock(mutex_);
    const auto found = states_.find(id);
    return found != states_.end() ? found->second : nullptr;
}

// Greetings of login shells may precede the messages.
void StarterLink::takeOutput(std::string_view line) {
    const auto reply = starterReplyOf(line);
    if (!reply) return takeNoise(line);
    if (reply->kind == StarterReply::Kind::Hello) return checkHello(*reply);
    const auto state = stateOf(reply->id);
    if (!state) {
        if (reply->id == 0) takeNoise(reply->text);
        return;
    }
    switch (reply->kind) {
    case StarterReply::Kind::Started: {
        const std::lock_guard lock(mutex_);
        state->pid = reply->pid;
        return;
    }
    case StarterReply::Kind::Ended: {
        const std::lock_guard lock(mutex_);
        state->ended = reply->text;
        return;
    }
    case StarterReply::Kind::Says:
        state->lines.add(reply->text);
        log::info(log::Topic::Launch, "node ", state->node, " (", state->host, "): ", reply->text);
        return;
    case StarterReply::Kind::Hello: return;
    }
}

void StarterLink::takeNoise(std::string_view line) {
    noise_.add(line);
    log::debug(log::Topic::Launch, command_.name, ": ", line);
    if (!command_.lostHosts) return;
    for (const std::string& host : command_.lostHosts(line)) setGone(host, std::string(line));
}

void StarterLink::checkHello(const StarterReply& hello) {
    log::debug(log::Topic::Launch, command_.name, ": a starter runs on ", hello.host);
    {
        const std::lock_guard lock(mutex_);
        isGreeted_ = true;
    }
    if (hello.version == command_.version && hello.build == command_.build) return;
    const std::string why = hello.host + " has mural " + hello.version + " (stream " + hello.build +
                            "), but this machine has " + command_.version + " (stream " + command_.build +
                            "); install the same version, or select it with --remote-mural";
    setGone(command_.onlyHost.empty() ? hello.host : command_.onlyHost, why);
}

} // namespace mural::launch
