// A folder that exists as long as the test.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/stat.h>

namespace mural::test {

class ScratchFolder {
public:
    ScratchFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "mural-output-XXXXXX").string();
        if (::mkdtemp(name.data()) != nullptr)
            path_ = name;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code error;
        if (!path_.empty())
            std::filesystem::remove_all(path_, error);
    }

    [[nodiscard]] std::string path(const std::string& name = {}) const {
        return name.empty() ? path_ : path_ + "/" + name;
    }

    // Writes a shell script and gives back its path.
    [[nodiscard]] std::string script(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << "#!/bin/sh\n" << text;
        ::chmod(path(name).c_str(), 0755);
        return path(name);
    }

private:
    std::string path_;
};

} // namespace mural::test
