#include "tools/mural/doctor/check_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace mural::cli {

namespace {

constexpr size_t kMinNameColumns = 17;

const char* word(Health health) {
    switch (health) {
    case Health::Ok: return "ok";
    case Health::Warn: return "warn";
    case Health::Bad: return "bad";
    }
    return "bad";
}

} // namespace

void printChecks(const std::vector<Check>& checks) {
    size_t columns = kMinNameColumns;
    for (const Check& c : checks) columns = std::max(columns, c.name.size() + 1);
    for (const Check& c : checks)
        fmt::print("{:<5}{:<{}}{}{}{}\n", word(c.health), c.name, columns, c.found, c.advice.empty() ? "" : " -> ",
                   c.advice);
}

nlohmann::json toJson(const std::vector<Check>& checks) {
    nlohmann::json list = nlohmann::json::array();
    for (const Check& c : checks)
        list.push_back({{"health", word(c.health)}, {"name", c.name}, {"found", c.found}, {"advice", c.advice}});
    return list;
}

bool usable(const std::vector<Check>& checks) {
    return std::ranges::none_of(checks, [](const Check& c) { return c.health == Health::Bad; });
}

} // namespace mural::cli
