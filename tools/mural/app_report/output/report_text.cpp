#include "tools/mural/app_report/output/report_text.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace mural::cli {

std::string programText(const AppReport& report) {
    std::string text;
    for (const std::string& word : report.program) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string textOf(const AppReport& report) {
    std::string text =
        fmt::format("program  {}\nverdict  {}: {}\n", programText(report), nameOf(report.verdict), report.sentence);
    if (!report.recommended.empty()) text += "use      " + report.recommended + "\n";
    size_t columns = 0;
    for (const Section& s : report.sections)
        for (const Fact& f : s.facts) columns = std::max(columns, f.label.size());
    for (const Section& s : report.sections) {
        text += "\n" + s.title + "\n";
        for (const Fact& f : s.facts)
            text +=
                fmt::format("  {:<{}}  {}{}\n", f.label, columns, f.text, f.advice.empty() ? "" : " -> " + f.advice);
    }
    return text;
}

} // namespace mural::cli
