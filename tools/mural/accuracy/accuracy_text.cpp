#include "tools/mural/accuracy/accuracy_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "nodes/launch/program_check.hpp"

namespace mural::cli {

namespace {

// Counts characters, not bytes.
size_t lengthOf(const std::string& text) {
    return static_cast<size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, size_t width, bool right) {
    const std::string space(width - std::min(width, lengthOf(text)), ' ');
    return right ? space + text : text + space;
}

std::vector<std::string> cellsOf(const AccuracyRow& row) {
    const auto psnr = row.error.psnr();
    return {"  " + row.what,
            row.reference,
            spaced(row.error.pixels),
            spaced(row.error.differing),
            fmt::format("{:.3g}", row.error.largest),
            psnr ? fmt::format("{:.1f}", *psnr) : "∞",
            row.cost ? fmt::format("{:.3g}", row.cost->cpuNs) : "",
            row.cost ? fmt::format("{:.3g}", row.cost->bytes) : "",
            row.bound.text(),
            row.holds() ? "ok" : "BROKEN"};
}

} // namespace

bool AccuracyReport::holds() const {
    return !rows.empty() && std::ranges::all_of(rows, [](const AccuracyRow& r) { return r.holds(); });
}

AccuracyCounts AccuracyReport::counts() const {
    AccuracyCounts counts;
    for (const AccuracyRow& row : rows) {
        ++(row.failure.empty() ? counts.measured : counts.failed);
        if (row.failure.empty() && !row.holds()) ++counts.broken;
    }
    return counts;
}

int AccuracyReport::exitStatus() const {
    if (counts().measured == 0) return launch::kExitUsage;
    return holds() ? 0 : 1;
}

std::string spaced(int64_t number) {
    std::string text = std::to_string(number);
    for (auto at = static_cast<int64_t>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<size_t>(at), " ");
    return text;
}

std::string tableOf(const AccuracyReport& report) {
    std::vector<std::vector<std::string>> lines{
        {"  what", "against", "pixels", "differ", "largest of 255", "PSNR dB", "ns/pixel", "bytes/pixel", "bound", ""}};
    for (const AccuracyRow& row : report.rows)
        if (row.failure.empty()) lines.push_back(cellsOf(row));
    std::vector<size_t> widths(lines[0].size(), 0);
    for (const auto& line : lines)
        for (size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], lengthOf(line[c]));
    const auto print = [&](const std::vector<std::string>& line) {
        std::string text;
        for (size_t c = 0; c < line.size(); ++c)
            text += padded(line[c], widths[c], c >= 2 && c <= 7) + (c + 1 < line.size() ? "  " : "\n");
        text.erase(text.find_last_not_of(" \n") + 1);
        return text + "\n";
    };
    std::string text = report.subject + (report.gl.empty() ? "" : "\n" + report.gl) + "\n\n" + print(lines[0]);
    std::string group;
    size_t line = 1;
    for (const AccuracyRow& row : report.rows) {
        if (row.group != group) text += (group = row.group) + "\n";
        text += row.failure.empty() ? print(lines[line++]) : "  " + row.what + ": FAILED: " + row.failure + "\n";
    }
    const AccuracyCounts counts = report.counts();
    return text + fmt::format("\n{} measured, {} broken, {} failed\n", counts.measured, counts.broken, counts.failed);
}

std::string jsonOf(const AccuracyReport& report) {
    nlohmann::ordered_json all{{"subject", report.subject},
                               {"gl", report.gl},
                               {"holds", report.holds()},
                               {"rows", nlohmann::ordered_json::array()}};
    for (const AccuracyRow& row : report.rows) {
        nlohmann::ordered_json j{{"group", row.group},
                                 {"what", row.what},
                                 {"reference", row.reference},
                                 {"pixels", row.error.pixels},
                                 {"differingPixels", row.error.differing},
                                 {"largest", row.error.largest},
                                 {"rootMeanSquare", row.error.rootMeanSquare()}};
        j["psnr"] = row.error.psnr() ? nlohmann::ordered_json(*row.error.psnr()) : nlohmann::ordered_json();
        nlohmann::ordered_json bound = nlohmann::ordered_json::object();
        if (row.bound.differingShare) bound["differingShare"] = *row.bound.differingShare;
        if (row.bound.largest) bound["largest"] = *row.bound.largest;
        if (row.bound.psnr) bound["psnr"] = *row.bound.psnr;
        j["bound"] = bound;
        j["holds"] = row.holds();
        if (row.cost) {
            j["cpuNsPerPixel"] = row.cost->cpuNs;
            j["bytesPerPixel"] = row.cost->bytes;
        }
        if (!row.failure.empty()) j["failure"] = row.failure;
        all["rows"].push_back(j);
    }
    return jsonText(all, 1) + "\n";
}

} // namespace mural::cli
