// The equalizers of a running session, as operations of the control interface see them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/base/result.hpp"

namespace mural {

// Called by the control thread while the session runs. An implementation must be thread-safe and never block.
class EqualizerControl {
public:
    virtual ~EqualizerControl() = default;

    // Returns one object per equalizer: [{"name": …, "kind": …, "frozen": …, "parameters": {…}}].
    [[nodiscard]] virtual nlohmann::json list() const = 0;
    // Sets a parameter from the next decision on. value: the text of the user, such as "0.5" or "horizontal".
    // Errors: no such equalizer, no such parameter, an invalid value.
    virtual Result<void> set(const std::string& name, const std::string& parameter, const std::string& value) = 0;
    // Keeps the current division of the work, or releases it. Errors: no such equalizer.
    virtual Result<void> freeze(const std::string& name, bool isFrozen) = 0;
};

} // namespace mural
