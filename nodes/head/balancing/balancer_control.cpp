#include "nodes/head/balancing/balancer_control.hpp"

#include <nlohmann/json.hpp>

#include "nodes/head/session/session_report.hpp"

namespace mural {

nlohmann::json BalancerControl::list() const { return equalizersJson(current_()->totals()); }

} // namespace mural
