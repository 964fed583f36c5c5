// The eye passes of a picture. Cyclop is the single eye of mono pictures.
#pragma once

#include "common/base/enum_set.hpp"

namespace mural {

enum class Eye : uint8_t { Cyclop, Left, Right };
using EyeSet = EnumSet<Eye>;

inline constexpr Eye kEyes[] = {Eye::Cyclop, Eye::Left, Eye::Right}; // in drawing order
inline constexpr EyeSet kAllEyes{Eye::Cyclop, Eye::Left, Eye::Right};

[[nodiscard]] constexpr const char* nameOf(Eye eye) {
    return eye == Eye::Left ? "LEFT" : eye == Eye::Right ? "RIGHT" : "CYCLOP";
}

} // namespace mural
