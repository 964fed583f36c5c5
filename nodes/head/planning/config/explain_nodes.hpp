// The lines of --explain about the nodes of a plan. Pure.
#pragma once

#include <string>
#include <vector>

#include "nodes/head/planning/config/config_source.hpp"
#include "nodes/head/planning/node_plan.hpp"

namespace mural {

// Returns "[ x y w h ]", with up to nine digits.
[[nodiscard]] std::string bracketed(const Viewport& v);

// Adds one line per node. channels: drawing channel per node. nodesBefore: number of nodes of earlier canvases.
void explainNodes(const ConfigSource& source, const std::vector<compound::Index>& channels, int nodesBefore,
                  SessionPlan& plan);

} // namespace mural
