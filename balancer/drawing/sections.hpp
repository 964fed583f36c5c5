// The parts of a configuration's picture. Each draws itself from a corner on and says how much room it took.
#pragma once

#include "balancer/config/resolved_config.hpp"
#include "balancer/drawing/svg.hpp"

namespace mural::drawing {

using config::at;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

inline constexpr double kGap = 14;

Box drawDisplays(Svg& svg, const ResolvedConfig& config, Point corner, double width);
Box drawMachines(Svg& svg, const ResolvedConfig& config, Point corner, double width);
Box drawCompounds(Svg& svg, const ResolvedConfig& config, Point corner, double width);

// Of the machine that a channel belongs to, or of its GPU: a strong colour for lines, a pale one for areas.
std::string colorOf(const ResolvedConfig& config, Index channel);
std::string paleColorOf(const ResolvedConfig& config, Index channel);
Index colorIndex(const ResolvedConfig& config, Index pipe);
std::string nodeColor(Index node);
std::string paleNodeColor(Index node);

// What to call something without a name.
std::string nameOr(const std::string& name, std::string_view otherwise, size_t number);
std::string nodeName(const ResolvedConfig& config, Index node);

} // namespace mural::drawing
