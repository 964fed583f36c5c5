#include "tools/mural/run/run_session.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/pause_watch.hpp"
#include "common/json/json_text.hpp"
#include "nodes/launch/bypass_watch.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/launch/program_supervisor.hpp"
#include "tools/mural/head_control.hpp"
#include "tools/mural/run/program_loop.hpp"
#include "tools/mural/run/run_page.hpp"

namespace mural::cli {

namespace {

// The head reports late nodes itself, after twice --start-timeout at most.
constexpr int64_t kBeyondStartMs = 60'000;
// A launcher may start the program and end. Its children have this time until their first context…
constexpr int64_t kFirstContextMs = 30'000;
// …and its remaining processes have this time after the last context has ended.
constexpr int64_t kAfterLastContextMs = 1'000;
constexpr int64_t kWaitNoticeMs = 3'000;
// A program without a context for this time may draw without the capture library. Its libraries are then examined.
constexpr int64_t kExaminationMs = 10'000;
// Interval of the check for processes that run without the capture library.
constexpr int64_t kUncapturedMs = 1'000;
// Permitted silence of the head after the program's end, while it drains and writes pictures.
constexpr int64_t kFinishSilenceMs = 120'000;
// Exit statuses, whatever the ended program's status is.
constexpr int kWallLost = 1;
constexpr int kAuditFailed = 1; // --culling audit: a node left out a sample of its area

class Session {
public:
    Session(PreparedRun& run, Console& console, launch::ProgramSupervisor& program, launch::BypassWatch& bypass)
        : run_(run), console_(console), program_(program), bypass_(bypass) {}

    int perform() {
        auto head = HeadControl::start(run_.headCommand, run_.headEnvironment);
        if (!head) return fail(head.error().message);
        head_ = std::move(head.value());
        program_.leaveAlone(head_->process().pid());
        head_->send(toJson(run_.config));
        if (const auto failed = awaitReady()) return *failed;
        openPage();
        run_.programEnvironment.set("MURAL_NOTES", bypass_.notesPath());
        if (!startProgram(run_, program_, console_)) return launch::kExitNotExecutable;
        nextExamination_ = Deadline::inMs(kExaminationMs);
        uncapturedAt_ = Deadline::inMs(kUncapturedMs);
        whileRunning();
        finish();
        return endRequested_ ? 0 : wallLost_ ? kWallLost : auditFailed() ? kAuditFailed : program_.exitStatus();
    }

private:
    int fail(const std::string& text) {
        console_.error(text);
        return launch::kExitUsage;
    }

    // Returns nullopt when programs may connect, otherwise the exit status.
    std::optional<int> awaitReady() {
        const Deadline deadline = Deadline::inMs(2 * run_.config.startTimeoutMs + kBeyondStartMs);
        while (!ready_) {
            turn();
            if (failure_) return fail(*failure_);
            if (program_.stopSignal() != 0) return 128 + program_.stopSignal();
            if (!head_->connected() && !ready_) {
                head_->process().waitUntil(Deadline::inMs(1000));
                return fail("the head process ended before the session began (" + head_->process().describeEnd() +
                            "); see mural doctor");
            }
            if (deadline.passed())
                return fail("the render nodes were not ready in time; see mural doctor, or try --local-nodes 1");
        }
        return {};
    }

    void openPage() {
        if (run_.page.empty()) return;
        auto page = RunPage::start(run_.page);
        if (!page) return console_.error("--page: " + page.error().message);
        page_ = std::move(*page);
        program_.leaveAlone(page_->pid());
    }

    void whileRunning() {
        if (endRequested_) program_.end(kEndGraceMs); // the event arrived before the program was started
        while (program_.programRunning()) turn();
        if (endRequested_ || wallLost_ || program_.stopRequested()) {
            endDescendants();
            return;
        }
        awaitDescendants();
        if (run_.display) endDescendants(); // their private display ends with this process
    }

    // Waits for programs that have left their launcher. They are still descendants of this process.
    void awaitDescendants() {
        const Deadline noticeAt = Deadline::inMs(kWaitNoticeMs);
        Deadline until = Deadline::never();
        bool drawing = true;
        bool noticed = false;
        while (program_.anyoneLeft() && !program_.stopRequested()) {
            if (drawing && clients_ == 0) until = Deadline::inMs(everClients_ ? kAfterLastContextMs : kFirstContextMs);
            drawing = clients_ > 0;
            if (!drawing && until.passed()) return;
            if (!noticed && noticeAt.passed()) {
                console_.say("processes of the program are still running; waiting for them (Ctrl-C ends this)");
                noticed = true;
            }
            turn();
            if (endRequested_) return;
        }
    }

