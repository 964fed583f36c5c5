// Attribute values: words with an integer value, or plain integers. Several words have the same integer (ON, FASTEST
// and CORE 0 are 1), and every attribute accepts every word. The reader of the attribute decides which word a value
// stands for.
#pragma once

#include <cstdint>
#include <optional>

namespace mural::config {

// Empty: not set here. The global attribute applies, then the default.
using Attribute = std::optional<int32_t>;

namespace value {

inline constexpr int32_t kOff = 0;
inline constexpr int32_t kOn = 1;
inline constexpr int32_t kAuto = -1;
inline constexpr int32_t kNicest = -2;
inline constexpr int32_t kPassive = -3;
inline constexpr int32_t kAnaglyph = -4;
inline constexpr int32_t kQuad = -5;
inline constexpr int32_t kVertical = -6;
inline constexpr int32_t kWindow = -7;
inline constexpr int32_t kAsync = -9;
inline constexpr int32_t kDrawSync = -10;
inline constexpr int32_t kLocalSync = -11;
inline constexpr int32_t kFbo = -12;
inline constexpr int32_t kRgba16f = -13;
inline constexpr int32_t kRgba32f = -14;
inline constexpr int32_t kFixed = -15;
inline constexpr int32_t kRelativeToOrigin = -16;
inline constexpr int32_t kRelativeToObserver = -17;
inline constexpr int32_t kFastest = 1;
inline constexpr int32_t kHorizontal = 1;
inline constexpr int32_t kCore = 1;        // CORE n is kCore + n
inline constexpr int32_t kSocket = -65536; // SOCKET n is kSocket + n

} // namespace value

} // namespace mural::config
