#include "tools/mural/network/probe_process.hpp"

#include <cctype>
#include <csignal>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/json/json_text.hpp"
#include "nodes/launch/environment.hpp"
#include "transport/system_error.hpp"

namespace mural::cli {

namespace {
constexpr int64_t kSendMs = 5'000;
constexpr int64_t kEndMs = 2'000;
} // namespace

Result<std::unique_ptr<ProbeProcess>> ProbeProcess::start(const std::vector<std::string>& command) {
    int toIt[2];
    int fromIt[2];
    if (pipe2(toIt, O_CLOEXEC) != 0) return Error{"cannot create a pipe: " + errnoText(errno)};
    const FileDescriptor itsInput(toIt[0]);
    FileDescriptor ownEnd(toIt[1]);
    if (pipe2(fromIt, O_CLOEXEC) != 0) return Error{"cannot create a pipe: " + errnoText(errno)};
    FileDescriptor output(fromIt[0]);
    const FileDescriptor itsOutput(fromIt[1]);
    launch::Environment environment = launch::Environment::current();
    launch::removeCapture(environment);
    launch::SpawnRequest request;
    request.file = command.front();
    request.arguments = command;
    request.environment = environment.entries();
    request.inputFd = itsInput.get();
    request.outputFd = itsOutput.get();
    FileDescriptor errors(memfd_create("mural-probe-errors", MFD_CLOEXEC));
    request.errorFd = errors.get();
    request.ownSession = true;
    request.signalWhenWeDie = SIGKILL;
    auto process = launch::ChildProcess::start(request);
    if (!process) return process.error();
    return std::unique_ptr<ProbeProcess>(
        new ProbeProcess(*process, LineChannel(std::move(output), std::move(ownEnd)), std::move(errors)));
}

ProbeProcess::~ProbeProcess() {
    lines_.closeWriting(); // the process then ends by itself
    if (process_.waitUntil(Deadline::inMs(kEndMs))) return;
    process_.signalGroup(SIGKILL);
    process_.end(Deadline::inMs(0));
}

std::string ProbeProcess::describeEnd() const {
    char text[4096];
    const off_t size = lseek(errors_.get(), 0, SEEK_END);
    const off_t from = size > static_cast<off_t>(sizeof text) ? size - static_cast<off_t>(sizeof text) : 0;
    const ssize_t n = pread(errors_.get(), text, sizeof text, from);
    std::string words(text, n > 0 ? static_cast<size_t>(n) : 0);
    while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back())) != 0) words.pop_back();
    words.erase(0, words.find_last_of("\r\n") + 1);
    return process_.describeEnd() + (words.empty() ? "" : ", " + words);
}

// The end of the process explains a broken channel.
Error ProbeProcess::explained(const Error& why) {
    const bool ended = process_.waitUntil(Deadline::inMs(200));
    return ended ? Error{"the test process ended: " + describeEnd()} : why;
}

Result<void> ProbeProcess::send(const nlohmann::json& words) {
    auto written = lines_.write(jsonText(words), Deadline::inMs(kSendMs));
    if (!written) return explained(written.error());
    return written;
}

Result<nlohmann::json> ProbeProcess::receive(Deadline deadline) {
    auto line = lines_.read(deadline);
    if (!line) return explained(line.error());
    auto answer = parseJson(*line);
    if (!answer.is_object())
        return Error{"invalid reply \"" + line->substr(0, 80) + "\"; check the host's shell for startup output"};
    if (answer.contains("failed") && answer["failed"].is_string()) return Error{answer["failed"].get<std::string>()};
    return answer;
}

Result<nlohmann::json> ProbeProcess::query(const nlohmann::json& words, Deadline deadline) {
    if (auto r = send(words); !r) return r.error();
    return receive(deadline);
}

} // namespace mural::cli
