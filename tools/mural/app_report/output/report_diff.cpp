#include "tools/mural/app_report/output/report_diff.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace mural::cli {

namespace {

using nlohmann::json;

constexpr double kSameShare = 0.1;

struct Entry {
    json value;
    std::string text;
};

std::map<std::string, Entry> entriesOf(const json& report) {
    std::map<std::string, Entry> entries;
    for (const char* name : {"verdict", "recommended"})
        if (report.contains(name) && report[name].is_string())
            entries[name] = {report[name], report[name].get<std::string>()};
    const auto sections = report.find("sections");
    if (sections == report.end() || !sections->is_object()) return entries;
    for (const auto& [section, contents] : sections->items()) {
        if (section == "ends" || !contents.is_object() || !contents.contains("facts")) continue; // durations
        for (const auto& [key, fact] : contents["facts"].items()) {
            if (!fact.is_object()) continue;
            const bool hasText = fact.contains("text") && fact["text"].is_string();
            entries[section + "." + key] = {fact.value("value", json()),
                                            hasText ? fact["text"].get<std::string>() : ""};
        }
    }
    return entries;
}

bool same(const json& a, const json& b) {
    if (!a.is_number() || !b.is_number()) {
        // Counts of compared pixels vary; a difference of pixels does not.
        if (a.is_object() && a.contains("differing") && b.is_object() && b.contains("differing"))
            return (a["differing"] == 0) == (b["differing"] == 0);
        return a == b;
    }
    const double x = a.get<double>(), y = b.get<double>();
    return x == y || std::abs(x - y) <= kSameShare * std::max(std::abs(x), std::abs(y));
}

std::string changeText(const Entry& a, const Entry& b) {
    std::string text = a.text + " => " + b.text;
    if (!a.value.is_number() || !b.value.is_number() || a.value.get<double>() == 0) return text;
    return text + fmt::format(" ({:+.0f} %)", 100 * (b.value.get<double>() / a.value.get<double>() - 1));
}

} // namespace

Result<std::vector<std::string>> differencesOf(const json& first, const json& second) {
    for (const auto& [report, which] : {std::pair{&first, "first"}, std::pair{&second, "second"}})
        if (!report->is_object() || !report->contains("appReport"))
            return Error{std::string("the ") + which +
                         " file is no report of mural app-report --json; give two such files"};
    const auto a = entriesOf(first), b = entriesOf(second);
    std::vector<std::string> lines;
    for (const auto& [name, entry] : a) {
        const auto other = b.find(name);
        if (other == b.end())
            lines.push_back(name + ": " + entry.text + " => absent");
        else if (!same(entry.value, other->second.value))
            lines.push_back(name + ": " + changeText(entry, other->second));
    }
    for (const auto& [name, entry] : b)
        if (!a.contains(name)) lines.push_back(name + ": absent => " + entry.text);
    return lines;
}

} // namespace mural::cli
