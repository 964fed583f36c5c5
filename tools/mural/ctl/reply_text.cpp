#include "tools/mural/ctl/reply_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/mural/ctl/control_client.hpp"
#include "tools/mural/stat/session_rates.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

constexpr int kMaxIndent = 16; // deeper values are printed as JSON

bool isScalar(const Json& value) { return !value.is_object() && !value.is_array(); }

std::string scalarText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_null()) return "none";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    return jsonLine(value);
}

void addMember(const std::string& name, const Json& value, int indent, std::vector<std::string>& lines);

void addMembers(const Json& object, int indent, std::vector<std::string>& lines) {
    size_t width = 0;
    for (const auto& [name, value] : object.items())
        if (isScalar(value)) width = std::max(width, name.size());
    for (const auto& [name, value] : object.items()) {
        if (isScalar(value))
            lines.push_back(fmt::format("{:{}}{:{}}  {}", "", indent, name, width, scalarText(value)));
        else
            addMember(name, value, indent, lines);
    }
}

void addMember(const std::string& name, const Json& value, int indent, std::vector<std::string>& lines) {
    const bool isPlain = value.is_array() && std::ranges::all_of(value, isScalar);
    if (isPlain || indent >= kMaxIndent) {
        lines.push_back(fmt::format("{:{}}{}  {}", "", indent, name, value.empty() ? "none" : jsonLine(value)));
        return;
    }
    if (value.is_object()) {
        lines.push_back(fmt::format("{:{}}{}", "", indent, name));
        return addMembers(value, indent + 2, lines);
    }
    size_t number = 0;
    for (const Json& entry : value) {
        lines.push_back(fmt::format("{:{}}{} {}", "", indent, name, number++));
        if (entry.is_object())
            addMembers(entry, indent + 2, lines);
        else
            lines.push_back(fmt::format("{:{}}{}", "", indent + 2, jsonLine(entry)));
    }
}

std::vector<std::string> helpLines(const Json& operations) {
    std::vector<std::pair<std::string, std::string>> rows;
    size_t width = 0;
    for (const Json& operation : operations) {
        rows.emplace_back(textOf(operation, "usage"), textOf(operation, "meaning"));
        width = std::max(width, rows.back().first.size());
    }
    std::ranges::sort(rows);
    std::vector<std::string> lines;
    for (const auto& [usage, meaning] : rows) lines.push_back(fmt::format("{:{}}  {}", usage, width, meaning));
    return lines;
}

} // namespace

std::vector<std::string> replyLines(const std::string& operation, const Json& result) {
    std::vector<std::string> lines;
    if (operation == "status" && result.is_object()) return statLines(result);
    if (operation == "nodes" && result.is_object()) return nodeLines(result);
    if (operation == "help" && result.is_object()) return helpLines(memberOf(result, "operations"));
    if (result.is_object())
        addMembers(result, 0, lines);
    else
        lines.push_back(jsonLine(result));
    return lines;
}

} // namespace mural::cli
