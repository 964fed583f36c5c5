#include "tools/mural/hosts/hosts_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace mural::cli {

namespace {

constexpr size_t kMaxColumns = 34; // a longer text is in the findings, or in --json

const Check* checkOf(const HostChecks& host, const std::string& name) {
    const auto found = std::ranges::find_if(host.checks, [&](const Check& c) { return c.name == name; });
    return found == host.checks.end() ? nullptr : &*found;
}

// Checks whose values always differ, and matter only if they are findings.
bool variesAlways(const std::string& name) {
    static const std::set<std::string> kNames{
        "connection from it", "rate to it", "rate from it", "clock", "disk", "memory"};
    return kNames.contains(name);
}

// In the order of the first host that has them.
std::vector<std::string> rowsOf(const std::vector<HostChecks>& hosts) {
    std::vector<std::string> names;
    for (const HostChecks& h : hosts)
        for (const Check& c : h.checks)
            if (std::ranges::find(names, c.name) == names.end()) names.push_back(c.name);
    return names;
}

bool isInteresting(const std::vector<HostChecks>& hosts, const std::string& name) {
    std::set<std::string> values;
    for (const HostChecks& h : hosts) {
        const Check* c = checkOf(h, name);
        if (c && c->health != Health::Ok) return true;
        if (c) values.insert(c->found);
    }
    return values.size() > 1 && !variesAlways(name);
}

std::string cellOf(const Check* c) {
    if (!c) return "-";
    std::string text = c->found;
    if (text.size() > kMaxColumns) text = text.substr(0, kMaxColumns - 3) + "...";
    return (c->health == Health::Bad ? "BAD " : c->health == Health::Warn ? "warn " : "") + text;
}

} // namespace

std::string tableOf(const std::vector<HostChecks>& hosts, bool all) {
    std::vector<std::vector<std::string>> rows{{"check"}};
    for (const HostChecks& h : hosts) rows.front().push_back(h.host);
    for (const std::string& name : rowsOf(hosts)) {
        if (!all && !isInteresting(hosts, name)) continue;
        rows.push_back({name});
        for (const HostChecks& h : hosts) rows.back().push_back(cellOf(checkOf(h, name)));
    }
    if (rows.size() == 1) return {};
    std::vector<size_t> widths(hosts.size() + 1);
    for (const auto& row : rows)
        for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string findingsOf(const std::vector<HostChecks>& hosts) {
    std::string text;
    for (const Health health : {Health::Bad, Health::Warn})
        for (const HostChecks& h : hosts)
            for (const Check& c : h.checks)
                if (c.health == health)
                    text += fmt::format("{:<5}{}: {}: {}{}\n", health == Health::Bad ? "bad" : "warn", h.host, c.name,
                                        c.found, c.advice.empty() ? "" : " -> " + c.advice);
    return text;
}

} // namespace mural::cli
