#include "tools/mural/app_report/capture_facts.hpp"

#include <fmt/format.h>

#include "streamcodec/command_table.hpp"
#include "tools/mural/console.hpp"

namespace mural::cli {

namespace {

constexpr std::string_view kCapturePrefix = "capture: "; // of a line of mural run --explain

std::vector<std::string> wordsOf(const std::set<std::string>& names) { return {names.begin(), names.end()}; }

std::string endText(const AppRun& run) {
    if (!run.performed()) return "not performed: " + run.skipped;
    const BoundedOutcome& o = run.outcome;
    if (o.endedItself) return fmt::format("{} after {:.1f} s", o.end, o.seconds);
    return fmt::format("still ran after {:.1f} s and was ended{}", o.seconds, o.killed ? " by SIGKILL" : "");
}

nlohmann::json endJson(const AppRun& run) {
    if (!run.performed()) return nullptr;
    return {{"endedItself", run.outcome.endedItself},
            {"exitStatus", run.outcome.endedItself ? nlohmann::json(run.outcome.exitStatus) : nlohmann::json()},
            {"seconds", run.outcome.seconds}};
}

void addUnsupported(const AppRun& run, Section& s) {
    const double calls = run.number("callsUnsupported");
    s.add("unsupportedCalls", "calls of unsupported commands", calls, fmt::format("{:.0f}", calls),
          calls > 0 ? "the program's own GL alone executes them; the pictures of the nodes may lack their effect" : "");
    const auto counts = run.report.find("callsUnsupportedBy");
    if (counts == run.report.end() || !counts->is_object()) return;
    for (const auto& [name, count] : counts->items()) {
        if (!count.is_number()) continue;
        const CommandInfo* command = findCommand(name);
        s.add("unsupported." + name, name, count.get<double>(),
              fmt::format("{:.0f} call{}", count.get<double>(), count == 1 ? "" : "s"),
              command && *command->reason ? command->reason : "no reason is known");
    }
}

} // namespace

std::string listText(const std::vector<std::string>& names, size_t most) {
    std::string text;
    for (size_t i = 0; i < names.size() && i < most; ++i) text += (text.empty() ? "" : ", ") + names[i];
    if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
    return text;
}

Section captureFacts(const AppMeasured& m) {
    Section s{"capture", "Program", {}};
    std::string via = m.tiles.frames() > 0 ? "GLVND" : "";
    for (const std::string& line : m.tiles.outcome.messages)
        if (line.starts_with(kCapturePrefix)) via = line.substr(kCapturePrefix.size());
    if (!via.empty()) s.add("entry", "captured through", via, via);
    std::vector<std::string> contexts;
    for (const auto& [name, count] : m.trace.contexts)
        contexts.push_back(fmt::format("{} ({} context{})", name, count, count == 1 ? "" : "s"));
    if (!contexts.empty()) s.add("contexts", "GL of its contexts", m.trace.contexts, listText(contexts));
    if (!m.seen.interfaces.empty())
        s.add("interfaces", "loaded interfaces", m.seen.interfaces, listText(wordsOf(m.seen.interfaces)));
    if (!m.seen.toolkits.empty()) s.add("toolkits", "toolkits", m.seen.toolkits, listText(wordsOf(m.seen.toolkits)));
    if (m.seen.processes > 0) {
        s.add("processes", "processes", m.seen.processes,
              fmt::format("{} at most: {}", m.seen.processes, listText(wordsOf(m.seen.programs))));
        s.add("threads", "threads", m.seen.threads,
              fmt::format("{} at most, with those of the driver", m.seen.threads));
        s.add("inetSockets", "network", m.seen.inetSockets,
              m.seen.inetSockets == 0 ? "no IP socket" : fmt::format("{} IP sockets at most", m.seen.inetSockets));
        s.add("seccomp", "filter of system calls", m.seen.filtersSystemCalls, m.seen.filtersSystemCalls ? "yes" : "no");
    }
    if (!m.trace.windowSizes.empty()) {
        std::vector<std::string> sizes;
        for (const auto& [w, h] : m.trace.windowSizes) sizes.push_back(fmt::format("{}x{}", w, h));
        s.add("windowSizes", "sizes of its windows", sizes, listText(sizes),
              sizes.size() == 1 && m.size.empty()
                  ? "--size WxH shows it at the wall's size, if the program can be resized"
                  : "");
    }
    if (!m.trace.nodesGl.empty()) s.add("nodesGl", "GL of the render nodes here", m.trace.nodesGl, m.trace.nodesGl);
    return s;
}

Section commandFacts(const AppMeasured& m) {
    Section s{"commands", "Commands", {}};
    if (!m.tiles.report.is_object()) return s;
    int64_t calls = 0;
    for (const auto& [name, count] : m.trace.calls) calls += count;
    const double frames = std::max<double>(1, static_cast<double>(m.trace.frames));
    s.add(
        "used", "commands in use", m.trace.calls.size(),
        fmt::format("{} commands, {:.0f} calls per frame", m.trace.calls.size(), static_cast<double>(calls) / frames));
    s.add("callsPerFrame", "calls per frame", static_cast<double>(calls) / frames,
          fmt::format("{:.1f}", static_cast<double>(calls) / frames));
    addUnsupported(m.tiles, s);
    s.add("hiddenExtensions", "extensions of this GL that Mural hides", m.hiddenExtensions,
          m.hiddenExtensions.empty() ? "none" : listText(m.hiddenExtensions));
    return s;
}

Section endFacts(const AppMeasured& m) {
    Section s{"ends", "Ends and output", {}};
    for (const AppRun* run : {&m.native, &m.tiles, &m.balance, &m.db})
        s.add(run->name, run->name == "native" ? "without Mural" : "with --" + run->name, endJson(*run), endText(*run));
    if (m.native.performed())
        s.add("outputBytes", "printed without Mural", m.native.outcome.outputBytes,
              sizeText(static_cast<double>(m.native.outcome.outputBytes)));
    if (!m.native.outcome.lastWords.empty() && m.native.outcome.exitStatus != 0 && m.native.outcome.endedItself)
        s.add("lastWords", "last lines without Mural", m.native.outcome.lastWords,
              listText(m.native.outcome.lastWords));
    return s;
}

} // namespace mural::cli
