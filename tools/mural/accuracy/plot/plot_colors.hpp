// Colors of text and lines that the plots of mural bench accuracy share.
#pragma once

namespace mural::cli {

inline constexpr const char* kTextColor = "#1f2933";
inline constexpr const char* kMinorTextColor = "#66727f";
inline constexpr const char* kGridColor = "#d5dce3";

} // namespace mural::cli
