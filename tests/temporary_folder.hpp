// A folder for one test, which is removed afterwards.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace mural::test {

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "mural-test-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string at(const std::string& name) const { return path_ + "/" + name; }

    // Writes a file and returns its path. `mode`: as for chmod, for example 0755.
    std::string file(const std::string& name, const std::string& bytes, int mode) const {
        std::ofstream(at(name), std::ios::binary) << bytes;
        std::filesystem::permissions(at(name), static_cast<std::filesystem::perms>(mode));
        return at(name);
    }

    // Writes a shell script and returns its path.
    [[nodiscard]] std::string script(const std::string& name, const std::string& text) const {
        return file(name, "#!/bin/sh\n" + text, 0755);
    }

private:
    std::string path_;
};

} // namespace mural::test
