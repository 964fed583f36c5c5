// A request of a subcommand to a running session, and the lines of its reply.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/mural/ctl/control_client.hpp"

namespace mural::cli {

// Above the time of two operations, of which one is another client's.
inline constexpr int64_t kReplyPatienceMs = 60'000;
inline constexpr int kExitFailed = 1;

// Prints one line, such as "mural ctl: WHY". Returns the status.
int requestFailure(const std::string& command, const std::string& why, int status);

// Returns the path of the control socket. session and errors: as for connectToSession().
Result<std::string> controlPathOf(const std::string& command, const std::string& session, int& status);

// session: as `mural ctl` names it; empty: the only one. Errors: no such session, or several; `status` is the exit
// status.
Result<ControlClient> connectToSession(const std::string& command, const std::string& session, Deadline deadline,
                                       int& status);

// Prints the reply, or its error. Returns the exit status.
int printReply(const std::string& command, const std::string& operation, const nlohmann::json& reply, bool asJson);

} // namespace mural::cli
