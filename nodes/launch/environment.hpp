// The environments of processes that `mural run` starts. The program's environment gains the capture library. The
// environments of head and nodes lose it and all other preloaded libraries. Value types without global state.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::launch {

class Environment {
public:
    Environment() = default;
    explicit Environment(std::vector<std::string> entries) : entries_(std::move(entries)) {}
    static Environment current();

    [[nodiscard]] std::optional<std::string> get(std::string_view name) const;
    void set(std::string_view name, std::string_view value);
    void unset(std::string_view name);
    [[nodiscard]] const std::vector<std::string>& entries() const { return entries_; }

private:
    std::vector<std::string> entries_; // NAME=value, in the original order
};

// The location of the capture library, relative to the mural binary.
struct CaptureLibrary {
    std::string path;          // …/libGLX_mural.so.0
    std::string eglVendorFile; // …/mural_egl_vendor.json
};
constexpr std::string_view kCaptureLibraryName = "libGLX_mural.so.0";
// In the same folder; for programs whose GL library does not use GLVND.
constexpr std::string_view kPreloadLibraryName = "libmural_preload.so";
constexpr std::string_view kEglVendorFileName = "mural_egl_vendor.json";

// Searches the folder of Mural's libraries (common/install/library_folder.hpp).
Result<CaptureLibrary> findCaptureLibrary(const std::string& muralBinary);

// Path of the running binary.
std::string ownBinary();

// Removes our entries from a value of LD_PRELOAD; keeps all others.
std::string withoutCapture(std::string_view preload);
// Removes our entries and appends new ones after all others.
std::string withCapture(std::string_view preload, std::string_view entries);

// The preloaded libraries: the capture library alone, or with the preload library for GL libraries outside GLVND.
enum class CaptureEntries { Vendor, VendorAndPreload };

// Adds the preload and vendor variables. Their previous values are saved in MURAL_REAL_*. Idempotent.
Result<void> addCapture(Environment& environment, const CaptureLibrary& library, const std::string& session,
                        CaptureEntries entries = CaptureEntries::Vendor);

// For head and nodes: removes the capture and all preloaded libraries. Clock fakers and frame grabbers are meant for
// the program.
void removeCapture(Environment& environment);

} // namespace mural::launch
