// Lines of text between two processes, with deadlines.
#pragma once

#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::cli {

class LineChannel {
public:
    // Reads from one descriptor and writes to the other; they may be equal.
    LineChannel(FileDescriptor in, FileDescriptor out) : in_(std::move(in)), out_(std::move(out)) {}

    // Returns a line without its end. Errors: the deadline, end of file, an overlong line.
    Result<std::string> read(Deadline deadline);
    Result<void> write(const std::string& line, Deadline deadline);
    // Readable if a line, or a part of one, may be available.
    [[nodiscard]] int readableFd() const { return in_.get(); }
    void closeWriting() { out_ = FileDescriptor(); }

private:
    static constexpr size_t kMaxLineBytes = 256 * 1024;
    FileDescriptor in_, out_;
    std::string waiting_;
};

} // namespace mural::cli
