// Environments of the processes that `mural run` starts: the program gets the capture added, the head
// and the nodes get it (and every preloaded library) taken away. Value types, no global state changed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/result.hpp"

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
    std::vector<std::string> entries_; // NAME=value, in the order found
};

// Where the capture library is; found relative to the mural binary.
struct CaptureLibrary {
    std::string path;          // …/libGLX_mural.so.0
    std::string eglVendorFile; // …/mural_egl_vendor.json
};
constexpr std::string_view kCaptureLibraryName = "libGLX_mural.so.0";
// In the same folder; only for programs whose GL library GLVND does not lead to.
constexpr std::string_view kFrontLibraryName = "libmural_front.so";
constexpr std::string_view kEglVendorFileName = "mural_egl_vendor.json";

// Looks beside the binary as in the build tree (../lib) and as installed (../lib/mural).
Result<CaptureLibrary> findCaptureLibrary(const std::string& muralBinary);

// Path of the running binary.
std::string ownBinary();

// LD_PRELOAD's value with every earlier entry of ours removed; other entries stay as they are.
std::string withoutCapture(std::string_view preload);
// The same with our entries after all others.
std::string withCapture(std::string_view preload, std::string_view entries);

// What is preloaded: the library alone, or with it the front for GL libraries that are not GLVND's.
enum class Fronts { Vendor, VendorAndPreload };

// Adds preload and vendor variables; what they were before goes to MURAL_REAL_*. Idempotent.
Result<void> addCapture(Environment& environment, const CaptureLibrary& library, const std::string& session, Fronts fronts = Fronts::Vendor);

// For the head and the nodes: nothing of the capture and nothing preloaded (clock fakers and frame
// grabbers are meant for the program).
void removeCapture(Environment& environment);

} // namespace mural::launch
