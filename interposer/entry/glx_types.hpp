// The declarations of Xlib and GLX that the entry needs, without linking them.
#pragma once

#include <cstdint>

namespace mural::glx {

using Display = void;
using XID = unsigned long;
using Context = void*;
using FbConfig = void*;

// GLX 1.4, table 3.1; visual attributes share the values.
enum : int {
    kUseGl = 1,
    kBufferSize = 2,
    kLevel = 3,
    kExtensions = 3,
    kRgba = 4,
    kDoubleBuffer = 5,
    kStereo = 6,
    kRed = 8,
    kGreen = 9,
    kBlue = 10,
    kAlpha = 11,
    kDepth = 12,
    kStencil = 13,
    kAccumRed = 14,
    kSamples = 100001,
    kSrgbCapable = 0x20B2,
    kWidth = 0x801D,
    kHeight = 0x801E,
    kPbufferHeight = 0x8040,
    kPbufferWidth = 0x8041,
    kContextMajor = 0x2091,
    kContextFlags = 0x2094,
    kContextProfileMask = 0x9126,
    kFbConfigId = 0x8013,
    kResetStrategy = 0x8256,
    kLoseOnReset = 0x8252,
    kReleaseBehavior = 0x2097,
    kTextureFormat = 0x20D5,
    kTextureTarget = 0x20D6,
    kTextureRgba = 0x20DA,
    kTexture2d = 0x20DC,
    kTextureRectangle = 0x20DD,
};

} // namespace mural::glx
