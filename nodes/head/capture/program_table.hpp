// The captured programs of the session. Admits programs, lists the current ones, and keeps the numbers of ended ones
// for the report.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/head/capture/capture_client.hpp"
#include "nodes/head/capture/capture_server.hpp"
#include "nodes/head/session/session_status.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

struct ProgramTerms {
    capture::Welcome welcome{}; // equal for all programs except the id
    std::string extensions;
    capture::ProgramKind kind = capture::ProgramKind::Captured; // of the programs that the nodes can draw
    uint32_t latency = 1;                                       // of the start; setLatency() changes it
    uint32_t chunkCount = capture::kDefaultChunks;
    FrameStatistics* statistics = nullptr; // null: none
    SentFrames* sentFrames = nullptr;      // null: none
};

// Thread-safe, except that drainAll(), reap() and endAll() need one thread.
class ProgramTable : public ProgramHost, public CaptureEvents {
public:
    struct Events {
        std::function<void(const CaptureClient& client)> came; // called before its first packet
        std::function<void(size_t count)> countChanged;
        std::function<void(uint32_t client)> gone;
    };

    ProgramTable(ProgramTerms terms, StreamBroadcaster& nodes, Events events);
    ~ProgramTable() override;

    Result<Admission> admitProgram(pid_t pid, capture::ProgramKind kind) override;
    void programWelcomed(uint32_t client, FileDescriptor socket) override;
    void programEnded(uint32_t client, const std::string& problem) override;

    void refuseFrom(const std::string& reason); // refuses programs from now on; call before drainAll()
    void reply(uint32_t client, Reply reply);
    // Reports to programs with the native API that a node has become a member of the session, or is no longer one.
    // `name`: for messages. Later programs receive the members first.
    void memberCame(int node, const std::string& name);
    void memberLost(int node);
    void driverEvent(const wire::DriverEvent& event, const std::string& text);
    // Sets the frames that programs may be ahead of the nodes, for current and later programs. Each program applies the
    // value from its next swap on; a waiting one continues at once if the value permits it.
    void setLatency(uint32_t frames);
    [[nodiscard]] uint32_t latency() const;
    void credit(uint32_t client, uint32_t finished, uint32_t shown);
    // While the X server does not answer, the credit does not wait for the program's windows.
    void displayBlocked(uint32_t client, bool isBlocked);
    // Returns true if the program itself puts this picture into its window (capture::OwnWindow). `done` is called when
    // the program has the picture.
    bool giveOwnPicture(uint32_t client, uint32_t frame, uint64_t nativeWindow, const Picture& picture,
                        std::function<void()> done);
    // See CaptureMemory. Without such a program, an overlay may be drawn.
    bool beginOverlay(uint32_t client);
    void endOverlay(uint32_t client);
    void beat();           // sends the heartbeat to all programs; called by the main loop
    void reportHeadGone(); // all programs continue without Mural

    // Sends everything published before this call to the nodes and ends the pumps. Replies and credit still reach the
    // programs. Calls `tick` meanwhile.
    void drainAll(Deadline deadline, const std::function<void()>& tick);
    void reap();   // joins the threads of ended programs
    void endAll(); // informs the programs and joins all threads; requires that no node blocks a pump

    // Returns the name of an X display of the program, even after its end. Empty: unknown.
    [[nodiscard]] std::string displayName(uint32_t client, uint32_t number) const;
    [[nodiscard]] CaptureCounts counts() const;              // sum over current and ended programs
    [[nodiscard]] std::vector<ProgramStatus> status() const; // current programs, without their frames

private:
    static Reply memberReply(int node, const std::string& name);
    void reportMember(int node, const std::string& name); // requires mutex_
    using Clients = std::map<uint32_t, std::shared_ptr<CaptureClient>>;
    struct Progress { // latest progress sent to a program
        uint32_t finished = 0, shown = 0;
        bool isBlocked = false; // its X server does not answer
    };

    std::shared_ptr<CaptureClient> find(uint32_t client) const;
    std::vector<std::shared_ptr<CaptureClient>> all() const;
    [[nodiscard]] bool anyAdmitted() const;
    void publishProgress(CaptureClient& client, const Progress& progress) const;
    static void addCounts(CaptureCounts& sum, const CaptureCounts& counts);

    const ProgramTerms terms_;
    StreamBroadcaster& nodes_;
    const Events events_;

    mutable std::mutex mutex_; // guards the members below
    std::string refusal_;
    std::map<int, std::string> members_; // names of the nodes
    bool headGone_ = false;
    uint32_t nextId_ = 1;
    uint32_t latency_;
    Clients admitted_; // no Welcome was sent yet
    Clients clients_;
    std::map<uint32_t, Progress> progress_;
    std::vector<std::shared_ptr<CaptureClient>> gone_;
    CaptureCounts goneCounts_;
    // of ended programs with windows, because pictures may follow
    std::map<uint32_t, std::vector<std::string>> goneDisplays_;
};

} // namespace mural
