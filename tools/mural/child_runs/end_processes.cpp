#include "tools/mural/child_runs/end_processes.hpp"

#include <csignal>
#include <poll.h>
#include <unistd.h>

#include "nodes/launch/process_tree.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kKillMs = 10'000;
constexpr int kKillTurnMs = 20;

} // namespace

void killOrphans(pid_t display) {
    for (const Deadline deadline = Deadline::inMs(kKillMs); !deadline.passed(); poll(nullptr, 0, kKillTurnMs)) {
        launch::reapAdopted({display});
        const auto left = launch::descendantsOf(getpid(), {display});
        if (left.empty()) return;
        for (const launch::ProcessFacts& p : left) kill(p.pid, SIGKILL);
    }
}

void endWithAll(launch::ChildProcess& child, pid_t display, int64_t graceMs) {
    for (int time = 0; time < 2; ++time) {
        child.signal(SIGTERM);
        if (child.waitUntil(Deadline::inMs(graceMs))) return;
    }
    child.end(Deadline::inMs(0));
    killOrphans(display);
}

} // namespace mural::cli
