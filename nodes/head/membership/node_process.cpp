#include "nodes/head/membership/node_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "nodes/launch/environment.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {
namespace {

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

} // namespace

Result<std::unique_ptr<NodeProcess>> NodeProcess::start(const NodeCommand& command) {
    auto input = inputOf(command.standardInput);
    if (!input) return input.error();
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    launch::SpawnRequest request;
    request.file = command.arguments[0];
    request.arguments = command.arguments;
    request.environment = environment.entries();
    if (command.inheritFd >= 0) request.inheritedFds.push_back(command.inheritFd);
    request.inputFd = input->get();
    request.outputFd = STDERR_FILENO; // standard output belongs to the program
    request.ownSession = true;
    request.signalWhenWeDie = SIGKILL;
    auto started = launch::ChildProcess::start(request);
    if (!started) return started.error();
    return std::unique_ptr<NodeProcess>(new NodeProcess(*started));
}

NodeProcess::~NodeProcess() { kill(); }

std::optional<std::string> NodeProcess::ended() {
    const std::lock_guard lock(mutex_);
    if (process_.running()) return std::nullopt;
    return process_.describeEnd();
}

std::optional<std::string> NodeProcess::waitEnded(Deadline deadline) {
    constexpr int kSliceMs = 5;
    while (true) {
        if (auto how = ended()) return how;
        if (deadline.passed()) return std::nullopt;
        poll(nullptr, 0, kSliceMs);
    }
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
