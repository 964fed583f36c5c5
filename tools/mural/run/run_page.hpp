// The page of `mural run --page`: a process of its own, so its end or crash does not affect the run.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "tools/mural/console.hpp"

namespace mural::cli {

class RunPage {
public:
    // Starts the page of this process's session at the address, which may be empty. The head must accept connections.
    // The page prints its address to standard error.
    static Result<std::unique_ptr<RunPage>> start(const std::string& address);
    RunPage(const RunPage&) = delete;
    RunPage& operator=(const RunPage&) = delete;
    // Waits up to 2 s: the page ends after the head.
    ~RunPage();

    [[nodiscard]] pid_t pid() const { return process_.pid(); }
    // Reports an end of the page, once. Its own message precedes it.
    void watch(Console& console);

private:
    explicit RunPage(launch::ChildProcess process) : process_(process) {}

    launch::ChildProcess process_;
    bool isReported_ = false;
};

} // namespace mural::cli
