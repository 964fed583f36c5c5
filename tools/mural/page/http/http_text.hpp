// Responses, queries and numbers of the page's HTTP interface. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "tools/mural/page/http/page_numbers.hpp"
#include "tools/mural/page/http/page_site.hpp"

namespace mural::page {

[[nodiscard]] HttpResponse textResponse(unsigned status, std::string_view line);
[[nodiscard]] HttpResponse jsonResponse(unsigned status, const nlohmann::json& value);
// Returns the reply with the status that belongs to its code.
[[nodiscard]] HttpResponse replyResponse(const nlohmann::json& reply);
// status: of the session; null: not asked. {"status": "pass", "checks": {…}}
[[nodiscard]] HttpResponse healthResponse(bool isAlive, const nlohmann::json* status);
// Returns the metrics of the page itself.
[[nodiscard]] std::string pageMetrics(const PageHub::Numbers& numbers, const std::string& session, bool isHeadThere);

// Returns a number of a query such as "w=640&q=80", or the value for a missing one.
[[nodiscard]] std::optional<int> numberIn(std::string_view query, std::string_view name, int missing, int least,
                                          int most);
// Returns N of "nodes/N/log".
[[nodiscard]] std::optional<int> nodeOfLogPath(std::string_view path);
// Returns a discarded value for invalid JSON, and for values that nest too deep.
[[nodiscard]] nlohmann::json parseShallowJson(std::string_view text);

} // namespace mural::page
