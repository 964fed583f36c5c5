// The fields of a session's configuration that divide the work, as JSON. They may change while the session runs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.hpp"
#include "nodes/session/session_config.hpp"

namespace mural {

nlohmann::json planFieldsOf(const SessionConfig& config);
// Returns the configuration with these fields. Errors: another name; a value of another type, or out of range.
Result<SessionConfig> withPlanFields(const SessionConfig& config, const nlohmann::json& fields);

} // namespace mural
