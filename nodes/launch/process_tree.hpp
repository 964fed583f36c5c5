// Who descends from this process, by /proc. With PR_SET_CHILD_SUBREAPER every orphan below us becomes
// our child, so nothing that a program leaves behind is lost from sight.
#pragma once

#include <set>
#include <sys/types.h>
#include <vector>

namespace mural::launch {

struct ProcessFacts {
    pid_t pid = 0;
    pid_t parent = 0;
    pid_t session = 0;
    char state = '?'; // as in /proc/PID/stat; 'Z': ended, not yet waited for
};

// Makes orphans of our descendants our children.
void adoptOrphans();

// All processes below `root`, without those in `except` and what is below them.
std::vector<ProcessFacts> descendantsOf(pid_t root, const std::set<pid_t>& except);

// Waits for adopted children that have ended; those in `known` are someone else's to wait for.
void reapAdopted(const std::set<pid_t>& known);

} // namespace mural::launch
