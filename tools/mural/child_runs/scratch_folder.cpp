#include "tools/mural/child_runs/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace mural::cli {

Result<ScratchFolder> ScratchFolder::make() {
    std::error_code error;
    const std::filesystem::path all = std::filesystem::temp_directory_path(error);
    std::string path = (error ? std::filesystem::path("/tmp") : all) / "mural-runs.XXXXXX";
    if (mkdtemp(path.data()) == nullptr)
        return Error{"cannot create a folder for temporary files: " + path + ": " + std::strerror(errno) +
                     "; set TMPDIR to a writable folder"};
    return ScratchFolder(path);
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

} // namespace mural::cli
