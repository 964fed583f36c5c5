// The head's end of one or several starters: the command that reaches them, and its input and output.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/child_process.hpp"
#include "nodes/launch/launchers/launcher.hpp"
#include "nodes/launch/launchers/output_lines.hpp"
#include "nodes/launch/launchers/recent_lines.hpp"
#include "nodes/launch/launchers/starter/starter_protocol.hpp"

namespace mural::launch {

struct StarterCommand {
    std::vector<std::string> arguments;   // of the command that runs `mural starter`
    std::vector<std::string> environment; // NAME=value
    std::string name;                     // for messages: "ssh to wall1"
    std::string version, build;           // of this mural; starters must have the same
    std::string onlyHost;                 // of the only starter, as the user named it; empty: hosts name themselves
    int signalWhenWeDie = 15;             // to the command, when this process is killed
    // Returns the hosts whose starter has ended, according to a line that is no message. May be empty.
    std::function<std::vector<std::string>(std::string_view line)> lostHosts;
    // Adds the remedy to a description of the command's end. May be empty.
    std::function<std::string(const std::string& how)> addRemedy;
};

// Thread-safe, except start(). Nodes share it: it ends with its last user.
class StarterLink : public std::enable_shared_from_this<StarterLink> {
public:
    // Call from a thread that outlives it (PR_SET_PDEATHSIG). The process must ignore SIGPIPE.
    static Result<std::shared_ptr<StarterLink>> start(StarterCommand command);
    StarterLink(const StarterLink&) = delete;
    StarterLink& operator=(const StarterLink&) = delete;
    ~StarterLink(); // ends the starters, and so their nodes

    // Prepares the start of a node; send() starts it. host: the starter that obeys.
    struct Prepared {
        std::unique_ptr<RunningNode> node;
        std::string line; // to send
    };
    Prepared prepare(const NodeTask& task, const std::string& host);
    // Sends a line to all starters, without the newline.
    void send(const std::string& line);

    // Ends the starters. end() waits for the command, and ends it after the deadline.
    void closeInput();
    void end(Deadline deadline);

    // Returns how the command ended; nothing while it runs.
    std::optional<std::string> ended();
    // True if the starter of this host has ended or differs, or the command has ended.
    bool isGone(const std::string& host);
    // Records that the starter of a host has ended.
    void setGone(const std::string& host, const std::string& why);
    [[nodiscard]] std::string recentOutput() const { return noise_.text(); }

private:
    class Node;
    struct State {
        int node = 0;
        std::string host;
        pid_t pid = 0;
        std::optional<std::string> ended;
        bool isHostGone = false;                // it has ended with its starter…
        Deadline lastLines = Deadline::never(); // …whose last lines may arrive until then
        RecentLines lines;
    };

    StarterLink(StarterCommand command, ChildProcess process, FileDescriptor input);
    void read(FileDescriptor output, FileDescriptor errors);
    void takeOutput(std::string_view line);
    void takeNoise(std::string_view line);
    void checkHello(const StarterReply& hello);
    std::shared_ptr<State> stateOf(int id);
    std::optional<std::string> endOf(State& state);

    const StarterCommand command_;
    RecentLines noise_;
    std::mutex writing_;
    FileDescriptor input_; // guarded by writing_
    std::mutex mutex_;     // guards the members below
    ChildProcess process_;
    std::optional<std::string> end_;
    bool isGreeted_ = false;                       // a starter runs
    std::map<int, std::shared_ptr<State>> states_; // by id
    std::map<std::string, std::string> gone_;      // by host: why
    int nextId_ = 1;
    std::unique_ptr<OutputLines> output_, errors_; // set by start()
};

} // namespace mural::launch
