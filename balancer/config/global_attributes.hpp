// Global attributes: defaults for the attributes of all nodes, pipes, windows, channels, compounds and views.
// Precedence: the section's own attribute, the file's global attribute, the environment variable of the same name, the
// built-in default.
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
    std::optional<GlobalValue> builtIn; // empty: no default
};

std::span<const GlobalAttribute> globalAttributes();

// Finds an attribute by its current name, an earlier name (EQ_CONNECTION_IATTR_TCPIP_PORT), or a name from before 2006
// (EQ_CONNECTION_HOSTNAME). Returns null for an unknown name.
const GlobalAttribute* findGlobalAttribute(std::string_view name);

// Reads the attribute's value in the syntax of the file. Returns an empty value on errors.
std::optional<GlobalValue> readGlobalValue(TokenReader& tokens, const GlobalAttribute& attribute);

// Returns the value of an environment variable; empty if it is not set.
using EnvironmentLookup = std::function<std::optional<std::string>(const std::string& name)>;
Globals globalsOfEnvironment(const EnvironmentLookup& lookup, Diagnostics& diagnostics);

class GlobalDefaults {
public:
    GlobalDefaults(const Globals& written, const Globals& environment) : written_(written), environment_(environment) {}

    // Returns the value of the named attribute; empty if it is set nowhere.
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
