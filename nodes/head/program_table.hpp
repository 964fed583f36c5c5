// The captured programs of the session: who may come in, who is there, and what those that have gone
// left for the report.
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

#include "nodes/head/capture_client.hpp"
#include "nodes/head/capture_server.hpp"
#include "nodes/head/session_status.hpp"

namespace mural {

struct ProgramTerms {
    capture::Welcome welcome{}; // alike for all programs but for the id
    std::string extensions;
    bool framesDoneWhenShown = false; // --display app without latency
    uint32_t chunkCount = capture::kDefaultChunks;
};

// All calls from any thread but for drainAll(), reap() and endAll() (one thread).
class ProgramTable : public ProgramHost, public CaptureEvents {
public:
    struct Events {
        std::function<void(const CaptureClient& client)> came; // before its first packet
        std::function<void(size_t count)> countChanged;
        std::function<void(uint32_t client, const std::string& line)> gone; // line: for the user, or empty
    };

    ProgramTable(ProgramTerms terms, NodeSet& nodes, Events events);
    ~ProgramTable() override;

    Result<Admission> admitProgram(pid_t pid) override;
    void programWelcomed(uint32_t client, FileDescriptor socket) override;
    void programEnded(uint32_t client, const std::string& problem) override;

    void refuseFrom(const std::string& reason); // programs that come from now on; before drainAll()
    void reply(uint32_t client, Reply reply);
    void news(const wire::News& news, const std::string& text);
    void credit(uint32_t client, uint32_t finished, uint32_t shown);
    // Credit does not wait for the program's windows while its X server does not answer.
    void displayBlocked(uint32_t client, bool isBlocked);
    // True: the program puts this picture into its window itself (capture::OwnWindow); `done` is called when it has it.
    bool giveOwnPicture(uint32_t client, uint32_t frame, uint64_t nativeWindow, const Picture& picture, std::function<void()> done);
    void beat();         // tells all programs that the head runs; from its main loop
    void tellHeadGone(); // all programs go on alone

    // Everything published at this moment goes to the nodes; the pumps end, answers and credit still
    // reach the programs. `tick` is called meanwhile.
    void drainAll(Deadline deadline, const std::function<void()>& tick);
    void reap();    // joins the threads of programs that have gone
    void endAll();  // tells them and joins all; the nodes must not hold a pump up any more

    // Of an X display of the program, which may have ended; empty: not told.
    [[nodiscard]] std::string displayName(uint32_t client, uint32_t number) const;
    [[nodiscard]] CaptureCounts counts() const; // over all programs, past and present
    [[nodiscard]] std::vector<ProgramStatus> status() const; // of those that are there, but for their frames

private:
    using Clients = std::map<uint32_t, std::shared_ptr<CaptureClient>>;
    struct Progress { // of a program, as it was told last
        uint32_t finished = 0, shown = 0;
        bool isBlocked = false; // its X server does not answer
    };

    std::shared_ptr<CaptureClient> find(uint32_t client) const;
    std::vector<std::shared_ptr<CaptureClient>> all() const;
    [[nodiscard]] bool anyAdmitted() const;
    void tellProgress(CaptureClient& client, const Progress& progress) const;
    static void addCounts(CaptureCounts& sum, const CaptureCounts& counts);

    const ProgramTerms terms_;
    NodeSet& nodes_;
    const Events events_;

    mutable std::mutex mutex_; // what follows
    std::string refusal_;
    bool headGone_ = false;
    uint32_t nextId_ = 1;
    Clients admitted_; // not welcomed yet
    Clients clients_;
    std::map<uint32_t, Progress> progress_;
    std::vector<std::shared_ptr<CaptureClient>> gone_;
    CaptureCounts goneCounts_;
    std::map<uint32_t, std::vector<std::string>> goneDisplays_; // of programs with windows: pictures may come later
};

} // namespace mural
