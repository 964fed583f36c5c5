// Input of the hub's viewers for the program: the lease, and the program's display.
#include <string>
#include <utility>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "nodes/input/program_input.hpp"
#include "tools/mural/page/hub/page_hub.hpp"
#include "tools/mural/page/hub/page_replies.hpp"
#include "tools/mural/page/input/cursor_watch.hpp"

namespace mural::page {

namespace {

constexpr int64_t kProgramEveryNs = 2 * kNsPerS;

// Returns a whole number of the object that fits a process or a window; 0: it has none.
uint32_t numberOf(const nlohmann::json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_number_integer()) return 0;
    const auto number = found->get<int64_t>();
    return number > 0 && number <= UINT32_MAX ? static_cast<uint32_t>(number) : 0;
}

} // namespace

void PageHub::take(int number, const input::InputEvent& event) {
    Viewer& viewer = viewers_.at(number);
    const int64_t nowNs = monotonicNowNs();
    if (viewer.link.role < Role::Input) {
        ++deniedRequests_;
        return;
    }
    findProgram(nowNs);
    const bool takes = event.kind == input::InputKind::Down || (event.kind == input::InputKind::Touch && event.isDown);
    const bool passes = viewer.inputs.take(nowNs) &&
                        lease_.passes(number, viewer.link.role, takes, input_->holdsButtons(), nowNs) &&
                        input_->hasDisplay() && input_->send(number, event);
    ++(passes ? inputs_ : droppedInputs_);
    changeHolder();
}

// Asks the head for the program's window now and then, while input comes or somebody watches.
void PageHub::findProgram(int64_t nowNs) {
    if (programAskedNs_ != 0 && nowNs - programAskedNs_ < kProgramEveryNs) return;
    programAskedNs_ = nowNs;
    quick_->request("program-window", Json::object(), [this](const Json& reply) {
        const auto result = reply.find("result");
        if (result != reply.end() && result->is_object()) takeProgram(*result);
    });
}

void PageHub::takeProgram(const Json& program) {
    const auto pid = static_cast<pid_t>(numberOf(program, "pid"));
    const auto runPid = static_cast<pid_t>(numberOf(config_.hello, "runPid"));
    auto display =
        input::programDisplay(pid, runPid, program.value("display", std::string()), numberOf(program, "window"));
    std::string problem;
    const bool isPrivate = display && display->isPrivate;
    pictures_.setDisplay(isPrivate ? std::optional(*display) : std::nullopt,
                         display && !isPrivate
                             ? "the program is on a display of its user, which the page does not show; add --size for "
                               "a private display"
                             : "");
    if (!display)
        problem = display.error().message;
    else if (!display->isPrivate && !config_.reachesUserDisplay)
        problem = "the program is on a display of its user; --input-on-display permits input there, and moves the "
                  "pointer of that user";
    else
        input_->use(*display);
    display_ = problem.empty() ? std::optional(*display) : std::nullopt;
    if (problem.empty()) problem = input_->problem();
    if (!problem.empty() && problem != inputProblem_ && lease_.holder() != 0)
        log::warning(log::Topic::Session, "no input reaches the program: ", problem);
    inputProblem_ = std::move(problem);
}

void PageHub::watchCursor(int64_t nowNs) {
    const bool isWatched = pictures_.isDisplayWatched();
    // The first viewer's request for the display needs the answer.
    if (isWatched || (programAskedNs_ == 0 && !viewers_.empty())) findProgram(nowNs);
    cursor_->watch(isWatched ? display_ : std::nullopt);
}

PageHub::Json PageHub::takeInput(int number, const Json& arguments) {
    if (!arguments.empty()) return failureOf(control_code::kBadArgument, "input-take has no arguments");
    const int64_t nowNs = monotonicNowNs();
    findProgram(nowNs);
    if (!lease_.take(number, viewers_.at(number).link.role, nowNs))
        return failureOf(control_code::kFailed, "another viewer has the input, or --control owner reserves it");
    changeHolder();
    Json problem = nullptr;
    if (!inputProblem_.empty()) problem = inputProblem_;
    return {{"ok", true}, {"result", {{"problem", problem}}}};
}

PageHub::Json PageHub::releaseInput(int number, const Json& arguments) {
    if (!arguments.empty()) return failureOf(control_code::kBadArgument, "input-release has no arguments");
    if (!lease_.release(number)) return failureOf(control_code::kFailed, "this viewer does not have the input");
    changeHolder();
    return {{"ok", true}, {"result", Json::object()}};
}

// Releases what the earlier holder held down, and announces the new one.
void PageHub::changeHolder() {
    if (lease_.holder() == knownHolder_) return;
    if (knownHolder_ != 0) input_->releaseAll();
    knownHolder_ = lease_.holder();
    if (!hasEnded_) announceViewers();
}

} // namespace mural::page
