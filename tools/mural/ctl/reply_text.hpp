// The result of an operation as lines for a person. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace mural::cli {

// status and nodes: as in `mural stat`; help: one line per operation; others: one line per member.
std::vector<std::string> replyLines(const std::string& operation, const nlohmann::json& result);

} // namespace mural::cli