    void endDescendants() {
        program_.end(kEndGraceMs);
        const Deadline deadline = Deadline::inMs(2 * kEndGraceMs);
        while (program_.anyoneLeft() && !deadline.passed()) turn();
    }

    void finish() {
        finishing_ = true;
        const int signalBefore = program_.stopSignal();
        if (head_->connected()) head_->send(R"({"command":"finish"})");
        silenceUntil_ = Deadline::inMs(kFinishSilenceMs);
        while (head_->connected() && !report_) {
            turn();
            if (program_.stopSignal() != signalBefore) break; // the user has requested the end
            if (silenceUntil_.passed()) {
                console_.error("the head does not finish; it is stopped");
                break;
            }
        }
        if (report_) printReport();
    }

    [[nodiscard]] bool auditFailed() const {
        return report_ && std::ranges::any_of(report_->nodes, [](const NodeReport& n) { return n.culling.faults > 0; });
    }

    void printReport() {
        const std::string why = report_->frames > 0 || !bypassLines_.empty() ? std::string() : whyNoFrame();
        writeReport(run_, reportWithCapture(why), console_);
        for (const std::string& line : reportLines(*report_)) console_.say(line);
        reportUnsaved();
        if (!why.empty())
            console_.error((run_.config.nodeProgram.empty() ? "no frame was captured: " : "no frame was drawn: ") +
                           why);
    }

    // Returns the head's report with the findings about the capture, which the head does not know.
    [[nodiscard]] std::string reportWithCapture(const std::string& whyNoFrame) {
        nlohmann::json report = parseJson(report_->json);
        if (!report.is_object()) return report_->json;
        report["bypass"] = bypassLines_;
        report["noFrame"] = whyNoFrame;
        return jsonText(report);
    }

    void reportUnsaved() {
        const auto& wanted = run_.config.saveFrames; // in ascending order
        if (wanted.empty() || report_->frames == 0 || wanted.back() <= report_->frames) return;
        const auto first = std::upper_bound(wanted.begin(), wanted.end(), report_->frames);
        console_.error(fmt::format("--save: frame {} was not saved{}, because the program showed only {}", *first,
                                   std::next(first) == wanted.end() ? "" : ", nor the later ones", report_->frames));
    }

    std::string whyNoFrame() {
        const std::string& name = run_.program.front();
        if (!run_.config.nodeProgram.empty()) return whyNoNativeFrame(name);
        if (everClients_) return name + " created a GL context but showed no picture (no buffer swap)";
        const bool failed = program_.exitStatus() != 0 && !program_.stopRequested();
        if (std::string bypass = bypass_.describeEnded(failed); !bypass.empty()) {
            bypassLines_.push_back(bypass);
            return bypass;
        }
        if (failed)
            return name + " ended before it created a GL context (" + program_.describeEnd() +
                   "); its messages are above. Try it with mural run --native; mural doctor checks display and GL";
        return name + " made no GL calls through Mural; check that it is an OpenGL program, and that it keeps "
                      "LD_PRELOAD for its children";
    }

    [[nodiscard]] std::string whyNoNativeFrame(const std::string& name) const {
        if (program_.exitStatus() != 0 && !program_.stopRequested())
            return name + " ended before its first frame (" + program_.describeEnd() + "); its messages are above";
        if (everClients_) return name + " ended before its first frame";
        return name +
               " used no native API (mural::run or Session::open); options of Mural belong before the program: "
               "mural run --tiles 2x1 -- " +
               name;
    }

    // Reports programs that draw without the capture library: their own notes, and at most one line from an
    // examination.
    void watchBypass() {
        if (!run_.config.nodeProgram.empty()) return; // such a session captures no program
        for (const std::string& line : bypass_.newLines()) {
            console_.error(line);
            bypassLines_.push_back(line);
        }
        reportUncaptured();
        if (!nextExamination_.passed()) return;
        nextExamination_ = Deadline::inMs(kExaminationMs);
        if (everClients_ || !bypassLines_.empty()) return;
        const std::string line = bypass_.describeRunning(program_.processes());
        if (line.empty()) return;
        console_.error(line);
        bypassLines_.push_back(line);
    }

