#include "tools/mural/app_report/judge.hpp"

#include <fmt/format.h>

#include "tools/mural/app_report/capture_facts.hpp"
#include "tools/mural/app_report/division_facts.hpp"
#include "tools/mural/app_report/traffic_facts.hpp"

namespace mural::cli {

namespace {

constexpr int kFirstSignalStatus = 129; // 128 + signal, as in a shell

std::string textIn(const AppRun& run, const char* field) {
    return run.report.is_object() ? run.report.value(field, "") : std::string();
}

std::string lastWords(const AppRun& run) {
    return run.outcome.lastWords.empty() ? std::string() : "; it printed: " + run.outcome.lastWords.back();
}

// The lines about programs that draw without the capture library.
std::string bypassText(const AppRun& run) {
    if (!run.report.is_object()) return {};
    const auto lines = run.report.find("bypass");
    return lines != run.report.end() && lines->is_array() && !lines->empty() && lines->front().is_string()
               ? lines->front().get<std::string>()
               : std::string();
}

bool failed(const AppRun& run) { return run.performed() && run.outcome.endedItself && run.outcome.exitStatus != 0; }
bool crashed(const AppRun& run) { return failed(run) && run.outcome.exitStatus >= kFirstSignalStatus; }

std::string endOf(const AppRun& run) {
    return run.outcome.exitStatus >= kFirstSignalStatus
               ? fmt::format("signal {}", run.outcome.exitStatus - kFirstSignalStatus + 1)
               : fmt::format("exit status {}", run.outcome.exitStatus);
}

// The program showed no picture through Mural.
Judgement judgeWithoutFrames(const AppMeasured& m) {
    const std::string bypass = bypassText(m.tiles).empty() ? m.bypassSeen : bypassText(m.tiles);
    if (!bypass.empty()) return {Verdict::Alone, bypass};
    if (crashed(m.native))
        return {Verdict::NotCapturable,
                "it crashes without Mural too (" + endOf(m.native) + ") before a picture" + lastWords(m.native)};
    if (failed(m.native))
        return {Verdict::NotCapturable,
                "it fails without Mural too (" + endOf(m.native) + ") before a picture" + lastWords(m.native)};
    if (!m.tiles.report.is_object() && !m.tiles.outcome.endedItself)
        return {Verdict::NotCapturable, "the session was not ready in time on this machine; see mural doctor"};
    if (!m.tiles.report.is_object()) // mural run could not start it
        return {Verdict::NotCapturable, m.tiles.outcome.messages.empty()
                                            ? "mural run could not start it, " + endOf(m.tiles)
                                            : m.tiles.outcome.messages.back()};
    if (m.native.performed() && !m.native.outcome.endedItself && m.native.frames() == 0)
        return {Verdict::NotCapturable,
                fmt::format("it showed no picture through GL within {:.0f} s{}{}; it may wait for input, a file or a "
                            "network, or draw nothing",
                            m.seconds, m.seen.inetSockets > 0 ? ", and has IP sockets" : "", lastWords(m.native))};
    const std::string why = textIn(m.tiles, "noFrame");
    return {Verdict::NotCapturable, why.empty() ? "no frame was captured" : why};
}

// A difference of the program's behaviour; empty: none.
std::string differentEnd(const AppMeasured& m) {
    if (!m.native.performed()) return {};
    const BoundedOutcome &native = m.native.outcome, &tiles = m.tiles.outcome;
    if (crashed(m.tiles) && !crashed(m.native))
        return "it ends with " + endOf(m.tiles) + " on Mural, but not without it";
    if (native.endedItself && tiles.endedItself && native.exitStatus != tiles.exitStatus)
        return fmt::format("it ends with {} on Mural and {} without it", endOf(m.tiles), endOf(m.native));
    return {};
}

std::string quoted(const std::string& word) {
    if (!word.empty() && word.find_first_of(" \t\"'\\$`*?[]()<>|&;!#~") == std::string::npos) return word;
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

nlohmann::json runJson(const AppRun& run) {
    if (!run.performed()) return {{"name", run.name}, {"skipped", run.skipped}};
    const BoundedOutcome& o = run.outcome;
    return {{"name", run.name},
            {"options", run.options},
            {"endedItself", o.endedItself},
            {"killed", o.killed},
            {"exitStatus", o.exitStatus},
            {"seconds", o.seconds},
            {"outputBytes", o.outputBytes},
            {"messages", o.messages},
            {"lastWords", o.lastWords},
            {"report", run.report}};
}

} // namespace

const char* nameOf(Verdict verdict) {
    switch (verdict) {
    case Verdict::Exact: return "works, exact";
    case Verdict::Differences: return "works, with differences";
    case Verdict::Alone: return "runs alone";
    case Verdict::NotCapturable: break;
    }
    return "not capturable";
}

int exitStatusOf(Verdict verdict) { return verdict == Verdict::Exact ? 0 : verdict == Verdict::Differences ? 1 : 2; }

Judgement judge(const AppMeasured& m) {
    if (!m.refused.empty()) return {Verdict::NotCapturable, m.refused};
    if (m.tiles.frames() == 0) return judgeWithoutFrames(m);
    if (m.tiles.number("differingPixels") > 0) return {Verdict::Differences, comparisonText(m.tiles)};
    if (m.tiles.number("verifiedPixels") == 0)
        return {Verdict::Differences, "its frames could not be compared: " + comparisonText(m.tiles)};
    if (std::string end = differentEnd(m); !end.empty()) return {Verdict::Differences, end};
    if (const std::string bypass = bypassText(m.tiles); !bypass.empty()) return {Verdict::Differences, bypass};
    return {Verdict::Exact, comparisonText(m.tiles)};
}

std::string recommendedCommand(const AppMeasured& m, Verdict verdict) {
    if (verdict == Verdict::Alone || verdict == Verdict::NotCapturable) return {};
    std::string line = "mural run ";
    line += tilesMove(m) ? "--balance auto" : "--tiles 2x2";
    line += " --nodes HOST1,HOST2 --display windows --";
    for (const std::string& word : m.program) line += " " + quoted(word);
    return line;
}

AppReport makeReport(const AppMeasured& m) {
    AppReport report;
    report.program = m.program;
    Judgement judgement = judge(m);
    report.verdict = judgement.verdict;
    report.sentence = std::move(judgement.sentence);
    report.recommended = recommendedCommand(m, report.verdict);
    for (Section& section : std::vector{captureFacts(m), commandFacts(m), divisionFacts(m), roundTripFacts(m),
                                        trafficFacts(m), speedFacts(m), endFacts(m)})
        if (!section.facts.empty()) report.sections.push_back(std::move(section));
    for (const AppRun* run : {&m.native, &m.tiles, &m.balance, &m.db}) report.runs.push_back(runJson(*run));
    report.nativePicture = m.nativePicture;
    report.wallPicture = m.wallPicture;
    return report;
}

} // namespace mural::cli
