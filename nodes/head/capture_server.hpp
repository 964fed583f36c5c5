// The session's Unix sockets: programs connect, send Hello, and get their shared memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

#include "common/capture_ring.hpp"
#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural {

struct Admission {
    capture::Welcome welcome{};  // refused, extensionBytes, magic and version are the server's
    int memoryFd = -1;           // the host's
    std::string extensions;
};

// Who decides about programs. Called by the server's thread.
class ProgramHost {
public:
    virtual ~ProgramHost() = default;
    // An error refuses the program; its text is for the program's user.
    virtual Result<Admission> admitProgram(pid_t pid) = 0;
    // It was sent its Welcome (or not: then the socket is invalid and the admission void).
    virtual void programWelcomed(uint32_t client, FileDescriptor socket) = 0;
};

struct CaptureAddresses {
    std::string abstractName; // reached from the head's network namespace
    std::string path;         // reached from its mount namespace; empty: none
};

class CaptureServer {
public:
    // digest: of the command table, must be equal at both ends.
    // status: the session's state as JSON, for `mural stat`; called by the server's thread.
    static Result<std::unique_ptr<CaptureServer>> start(const CaptureAddresses& addresses,
                                                        uint64_t digest,
                                                        ProgramHost& host,
                                                        std::function<std::string()> status);
    CaptureServer(const CaptureServer&) = delete;
    CaptureServer& operator=(const CaptureServer&) = delete;
    ~CaptureServer(); // stops

private:
    struct Newcomer {
        FileDescriptor socket;
        Deadline deadline;
        bool mayTakeLong = false; // past the deadline it keeps its place until another one needs it
        capture::Hello hello{};
        size_t haveBytes = 0; // of hello
    };

    CaptureServer(FileDescriptor listener, FileDescriptor pathListener, std::string path, uint64_t digest, ProgramHost& host, std::function<std::string()> status);
    void serve();
    void acceptOne(int listener);
    bool settle(Newcomer& newcomer, bool readable); // true: done with it, one way or the other
    void answer(FileDescriptor socket, const capture::Hello& hello);
    Result<Admission> judge(int socket, const capture::Hello& hello);
    void tellStatus(int socket);

    const FileDescriptor listener_;
    const FileDescriptor pathListener_; // not valid: there is none
    const std::string path_;
    const uint64_t digest_;
    ProgramHost& host_;
    const std::function<std::string()> status_;
    std::vector<Newcomer> newcomers_; // connected, Hello not complete yet
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace mural
