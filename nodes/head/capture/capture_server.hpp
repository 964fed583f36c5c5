// The session's Unix sockets. Programs connect, send Hello and receive their shared memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

#include "common/ipc/capture_ring.hpp"
#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

struct Admission {
    capture::Welcome welcome{}; // the server sets refused, extensionBytes, magic and version
    int memoryFd = -1;          // owned by the ProgramHost
    std::string extensions;
};

// Admits programs. Called by the server's thread.
class ProgramHost {
public:
    virtual ~ProgramHost() = default;
    // Returns the admission. An error refuses the program; its text is shown to the program's user.
    virtual Result<Admission> admitProgram(pid_t pid, capture::ProgramKind kind) = 0;
    // Called after the Welcome was sent. An invalid socket means that it was not sent, and the admission is void.
    virtual void programWelcomed(uint32_t client, FileDescriptor socket) = 0;
};

struct CaptureAddresses {
    std::string abstractName; // reachable from the head's network namespace
    std::string path;         // reachable from its mount namespace; empty: none
};

class CaptureServer {
public:
    // digest: the digest of the command table, which must be equal at both ends.
    static Result<std::unique_ptr<CaptureServer>> start(const CaptureAddresses& addresses, uint64_t digest,
                                                        ProgramHost& host);
    CaptureServer(const CaptureServer&) = delete;
    CaptureServer& operator=(const CaptureServer&) = delete;
    ~CaptureServer(); // stops

private:
    struct Newcomer {
        FileDescriptor socket;
        Deadline deadline;
        bool mayTakeLong = false; // after the deadline it stays only until another program needs its place
        capture::Hello hello{};
        size_t haveBytes = 0; // received bytes of hello
    };

    CaptureServer(FileDescriptor listener, FileDescriptor pathListener, std::string path, uint64_t digest,
                  ProgramHost& host);
    void serve();
    void acceptOne(int listener);
    bool settle(Newcomer& newcomer, bool readable); // true: accepted or refused
    void answer(FileDescriptor socket, const capture::Hello& hello);
    Result<Admission> judge(int socket, const capture::Hello& hello);

    const FileDescriptor listener_;
    const FileDescriptor pathListener_; // invalid: no path
    const std::string path_;
    const uint64_t digest_;
    ProgramHost& host_;
    std::vector<Newcomer> newcomers_; // connected, with an incomplete Hello
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace mural
