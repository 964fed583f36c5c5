// The named values of the options of `mural run`. The readers of the options accept them, and the completion of shells
// offers them.
#pragma once

#include "nodes/session/session_config.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

inline constexpr Choice<Display> kDisplayChoices[] = {
    {"app", Display::App}, {"windows", Display::Windows}, {"none", Display::None}};
inline constexpr Choice<Tiling> kTilingChoices[] = {
    {"exact", Tiling::Exact}, {"culled", Tiling::Culled}, {"lean", Tiling::Lean}};
inline constexpr Choice<CullingMode> kCullingChoices[] = {
    {"off", CullingMode::Off}, {"auto", CullingMode::Auto}, {"audit", CullingMode::Audit}};
inline constexpr Choice<LocalRendering> kLocalRenderingChoices[] = {{"off", LocalRendering::Off},
                                                                    {"on", LocalRendering::On}};
inline constexpr Choice<DeltaMode> kDeltaChoices[] = {
    {"auto", DeltaMode::Auto}, {"on", DeltaMode::On}, {"off", DeltaMode::Off}};
inline constexpr Choice<Readback> kReadbackChoices[] = {
    {"auto", Readback::Auto}, {"direct", Readback::Direct}, {"buffer", Readback::Buffer}};
inline constexpr Choice<const char*> kGlChoices[] = {
    {"auto", "auto"}, {"egl", "egl"}, {"osmesa", "osmesa"}, {"glx", "glx"}};
inline constexpr Choice<EntryChoice> kEntryChoices[] = {
    {"auto", EntryChoice::Auto}, {"glvnd", EntryChoice::Glvnd}, {"preload", EntryChoice::Preload}};
inline constexpr Choice<balance::Balance> kBalanceChoices[] = {{"auto", balance::Balance::Auto},
                                                               {"load", balance::Balance::Load},
                                                               {"tree", balance::Balance::Tree},
                                                               {"off", balance::Balance::Off}};
inline constexpr Choice<StereoMode> kStereoChoices[] = {{"off", StereoMode::Off},
                                                        {"anaglyph", StereoMode::Anaglyph},
                                                        {"side-by-side", StereoMode::SideBySide},
                                                        {"top-bottom", StereoMode::TopBottom},
                                                        {"left", StereoMode::Left},
                                                        {"right", StereoMode::Right},
                                                        {"quad", StereoMode::Quad}};
inline constexpr Choice<ProjectionChoice> kProjectionChoices[] = {
    {"auto", ProjectionChoice::Auto}, {"program", ProjectionChoice::Program}, {"room", ProjectionChoice::Room}};

} // namespace mural::cli
