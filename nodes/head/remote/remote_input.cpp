#include "nodes/head/remote/remote_input.hpp"

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "nodes/input/program_display.hpp"

namespace mural {

namespace {

constexpr int64_t kFindEveryNs = 2 * kNsPerS; // the program may open another window

} // namespace

void RemoteInput::take(const std::string& wall, remote::InputFrom permission, const input::InputEvent& event) {
    const std::lock_guard lock(mutex_);
    findDisplay(monotonicNowNs());
    if (!problem_.empty()) return report(wall, problem_);
    if (!isPrivate_ && permission != remote::InputFrom::Any)
        return report(wall, "the program is on a display of its user; input=display permits input there, and moves "
                            "the pointer of that user");
    (void)input_.send(1, event); // a full queue drops it
    report(wall, input_.problem());
}

void RemoteInput::releaseAll() {
    const std::lock_guard lock(mutex_);
    if (input_.hasDisplay()) input_.releaseAll();
}

void RemoteInput::findDisplay(int64_t nowNs) {
    if (foundNs_ != 0 && nowNs - foundNs_ < kFindEveryNs) return;
    foundNs_ = nowNs;
    const auto program = find_();
    const auto display = program ? input::programDisplay(program->pid, runPid_, program->display, program->window)
                                 : Result<input::ProgramDisplay>(program.error());
    problem_ = display ? "" : display.error().message;
    if (!display) return;
    isPrivate_ = display->isPrivate;
    input_.use(*display);
}

void RemoteInput::report(const std::string& wall, const std::string& why) {
    if (why.empty() || why == reported_) return;
    reported_ = why;
    log::warning(log::Topic::Session, "no input of remote wall ", wall, " reaches the program: ", why);
}

} // namespace mural
