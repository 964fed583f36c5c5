// `mural run --native`: counts frames and seconds without capture, for comparison.
#pragma once

namespace mural {

// True if MURAL_NATIVE is set: the program draws as without Mural.
bool nativeRun();
// Counts a shown frame. Periodically rewrites MURAL_NATIVE_REPORT ("frames seconds", and the CPU seconds of the showing
// threads for a number of frames).
void countNativeFrame();

} // namespace mural
