#include "tools/mural/page/input/input_lease.hpp"

#include <algorithm>
#include <array>

namespace mural::page {

namespace {

constexpr std::array<std::string_view, 4> kInputModeNames = {"click", "ask", "owner", "all"};

} // namespace

std::optional<InputMode> inputModeOfName(std::string_view name) {
    const auto found = std::ranges::find(kInputModeNames, name);
    if (found == kInputModeNames.end()) return std::nullopt;
    return static_cast<InputMode>(found - kInputModeNames.begin());
}

bool InputLease::take(int viewer, Role role, int64_t nowNs) {
    if (role < Role::Input || (mode_ == InputMode::Owner && role < Role::Operate)) return false;
    if (holder_ != 0 && holder_ != viewer && role < Role::Operate && !isIdle(nowNs)) return false;
    holder_ = viewer;
    lastEventNs_ = nowNs;
    return true;
}

bool InputLease::release(int viewer) {
    if (holder_ != viewer) return false;
    holder_ = 0;
    return true;
}

bool InputLease::passes(int viewer, Role role, bool takes, bool holdsButtons, int64_t nowNs) {
    if (role < Role::Input) return false;
    if (mode_ == InputMode::All) return true;
    const bool isFree = isIdle(nowNs) && !holdsButtons;
    const bool mayTake = mode_ == InputMode::Click || (mode_ == InputMode::Owner && role == Role::Operate);
    if (holder_ != viewer && takes && mayTake && isFree) holder_ = viewer;
    if (holder_ != viewer) return false;
    lastEventNs_ = nowNs;
    return true;
}

} // namespace mural::page
