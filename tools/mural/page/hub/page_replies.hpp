// Texts and replies of the page's hub. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/base/result.hpp"

namespace mural::page {

// Returns {"ok": false, "code": …, "error": …}.
[[nodiscard]] nlohmann::json failureOf(const std::string& code, const std::string& error);
// Returns {"ok": true, "result": …}, or the failure with the code bad-argument.
[[nodiscard]] nlohmann::json replyOf(const Result<nlohmann::json>& result);
// Returns the limits of the page for viewers.
[[nodiscard]] nlohmann::json limitsJson();
// Returns the line of an entry of the topics log and events; empty: it is not for people.
[[nodiscard]] std::string logLineOf(const nlohmann::json& entry);
// Returns whether the line contains "node N" for this number.
[[nodiscard]] bool namesNode(const std::string& line, int node);
// Appends the operations of the page to those of the head, for `help`.
void addOwnOperations(nlohmann::json& operations);

} // namespace mural::page
