// `mural run --native`: no capture, only frames and seconds, for comparison.
#pragma once

namespace mural {

// True when MURAL_NATIVE is set: the program draws as it would without Mural.
bool nativeRun();
// One frame was shown; rewrites MURAL_NATIVE_REPORT ("frames seconds", and the
// CPU seconds of the showing threads over so many frames) now and then.
void countNativeFrame();

} // namespace mural
