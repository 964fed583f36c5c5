#include "nodes/launch/launchers/node_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

#include "nodes/launch/environment.hpp"
#include "nodes/launch/launchers/shell_words.hpp"

namespace mural {
namespace {

constexpr int64_t kLastLinesMs = 500; // another process may hold the output open

} // namespace

Result<FileDescriptor> inputOf(const std::string& text) {
    if (text.empty()) {
        FileDescriptor null(open("/dev/null", O_RDONLY | O_CLOEXEC));
        if (!null.valid()) return Error{std::string("open /dev/null: ") + std::strerror(errno)};
        return null;
    }
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return Error{std::string("pipe: ") + std::strerror(errno)};
    FileDescriptor reader(ends[0]);
    const FileDescriptor writer(ends[1]);
    // A new pipe accepts a page without blocking.
    if (write(writer.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
        return Error{std::string("write to a pipe: ") + std::strerror(errno)};
    return reader;
}

Result<std::unique_ptr<NodeProcess>> NodeProcess::start(const NodeCommand& command) {
    auto input = inputOf(command.standardInput);
    if (!input) return input.error();
    FileDescriptor ours, theirs;
    if (command.takeLine) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) return Error{std::string("pipe: ") + std::strerror(errno)};
        ours = FileDescriptor(ends[0]);
        theirs = FileDescriptor(ends[1]);
    }
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    launch::SpawnRequest request;
    request.file = command.arguments[0];
    request.arguments = command.arguments;
    request.environment = environment.entries();
    if (command.inheritFd >= 0) request.inheritedFds.push_back(command.inheritFd);
    request.inputFd = input->get();
    request.outputFd = theirs.valid() ? theirs.get() : STDERR_FILENO; // standard output belongs to the program
    request.errorFd = theirs.valid() ? theirs.get() : -1;
    request.ownSession = true;
    request.signalWhenWeDie = SIGKILL;
    auto started = launch::ChildProcess::start(request);
    if (!started) return started.error();
    std::unique_ptr<NodeProcess> node(new NodeProcess(*started, command));
    if (ours.valid()) node->capture(std::move(ours), command);
    return node;
}

NodeProcess::NodeProcess(launch::ChildProcess process, const NodeCommand& command)
    : pid_(process.pid()),
      command_(launch::joined(command.arguments, " ")),
      isHandedOver_(command.isHandedOver),
      process_(process) {}

void NodeProcess::capture(FileDescriptor output, const NodeCommand& command) {
    output_ = std::make_unique<launch::OutputLines>(std::move(output),
                                                    [this, take = command.takeLine](std::string_view line) {
                                                        recent_.add(line);
                                                        take(line);
                                                    });
}

NodeProcess::~NodeProcess() { kill(); }

std::optional<std::string> NodeProcess::ended() {
    const std::lock_guard lock(mutex_);
    if (process_.running()) return std::nullopt;
    if (output_ && !std::exchange(isDrained_, true)) (void)output_->drain(Deadline::inMs(kLastLinesMs));
    return process_.describeEnd();
}

std::string NodeProcess::details() const {
    const std::string lines = recent_.text();
    if (!output_) return "; see its messages";
    return " of \"" + command_ + "\"" + (lines.empty() ? ", without a message" : ": " + lines);
}

void NodeProcess::kill() {
    {
        const std::lock_guard lock(mutex_);
        if (!process_.running()) return; // another process may reuse its pid
        process_.signalGroup(SIGKILL);
        process_.signal(SIGKILL);
    }
    waitEnded(Deadline::inMs(5000));
}

} // namespace mural
