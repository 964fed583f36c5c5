// The doctor's side of `mural network-member` on a host: started by the launch command, controlled by lines.
#pragma once

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.hpp"
#include "nodes/launch/child_process.hpp"
#include "tools/mural/network/line_channel.hpp"

namespace mural::cli {

class ProbeProcess {
public:
    static Result<std::unique_ptr<ProbeProcess>> start(const std::vector<std::string>& command);
    ProbeProcess(const ProbeProcess&) = delete;
    ProbeProcess& operator=(const ProbeProcess&) = delete;
    ~ProbeProcess(); // ends it with its descendants

    Result<void> send(const nlohmann::json& words);
    // Returns a JSON object. Errors: the process has ended, is silent, reports an error, or sends no JSON.
    Result<nlohmann::json> receive(Deadline deadline);
    Result<nlohmann::json> query(const nlohmann::json& words, Deadline deadline);
    // Kills it with its local descendants, so that receive() returns. Any thread.
    void abandon() { process_.signalGroup(SIGKILL); }

private:
    ProbeProcess(launch::ChildProcess process, LineChannel lines, FileDescriptor errors)
        : process_(process), lines_(std::move(lines)), errors_(std::move(errors)) {}
    // Returns the end of the process as the reason if it has ended, otherwise `why`.
    Error explained(const Error& why);
    // Returns how it ended, with the last line that it or its launch command printed to standard error.
    [[nodiscard]] std::string describeEnd() const;

    launch::ChildProcess process_;
    LineChannel lines_;
    FileDescriptor errors_; // memory with its standard error
};

} // namespace mural::cli
