// The lease of the input: which viewer may send input to the program. Pure; not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "tools/mural/page/access/role.hpp"

namespace mural::page {

enum class InputMode : uint8_t {
    Click, // a click takes an idle lease
    Ask,   // only input-take takes it
    Owner, // only viewers with the role operate take it
    All    // every viewer with the role input may send
};
[[nodiscard]] std::optional<InputMode> inputModeOfName(std::string_view name);

class InputLease {
public:
    static constexpr int64_t kIdleNs = 1'000'000'000; // after the holder's last event

    explicit InputLease(InputMode mode) : mode_(mode) {}

    [[nodiscard]] int holder() const { return holder_; } // 0: nobody
    // Returns whether the viewer has the lease now. Operators take it from others.
    [[nodiscard]] bool take(int viewer, Role role, int64_t nowNs);
    // Returns whether the viewer had the lease.
    bool release(int viewer);
    // Returns whether an event of the viewer may pass. takes: it is the press of a button. holdsButtons: the current
    // holder has pressed buttons.
    [[nodiscard]] bool passes(int viewer, Role role, bool takes, bool holdsButtons, int64_t nowNs);

private:
    [[nodiscard]] bool isIdle(int64_t nowNs) const { return holder_ == 0 || nowNs - lastEventNs_ >= kIdleNs; }

    const InputMode mode_;
    int holder_ = 0;
    int64_t lastEventNs_ = 0;
};

} // namespace mural::page
