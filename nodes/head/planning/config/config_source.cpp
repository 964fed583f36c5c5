#include "nodes/head/planning/config/config_source.hpp"

namespace mural {

std::string ConfigSource::lineOf(const config::SourcePosition& position) const {
    return file + ":" + std::to_string(position.line);
}

std::string ConfigSource::placeOf(compound::Index compound) const {
    const config::SourcePosition& there = config.compounds[config::at(compound)].at;
    return lineOf(there) + ":" + std::to_string(there.column);
}

std::string ConfigSource::channelName(compound::Index channel) const {
    const std::string& name = config.channels[config::at(channel)].name;
    return name.empty() ? "channel " + std::to_string(channel) : name;
}

} // namespace mural
