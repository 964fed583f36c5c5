// A result file that is opened before the measurement and written after it, so an invalid path is reported immediately.
#pragma once

#include <string>
#include <utility>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::cli {

class ResultFile {
public:
    // Opens the file; an empty path discards the output. Existing contents stay until write().
    static Result<ResultFile> open(const std::string& option, const std::string& path);
    ResultFile(ResultFile&& other) noexcept
        : name_(std::move(other.name_)),
          path_(std::move(other.path_)),
          file_(std::move(other.file_)),
          unused_(std::exchange(other.unused_, false)) {}
    ResultFile(const ResultFile&) = delete;
    ~ResultFile(); // removes a file that it created and did not write

    Result<void> write(const std::string& text);

private:
    ResultFile(const std::string& option, std::string path) : name_(option + " " + path), path_(std::move(path)) {}
    [[nodiscard]] Error failed() const; // from errno

    std::string name_, path_;
    FileDescriptor file_;
    bool unused_ = false; // created here and still empty
};

} // namespace mural::cli
