// Global attributes: defaults for the attributes of all nodes, pipes, windows, channels, compounds and views. What
// counts: the section's own attribute, else the file's global one, else the environment variable of the same name, else
// what is built in.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "balancer/config/config.hpp"
#include "balancer/config/diagnostics.hpp"

namespace mural::config {

class TokenReader;

enum class GlobalKind : uint8_t { Word, Number, Statistics, Affinity, Length, Text, Character, Mask, ConnectionType };

struct GlobalAttribute {
    std::string_view name;
    GlobalKind kind;
    std::optional<GlobalValue> builtIn; // none: not set
};

std::span<const GlobalAttribute> globalAttributes();

// By today's name, by an earlier one (EQ_CONNECTION_IATTR_TCPIP_PORT), or by one from before 2006
// (EQ_CONNECTION_HOSTNAME). Null when nothing is called so.
const GlobalAttribute* findGlobalAttribute(std::string_view name);

// The attribute's value as a file says it; none when that fails.
std::optional<GlobalValue> readGlobalValue(TokenReader& tokens, const GlobalAttribute& attribute);

// The value of an environment variable, none when it is not set.
using EnvironmentLookup = std::function<std::optional<std::string>(const std::string& name)>;
Globals globalsOfEnvironment(const EnvironmentLookup& lookup, Diagnostics& diagnostics);

class GlobalDefaults {
public:
    GlobalDefaults(const Globals& written, const Globals& environment) : written_(written), environment_(environment) {}

    // The value of what is called so; none when it is set nowhere.
    template <class T> [[nodiscard]] std::optional<T> get(std::string_view name) const {
        const GlobalValue* found = find(name);
        const T* value = found != nullptr ? std::get_if<T>(found) : nullptr;
        return value != nullptr ? std::optional<T>(*value) : std::nullopt;
    }

private:
    [[nodiscard]] const GlobalValue* find(std::string_view name) const;
    const Globals& written_;
    const Globals& environment_;
};

} // namespace mural::config
