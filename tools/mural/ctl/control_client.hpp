// A client of a session's control interface (docs/reference/control.md). Every call has a deadline. Not thread-safe.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural::cli {

// Returns a member of an object. Null: it has none, or the value is no object. Lines from outside never throw.
nlohmann::json memberOf(const nlohmann::json& value, const char* name);
// The same for texts; empty: none.
std::string textOf(const nlohmann::json& value, const char* name);
// Returns the value as one line of JSON.
std::string jsonLine(const nlohmann::json& value);

class ControlClient {
public:
    // Connects to a control socket and receives the hello. Errors: no session of this user listens there, or it has
    // another version of the protocol.
    static Result<ControlClient> connect(const std::string& path, Deadline deadline);

    [[nodiscard]] const nlohmann::json& hello() const { return hello_; }
    // Sends a request and returns the reply to it: {"ok": …, "result": …}. Skips messages of topics.
    Result<nlohmann::json> request(const std::string& operation, const nlohmann::json& arguments, Deadline deadline);
    // Returns the next line.
    Result<nlohmann::json> receive(Deadline deadline);

private:
    explicit ControlClient(FileDescriptor socket) : socket_(std::move(socket)) {}
    Result<void> send(const std::string& line, Deadline deadline);

    FileDescriptor socket_;
    nlohmann::json hello_;
    std::string received_;
    int64_t lastId_ = 0;
};

} // namespace mural::cli
