// Sections of a configuration's drawing. Each draws itself from a given corner and returns its size.
#pragma once

#include "balancer/config/resolved_config.hpp"
#include "balancer/svg/svg.hpp"

namespace mural::drawing {

using config::at;
using config::Index;
using config::kNone;
using config::ResolvedConfig;

inline constexpr double kGap = 14;

Box drawDisplays(Svg& svg, const ResolvedConfig& config, Point corner, double width);
Box drawMachines(Svg& svg, const ResolvedConfig& config, Point corner, double width);
Box drawCompounds(Svg& svg, const ResolvedConfig& config, Point corner, double width);

// Colour of the machine of a channel, or of its GPU: strong for lines, pale for areas.
std::string colorOf(const ResolvedConfig& config, Index channel);
std::string paleColorOf(const ResolvedConfig& config, Index channel);
Index colorIndex(const ResolvedConfig& config, Index pipe);
std::string nodeColor(Index node);
std::string paleNodeColor(Index node);

// Returns the name, or a numbered substitute for an empty one.
std::string nameOr(const std::string& name, std::string_view otherwise, size_t number);
std::string nodeName(const ResolvedConfig& config, Index node);

} // namespace mural::drawing
