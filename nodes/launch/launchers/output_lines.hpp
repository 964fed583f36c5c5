// Reads the output of a process line by line, on a thread.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>
#include <thread>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::launch {

class OutputLines {
public:
    using Take = std::function<void(std::string_view line)>; // called by the thread; without the newline
    static constexpr size_t kMaxLine = 65'536;               // longer lines are divided

    // beat: called by the thread about every beatMs. Empty: none.
    OutputLines(FileDescriptor output, Take take, std::function<void()> beat = {}, int64_t beatMs = 0);
    OutputLines(const OutputLines&) = delete;
    OutputLines& operator=(const OutputLines&) = delete;
    ~OutputLines(); // stops reading

    // Waits until the output has ended and all of it has been taken. Another process may hold it open for longer.
    bool drain(Deadline deadline) const;

private:
    void read();

    const FileDescriptor output_;
    const FileDescriptor stop_; // eventfd
    const Take take_;
    const std::function<void()> beat_;
    const int64_t beatMs_;
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

} // namespace mural::launch
