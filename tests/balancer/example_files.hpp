// Example configurations of Equalizer, unmodified, and their expected contents. They are outside the tree, in the
// folder shared/eqc, or at MURAL_SHARED. Without them tests print the reason and are skipped.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace mural::config::testing {

inline std::filesystem::path exampleFolder() {
    const char* given = std::getenv("MURAL_SHARED");
    return (given != nullptr ? std::filesystem::path(given)
                             : std::filesystem::path(MURAL_SOURCE_DIR).parent_path() / "shared") /
           "eqc";
}

inline std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::is_directory(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".eqc") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

inline std::vector<std::filesystem::path> exampleFiles() { return filesIn(exampleFolder()); }
inline std::vector<std::filesystem::path> ownFiles() {
    return filesIn(std::filesystem::path(MURAL_SOURCE_DIR) / "configs");
}

inline std::vector<std::filesystem::path> allFiles() {
    std::vector<std::filesystem::path> all = ownFiles();
    for (const auto& file : exampleFiles()) all.push_back(file);
    return all;
}

inline std::string textOf(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The message for missing example files.
inline std::string noExamples() {
    return "no example files in " + exampleFolder().string() + "; set MURAL_SHARED to the folder that holds eqc";
}

} // namespace mural::config::testing
