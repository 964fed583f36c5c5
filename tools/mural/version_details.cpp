#include "tools/mural/version_details.hpp"

#include <filesystem>

#include <CLI/Version.hpp>
#include <boost/version.hpp>
#include <fmt/format.h>
#include <lz4.h>
#include <png.h>
#include <sodium.h>
#include <zstd.h>

#include "common/install/library_folder.hpp"
#include "compositor/codecs/plugin/codec_plugin.h"
#include "nodes/head/control/control_protocol.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/session/stream_build.hpp"
#include "streamcodec/trace/format.hpp"
#include "transport/plugin/transport_plugin.h"

namespace mural::cli {

namespace {

namespace fs = std::filesystem;

std::string fileState(const fs::path& file) {
    std::error_code failed;
    return fs::exists(file, failed) ? file.string() : file.string() + " (missing)";
}

// Names of the plug-ins in Mural's own folder, such as "fabric".
std::string transportPlugins(const std::string& folder) {
    constexpr std::string_view kBegin = "libmural_transport_", kEnd = ".so";
    std::string names;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) continue;
        names +=
            (names.empty() ? "" : ", ") + name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size()) + "://";
    }
    return names.empty() ? "none" : names;
}

std::string loadedLibraries() {
    return fmt::format("libsodium {}, libzstd {}, liblz4 {}, libpng {}", sodium_version_string(), ZSTD_versionString(),
                       LZ4_versionString(), png_get_libpng_ver(nullptr));
}

std::string builtInLibraries() {
    return fmt::format("Boost {}.{}.{}, CLI11 {}, fmt {}.{}.{}", BOOST_VERSION / 100'000, BOOST_VERSION / 100 % 1000,
                       BOOST_VERSION % 100, CLI11_VERSION, FMT_VERSION / 10'000, FMT_VERSION / 100 % 100,
                       FMT_VERSION % 100);
}

} // namespace

std::vector<std::pair<std::string, std::string>> versionDetails() {
    const std::string binary = launch::ownBinary();
    const fs::path folder = libraryFolder(binary);
    return {
        {"build", fmt::format("{}, {}, {}", MURAL_BUILD_TYPE, MURAL_COMPILER, MURAL_PROCESSOR)},
        {"GL stream", streamBuild()},
        {"control", fmt::format("protocol {}", kControlVersion)},
        {"traces", fmt::format("format {}", trace::kVersion)},
        {"plug-ins",
         fmt::format("codecs {}, transports {}", MURAL_CODEC_PLUGIN_VERSION, MURAL_TRANSPORT_PLUGIN_VERSION)},
        {"libraries", loadedLibraries()},
        {"built in", builtInLibraries()},
        {"binary", binary},
        {"own files", folder.string()},
        {"capture", fileState(folder / launch::kCaptureLibraryName)},
        {"preload", fileState(folder / launch::kPreloadLibraryName)},
        {"EGL vendor", fileState(folder / launch::kEglVendorFileName)},
        {"transports", "shared memory, tcp, rsp; plug-ins: " + transportPlugins(folder.string())},
    };
}

} // namespace mural::cli
