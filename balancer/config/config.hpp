// A configuration as the file states it: names are not resolved, and omitted values are empty.
#pragma once

#include <map>

#include "balancer/config/compound_model.hpp"
#include "balancer/config/resources.hpp"

namespace mural::config {

// Value of a global attribute. The attribute's name determines the alternative.
using GlobalValue = std::variant<int32_t, double, std::string, char, ColorMask, ConnectionType>;
using Globals = std::map<std::string, GlobalValue>;

struct ConfigAttributes {
    std::optional<double> eyeBase; // in metres
    Attribute robustness;
    friend bool operator==(const ConfigAttributes&, const ConfigAttributes&) = default;
};

struct Config {
    std::optional<std::string> name;
    std::optional<uint32_t> latency; // in frames
    ConfigAttributes attributes;
    std::optional<Node> appNode; // the application's machine
    std::vector<Node> nodes;
    std::vector<Observer> observers;
    std::vector<Layout> layouts;
    std::vector<Canvas> canvases;
    std::vector<Compound> compounds;
    SourcePosition at;
    friend bool operator==(const Config&, const Config&) = default;
};

struct ConfigFile {
    double version = 0;               // version of the format: 1, 1.1, 1.2; 0: not stated
    std::vector<std::string> heading; // leading comments without comment marks
    Globals globals;
    std::vector<Connection> serverConnections;
    Config config;
    friend bool operator==(const ConfigFile&, const ConfigFile&) = default;
};

inline constexpr double kCurrentVersion = 1.2;

} // namespace mural::config
