// Settings of `mural run` for this process, copied from the environment when the library is loaded. Programs may change
// or clear their environment before they use GL; these copies persist.
#pragma once

namespace mural {

struct LaunchSettings {
    const char* session;        // MURAL_SESSION: abstract socket name of the head; null: the process is not captured
    const char* socketPath;     // MURAL_SOCKET: the same head's socket in the file system; null: none
    const char* notes;          // MURAL_NOTES
    const char* realGlxVendor;  // MURAL_REAL_GLX_VENDOR
    const char* realEglVendors; // MURAL_REAL_EGL_VENDORS
    const char* native;         // MURAL_NATIVE; the next two fields hold its companions
    const char* nativeReport;
    const char* nativeFrames;
};

// Valid from the first call on. MURAL_DISABLE leaves the first three fields null.
const LaunchSettings& launchSettings();

} // namespace mural