    // Reports processes that run without the capture library, such as children of a shell whose environment was
    // cleared.
    void reportUncaptured() {
        if (!uncapturedAt_.passed() || finishing_) return;
        uncapturedAt_ = Deadline::inMs(kUncapturedMs);
        const std::string line = bypass_.describeUncaptured(program_.processes());
        if (line.empty()) return;
        console_.error(line);
        bypassLines_.push_back(line);
    }

    void turn() {
        const bool wasConnected = head_->connected();
        waitTurn(run_, program_, wasConnected ? head_->fd() : -1);
        for (const std::string& line : head_->receive()) take(line);
        watchBypass();
        if (page_ && !finishing_ && head_->connected()) page_->watch(console_);
        if (wasConnected && !head_->connected() && ready_ && !report_) reportHeadLost();
    }

    void reportHeadLost() {
        clients_ = 0;
        head_->process().waitUntil(Deadline::inMs(500));
        console_.error("the head process was lost (" + head_->process().describeEnd() + "); " +
                       (finishing_                        ? "there is no report"
                        : run_.config.nodeProgram.empty() ? "the program continues alone, without the wall"
                                                          : "a program with the native API ends then"));
        endUncounted();
    }

    // Ends the program if --frames was given, because its frames are not counted any more.
    void endUncounted() {
        if (finishing_ || wallLost_ || run_.config.frames == 0) return;
        wallLost_ = true;
        console_.error("the head does not count frames any more (--frames); the program is stopped");
        program_.end(kEndGraceMs);
    }

    void take(const std::string& line) {
        silenceUntil_ = Deadline::inMs(kFinishSilenceMs);
        auto parsed = parseHeadEvent(line);
        if (!parsed) {
            console_.error(parsed.error().message);
            return;
        }
        const HeadEvent& event = parsed.value();
        switch (event.kind) {
        case HeadEvent::Kind::Ready:
            ready_ = true;
            if (run_.config.explain) {
                for (const std::string& text : event.explain) console_.error(text);
            }
            break;
        case HeadEvent::Kind::Error: failure_ = event.text; break;
        case HeadEvent::Kind::Clients:
            clients_ = event.clients;
            everClients_ = everClients_ || clients_ > 0;
            break;
        case HeadEvent::Kind::Frame: console_.progress(event.frame, event.framesPerSecond, event.bytesPerFrame); break;
        case HeadEvent::Kind::FramesReached:
        case HeadEvent::Kind::StopRequested:
            endRequested_ = true;
            program_.end(kEndGraceMs);
            break;
        case HeadEvent::Kind::JobOver:
            wallLost_ = true;
            program_.end(kEndGraceMs);
            break;
        case HeadEvent::Kind::WallLost: endUncounted(); break;
        case HeadEvent::Kind::Say: console_.error(event.text); break;
        case HeadEvent::Kind::Report: report_ = event.report; break;
        case HeadEvent::Kind::Unknown: break;
        }
    }

    PreparedRun& run_;
    Console& console_;
    launch::ProgramSupervisor& program_;
    launch::BypassWatch& bypass_;
    Deadline nextExamination_ = Deadline::never();
    Deadline uncapturedAt_ = Deadline::never();
    std::vector<std::string> bypassLines_; // reported
    std::unique_ptr<RunPage> page_;        // ends after the head
    std::unique_ptr<HeadControl> head_;
    bool ready_ = false;
    bool finishing_ = false;
    bool endRequested_ = false; // by the head: --frames is reached, or mural ctl stop
    bool wallLost_ = false;     // lost before the requested frames were shown
    bool everClients_ = false;
    int64_t clients_ = 0;
    std::optional<std::string> failure_;
    std::optional<SessionReport> report_;
    Deadline silenceUntil_ = Deadline::never();
};

} // namespace

int runSession(PreparedRun& run, Console& console) {
    const PauseWatch pauseWatch;
    auto program = launch::ProgramSupervisor::create();
    if (!program) {
        console.error(program.error().message);
        return launch::kExitUsage;
    }
    auto bypass = launch::BypassWatch::create();
    if (!bypass) {
        console.error(bypass.error().message);
        return launch::kExitUsage;
    }
    if (run.display) program.value()->leaveAlone(run.display->pid());
    return Session(run, console, *program.value(), *bypass.value()).perform();
}

} // namespace mural::cli
