#include "tools/mural/app_report/output/report_json.hpp"

#include "tools/mural/commands.hpp"

namespace mural::cli {

nlohmann::json jsonOf(const AppReport& report) {
    nlohmann::json sections = nlohmann::json::object();
    for (const Section& s : report.sections) {
        nlohmann::json facts = nlohmann::json::object();
        for (const Fact& f : s.facts)
            facts[f.key] = {{"label", f.label}, {"value", f.value}, {"text", f.text}, {"advice", f.advice}};
        sections[s.key] = {{"title", s.title}, {"facts", facts}};
    }
    return {{"appReport", 1},
            {"mural", muralVersion()},
            {"program", report.program},
            {"verdict", nameOf(report.verdict)},
            {"sentence", report.sentence},
            {"recommended", report.recommended},
            {"sections", sections},
            {"runs", report.runs}};
}

} // namespace mural::cli
