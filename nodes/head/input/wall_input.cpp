#include "nodes/head/input/wall_input.hpp"

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "nodes/input/program_display.hpp"

namespace mural {

namespace {

constexpr int64_t kFindEveryNs = 2 * kNsPerS;    // the program may open another window
constexpr int64_t kRetryEveryNs = 50 * kNsPerMs; // while no program is found

// Other events occur without an action of a person: the pointer crosses a window, or the focus changes.
bool isAction(const input::InputEvent& event) {
    return event.kind != input::InputKind::Move && event.kind != input::InputKind::Blur &&
           event.kind != input::InputKind::Size;
}

} // namespace

void WallInput::take(const Source& source, const input::InputEvent& event) {
    const std::lock_guard lock(mutex_);
    findDisplay(monotonicNowNs());
    if (!problem_.empty()) return report(source, event, problem_);
    if (!isPrivate_ && source.permission != input::InputPermission::Any)
        return report(source, event,
                      "the program is on a display of its user; " + source.option +
                          " permits input there, and moves the pointer of that user");
    (void)input_.send(1, event); // a full queue drops it
    report(source, event, input_.problem());
}

void WallInput::releaseAll() {
    const std::lock_guard lock(mutex_);
    if (input_.hasDisplay()) input_.releaseAll();
}

void WallInput::findDisplay(int64_t nowNs) {
    if (foundNs_ != 0 && nowNs - foundNs_ < (problem_.empty() ? kFindEveryNs : kRetryEveryNs)) return;
    foundNs_ = nowNs;
    const auto program = find_();
    const auto display = program ? input::programDisplay(program->pid, runPid_, program->display, program->window)
                                 : Result<input::ProgramDisplay>(program.error());
    problem_ = display ? "" : display.error().message;
    if (!display) return;
    isPrivate_ = display->isPrivate;
    input_.use(*display);
}

void WallInput::report(const Source& source, const input::InputEvent& event, const std::string& why) {
    if (!isAction(event) || why.empty() || why == reported_) return;
    reported_ = why;
    log::warning(log::Topic::Session, "no input of ", source.name, " reaches the program: ", why);
}

} // namespace mural
