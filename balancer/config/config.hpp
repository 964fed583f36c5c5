// A configuration as a file says it: nothing is resolved, what is not said has no value.
#pragma once

#include <map>

#include "balancer/config/compound_model.hpp"
#include "balancer/config/resources.hpp"

namespace mural::config {

// The value of a global attribute; which of them is meant follows from its name.
using GlobalValue = std::variant<int32_t, double, std::string, char, ColorMask, ConnectionType>;
using Globals = std::map<std::string, GlobalValue>;

struct ConfigAttributes {
    std::optional<double> eyeBase; // metres
    Attribute robustness;
    friend bool operator==(const ConfigAttributes&, const ConfigAttributes&) = default;
};

struct Config {
    std::optional<std::string> name;
    std::optional<uint32_t> latency; // frames
    ConfigAttributes attributes;
    std::optional<Node> appNode; // the machine of the application
    std::vector<Node> nodes;
    std::vector<Observer> observers;
    std::vector<Layout> layouts;
    std::vector<Canvas> canvases;
    std::vector<Compound> compounds;
    SourcePosition at;
    friend bool operator==(const Config&, const Config&) = default;
};

struct ConfigFile {
    double version = 0;               // of the format: 1, 1.1, 1.2; 0 when the file does not say it
    std::vector<std::string> heading; // comments before everything else, without their marks
    Globals globals;
    std::vector<Connection> serverConnections;
    Config config;
    friend bool operator==(const ConfigFile&, const ConfigFile&) = default;
};

inline constexpr double kCurrentVersion = 1.2;

} // namespace mural::config
