// Mural's own records in capture streams: contexts, windows, requests, client memory. GL commands have the opcodes of
// streamcodec/api/opcodes.lock.
#pragma once

#include <cstdint>

namespace mural::wire {

// Mural's own opcodes in capture streams, below kFirstGlOpcode.
enum Op : uint16_t {
    kOpInvalid = 0,
    kOpBlobBegin = 1,      // u64 sizeBytes: a value too large for a record; queued until its command uses it
    kOpBlobData = 2,       // u32 count, bytes
    kOpCreateContext = 3,  // u32 context, u32 shareContext (0 none), u32 api, u32 versionMajor, minor, u32 profile, u32
                           // flags, u32 surfaceConfig index
    kOpDestroyContext = 4, // u32 context
    kOpMakeCurrent = 5,    // u32 context (0 none), u32 drawWindow, u32 readWindow
    kOpWindow = 6,         // u32 window, WindowConfig: created or resized
    kOpDestroyWindow = 7,  // u32 window
    kOpSwap = 8,           // u32 window, u32 frame
    kOpClientArrays = 9,   // client memory of the following draw (streamcodec/wire/client_arrays.hpp)
    kOpRequestPixels = 10, // u32 request, i32 x y w h, u32 format, u32 type, u32 groupBytes
    kOpRequestTexImage = 11,
    kOpRequestBuffer = 12,
    kOpRequestQuery = 13,
    kOpFillWindow = 14,       // i32 x y w h, u32 planes, bytes: pixels of other tiles; precedes a copy
    kOpProgramLayout = 15,    // after a link: u32 program, locations by name
    kOpBufferBytes = 16,      // u32 buffer, u64 offset, bytes: written through a mapping
    kOpFinish = 17,           // u32 request: replied to when all earlier commands are complete
    kOpFrontPicture = 18,     // u32 window, u32 frame: like Swap, for single-buffered windows and front-buffer drawing
    kOpBeginConditional = 19, // u32 draws: glBeginConditionalRender with the known result; 0: nothing is drawn
    kOpQueryKnown = 20,       // u32 query, u32 passed: for conditional rendering in the next called display list
    kOpDrawAll = 21,          // from here on every node draws all of every window
    kOpCreateImage =
        22, // u64 image, u32 context, u32 target, u32 name, i32 level, i32 layer: eglCreateImage of a GL object
    kOpDestroyImage = 23,   // u64 image
    kOpRequestProgram = 24, // u32 request, u32 program: reads the recipe of its linked state
    kOpProgramRecipe =
        25, // u32 program, a reply to kOpRequestProgram: for glProgramBinary; empty: the binary was refused
    kOpErrorReported = 26, // glGetError has returned an error of the program's own GL
    // Programs with the native API. Their streams contain these, kOpWindow and kOpSwap only.
    kOpObject = 27, // a message about distributed objects, or a piece of it (object_records.hpp)
    kOpFrame = 28,  // NativeFrame: precedes the swap of its frame
    kOpLastOwn = 63,
};
constexpr uint16_t kFirstGlOpcode = 64;

// Flags in groupBytes of kOpRequestPixels.
//
// The program's pixel transfer (scale, bias, maps) is not applied.
constexpr uint32_t kPlainTransfer = 0x80000000;
// The samples of each pixel are resolved, as in a copy of the window.
constexpr uint32_t kResolved = 0x40000000;
// Flags in `planes` of kOpFillWindow.
//
// The pixels are for the next copy only. They do not replace the samples of a window with samples.
constexpr uint32_t kForCopy = 0x80000000;
// Colours are words of GL_UNSIGNED_INT_2_10_10_10_REV, or four floats. Default: four bytes.
constexpr uint32_t kTenBits = 0x40000000;
constexpr uint32_t kFloats = 0x20000000;

// Frame number in kOpSwap and kOpFrontPicture of an unseen frame: it is drawn and counted, but no picture is sent and
// no credit is returned.
constexpr uint32_t kUnseenFrame = 0;

// Properties of the program's drawable; the surfaces of the nodes have the same.
struct WindowConfig {
    uint32_t width, height; // pixels
    uint8_t red, green, blue, alpha;
    uint8_t depth, stencil, samples, doubleBuffer;
    uint8_t accum, stereo, srgb, isPbuffer;
    uint32_t nativeLow, nativeHigh; // X window id; 0: none
};
static_assert(sizeof(WindowConfig) == 28);
// In doubleBuffer: the front buffer begins black, and swaps do not change it.
constexpr uint8_t kOwnFront = 2;

// In the flags of kOpCreateContext: the program requests notification of a context loss.
constexpr uint32_t kLosesOnReset = 0x80000000;

// A frame of a program with the native API: what mural::Frame contains, and the observer.
struct NativeFrame {
    uint64_t number;
    double seconds;
    uint64_t seed;
    double head[12]; // pose of the head in the room: three rows of a matrix
};
static_assert(sizeof(NativeFrame) == 120);

enum class Api : uint32_t { Desktop = 0, Es1 = 1, Es2 = 2 }; // Es2: ES 2 and later

} // namespace mural::wire
