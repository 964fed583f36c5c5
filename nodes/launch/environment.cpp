#include "nodes/launch/environment.hpp"

#include <algorithm>
#include <filesystem>
#include <unistd.h>

#include "common/install/library_folder.hpp"
#include "nodes/launch/base_name.hpp"

namespace mural::launch {

namespace {

constexpr std::string_view kPreload = "LD_PRELOAD";
constexpr std::string_view kLibraryPath = "LD_LIBRARY_PATH";
constexpr std::string_view kGlxVendor = "__GLX_VENDOR_LIBRARY_NAME";
constexpr std::string_view kEglVendors = "__EGL_VENDOR_LIBRARY_FILENAMES";
constexpr std::string_view kRealGlxVendor = "MURAL_REAL_GLX_VENDOR";
constexpr std::string_view kRealEglVendors = "MURAL_REAL_EGL_VENDORS";
constexpr std::string_view kSession = "MURAL_SESSION";
constexpr std::string_view kSocket = "MURAL_SOCKET";
constexpr std::string_view kNotes = "MURAL_NOTES";
constexpr std::string_view kOurVendor = "mural";

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> parts;
    size_t at = 0;
    while ((at = text.find_first_not_of(separators, at)) != std::string_view::npos) {
        const size_t end = std::min(text.find_first_of(separators, at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end;
    }
    return parts;
}

bool isOurEglList(std::string_view list) {
    const auto files = split(list, ":");
    return std::any_of(files.begin(), files.end(), [](auto f) { return baseName(f) == kEglVendorFileName; });
}

// Replaces a vendor variable and saves the user's value for the interposer.
void replaceVendor(Environment& environment, std::string_view name, std::string_view savedName,
                   std::string_view muralValue, bool isMuralValue) {
    const auto before = environment.get(name);
    if (!isMuralValue) {
        if (before && !before->empty()) {
            environment.set(savedName, *before);
        } else {
            environment.unset(savedName);
        }
    }
    environment.set(name, muralValue);
}

void restoreVendor(Environment& environment, std::string_view name, std::string_view savedName, bool isMuralValue) {
    if (isMuralValue) {
        if (const auto saved = environment.get(savedName)) {
            environment.set(name, *saved);
        } else {
            environment.unset(name);
        }
    }
    environment.unset(savedName);
}

} // namespace

Environment Environment::current() {
    std::vector<std::string> entries;
    for (char** e = environ; *e != nullptr; ++e) entries.emplace_back(*e);
    return Environment(std::move(entries));
}

std::optional<std::string> Environment::get(std::string_view name) const {
    for (const std::string& e : entries_) {
        if (e.size() > name.size() && e[name.size()] == '=' && std::string_view(e).starts_with(name)) {
            return e.substr(name.size() + 1);
        }
    }
    return std::nullopt;
}

void Environment::set(std::string_view name, std::string_view value) {
    unset(name);
    entries_.push_back(std::string(name) + "=" + std::string(value));
}

void Environment::unset(std::string_view name) {
    std::erase_if(entries_, [name](const std::string& e) {
        return e.size() > name.size() && e[name.size()] == '=' && std::string_view(e).starts_with(name);
    });
}

std::string ownBinary() {
    std::error_code failed;
    const auto path = std::filesystem::read_symlink("/proc/self/exe", failed);
    return failed ? std::string("mural") : path.string();
}

Result<CaptureLibrary> findCaptureLibrary(const std::string& muralBinary) {
    namespace fs = std::filesystem;
    const fs::path folder = libraryFolder(muralBinary);
    const fs::path library = folder / kCaptureLibraryName;
    std::error_code failed;
    if (fs::exists(library, failed)) return CaptureLibrary{library.string(), (folder / kEglVendorFileName).string()};
    return Error{"the capture library " + library.string() +
                 " is missing; build all of Mural (cmake --build --preset release) or install it again"};
}

std::string withoutCapture(std::string_view preload) {
    std::string saved;
    for (const auto entry : split(preload, " :")) {
        if (baseName(entry) == kCaptureLibraryName || baseName(entry) == kPreloadLibraryName) continue;
        if (!saved.empty()) saved += ' ';
        saved += entry;
    }
    return saved;
}

std::string withCapture(std::string_view preload, std::string_view entries) {
    std::string all = withoutCapture(preload);
    if (!all.empty()) all += ' ';
    return all += entries;
}

Result<void> addCapture(Environment& environment, const CaptureLibrary& library, const std::string& session,
                        CaptureEntries entries) {
    const std::string folder = library.path.substr(0, library.path.rfind('/'));
    if (folder.find_first_of(":;") != std::string::npos) {
        return Error{"the folder " + folder +
                     " contains ':' or ';', which the loader does not accept; move Mural to another folder"};
    }
    std::string prefix = folder + "/";
    if (prefix.find_first_of(" \t\n") != std::string::npos) {
        // LD_PRELOAD cannot hold blanks: name the libraries alone and let the loader search their folder.
        prefix.clear();
        const std::string searched = environment.get(kLibraryPath).value_or("");
        if (!(searched + ":").starts_with(folder + ":")) {
            environment.set(kLibraryPath, searched.empty() ? folder : folder + ":" + searched);
        }
    }
    std::string libraries = prefix + std::string(kCaptureLibraryName);
    if (entries == CaptureEntries::VendorAndPreload) libraries += " " + prefix + std::string(kPreloadLibraryName);
    environment.set(kPreload, withCapture(environment.get(kPreload).value_or(""), libraries));
    replaceVendor(environment, kGlxVendor, kRealGlxVendor, kOurVendor, environment.get(kGlxVendor) == kOurVendor);
    replaceVendor(environment, kEglVendors, kRealEglVendors, library.eglVendorFile,
                  isOurEglList(environment.get(kEglVendors).value_or("")));
    environment.set(kSession, session);
    environment.unset(kSocket); // of a session that this one runs in
    return {};
}

void removeCapture(Environment& environment) {
    restoreVendor(environment, kGlxVendor, kRealGlxVendor, environment.get(kGlxVendor) == kOurVendor);
    restoreVendor(environment, kEglVendors, kRealEglVendors, isOurEglList(environment.get(kEglVendors).value_or("")));
    environment.unset(kPreload);
    environment.unset(kSession);
    environment.unset(kSocket);
    environment.unset(kNotes);
}

} // namespace mural::launch
