// A file that is written when all has been measured, and opened before anything is: minutes later nobody wants to hear that its
// folder is not there.
#pragma once

#include <string>
#include <utility>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::cli {

class ResultFile {
public:
    // Empty path: none, and what is written goes nowhere. What a file holds stays in it until it is written.
    static Result<ResultFile> open(const std::string& option, const std::string& path);
    ResultFile(ResultFile&& other) noexcept : name_(std::move(other.name_)), path_(std::move(other.path_)), file_(std::move(other.file_)), unused_(std::exchange(other.unused_, false)) {}
    ResultFile(const ResultFile&) = delete;
    ~ResultFile(); // removes a file that it has made and nobody has written

    Result<void> write(const std::string& text);

private:
    ResultFile(const std::string& option, std::string path) : name_(option + " " + path), path_(std::move(path)) {}
    [[nodiscard]] Error failed() const; // by errno

    std::string name_, path_;
    FileDescriptor file_;
    bool unused_ = false; // made by us, and still empty
};

} // namespace mural::cli
