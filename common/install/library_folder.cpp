#include "common/install/library_folder.hpp"

#include <filesystem>
#include <system_error>

namespace mural {

std::string libraryFolder(const std::string& binary) {
    namespace fs = std::filesystem;
    const fs::path prefix = fs::path(binary).parent_path().parent_path();
    std::error_code failed;
    for (const char* libraries : {MURAL_INSTALL_LIBDIR, "lib"}) {
        const fs::path folder = prefix / libraries / "mural";
        if (fs::is_directory(folder, failed)) return folder.string();
    }
    return (prefix / "lib").string();
}

} // namespace mural
