// Lines of text between two processes, each with a deadline.
#pragma once

#include <string>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::cli {

class LineChannel {
public:
    // Reads from one, writes to the other; they may be the same.
    LineChannel(FileDescriptor in, FileDescriptor out) : in_(std::move(in)), out_(std::move(out)) {}

    // Without its end. Errors: the deadline, the other's end, a line that is too long.
    Result<std::string> read(Deadline deadline);
    Result<void> write(const std::string& line, Deadline deadline);
    // A line, or a part of one, may be there.
    [[nodiscard]] int readableFd() const { return in_.get(); }
    void closeWriting() { out_ = FileDescriptor(); }

private:
    static constexpr size_t kMostLineBytes = 256 * 1024;
    FileDescriptor in_, out_;
    std::string waiting_;
};

} // namespace mural::cli
