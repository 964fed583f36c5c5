// The session's sockets in the file system. Programs, clients of the control interface and pages have one each. The one
// for programs exists in addition to an abstract socket.
// Programs in another network namespace (sandboxes) cannot reach an abstract socket. Each session has its own folder,
// which only its user may enter.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace mural::launch {

// The folder, from create() until the end of `mural run`. The head listens in it, and removes it as well if it outlives
// `mural run`. A later create() removes the folder of a session whose processes were all killed.
class SessionSocket {
public:
    // session: a result of newSessionName(). runtimeFolder: $XDG_RUNTIME_DIR. It is used if it belongs to this user and
    // the path is short enough for a socket. Otherwise the system's folder for temporary files is used.
    static Result<std::unique_ptr<SessionSocket>> create(const std::string& session, const std::string& runtimeFolder);
    SessionSocket(const SessionSocket&) = delete;
    SessionSocket& operator=(const SessionSocket&) = delete;
    ~SessionSocket();

    [[nodiscard]] const std::string& path() const { return path_; }

private:
    explicit SessionSocket(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

// Returns the path of the control socket, in the folder of the session's socket.
std::string controlSocketOf(const std::string& sessionSocket);
// The same for the socket on which the head gives pictures to pages (nodes/head/preview)…
std::string pictureSocketOf(const std::string& sessionSocket);
// …and for the one on which the session's page accepts requests of `mural page`.
std::string pageSocketOf(const std::string& sessionSocket);
// Removes the sockets and their folder. Idempotent.
void removeSessionSocket(const std::string& path);
// Removes the folders of sessions in `folder` that this user owns and no head listens in any more.
void removeStaleSockets(const std::string& folder);

} // namespace mural::launch
