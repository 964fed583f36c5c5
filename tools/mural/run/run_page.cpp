#include "tools/mural/run/run_page.hpp"

#include <csignal>
#include <unistd.h>

#include "nodes/launch/environment.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kPageEndMs = 2'000;

} // namespace

Result<std::unique_ptr<RunPage>> RunPage::start(const std::string& address) {
    launch::SpawnRequest request;
    request.file = launch::ownBinary();
    request.arguments = {request.file, "page", std::to_string(getpid())};
    if (!address.empty()) request.arguments.insert(request.arguments.end(), {"--at", address});
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    request.environment = environment.entries();
    request.outputFd = STDERR_FILENO; // standard output belongs to the program
    request.ownSession = true;        // Ctrl-C ends the program and the head; the page reports their end to viewers
    request.signalWhenWeDie = SIGTERM;
    auto process = launch::ChildProcess::start(request);
    if (!process) return process.error();
    return std::unique_ptr<RunPage>(new RunPage(process.value()));
}

RunPage::~RunPage() {
    if (!process_.waitUntil(Deadline::inMs(kPageEndMs))) process_.end(Deadline::inMs(kPageEndMs));
}

void RunPage::watch(Console& console) {
    if (isReported_ || process_.running()) return;
    isReported_ = true;
    console.error("the page has ended (" + process_.describeEnd() +
                  "); the wall continues, and mural page opens another one");
}

} // namespace mural::cli
