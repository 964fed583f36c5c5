#include "transport/plugin/plugin_library.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "common/install/library_folder.hpp"

namespace mural {

namespace {

namespace fs = std::filesystem;

// Requires equal versions: newer tables only grow, but the meaning of a function may have changed.
std::string whyUnfit(const mural_transport_plugin* plugin, const std::string& scheme) {
    if (!plugin) return "its " MURAL_TRANSPORT_PLUGIN_ENTRY "() returns no table";
    if (plugin->version != MURAL_TRANSPORT_PLUGIN_VERSION)
        return "it implements version " + std::to_string(plugin->version) +
               " of the plug-in interface, but this Mural has version " +
               std::to_string(MURAL_TRANSPORT_PLUGIN_VERSION);
    if (plugin->size_bytes < sizeof *plugin) return "its table is truncated";
    if (!plugin->scheme || scheme != plugin->scheme)
        return std::string("it implements the scheme \"") + (plugin->scheme ? plugin->scheme : "") + "\"";
    return {};
}

} // namespace

std::string pluginFolder() {
    std::error_code failed;
    return libraryFolder(fs::read_symlink("/proc/self/exe", failed).string());
}

Result<const mural_transport_plugin*> openPlugin(const std::string& scheme, const std::string& folder) {
    const std::string file = (fs::path(folder) / ("libmural_transport_" + scheme + ".so")).string();
    const std::string what = "transport " + scheme + ": ";
    std::error_code failed;
    if (!fs::exists(file, failed))
        return Error{what + "the plug-in is missing: " + file + "; check the scheme, or build or install the plug-in"};
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library) {
        const char* message = dlerror(); // contains the file name
        return Error{what + "cannot load the plug-in: " + (message ? message : file) + "; install its dependencies"};
    }
    const auto entry = reinterpret_cast<mural_transport_plugin_entry>(dlsym(library, MURAL_TRANSPORT_PLUGIN_ENTRY));
    const std::string unfit = entry ? whyUnfit(entry(), scheme) : "it has no function " MURAL_TRANSPORT_PLUGIN_ENTRY;
    if (!unfit.empty())
        return Error{what + file + " is not a suitable plug-in: " + unfit +
                     "; build it with this Mural's transport_plugin.h"};
    return entry();
}

} // namespace mural
