// Finds the descendants of this process through /proc. With PR_SET_CHILD_SUBREAPER orphaned descendants become its
// children, so none is lost.
#pragma once

#include <set>
#include <sys/types.h>
#include <vector>

namespace mural::launch {

struct ProcessFacts {
    pid_t pid = 0;
    pid_t parent = 0;
    pid_t session = 0;
    char state = '?'; // as in /proc/PID/stat; 'Z': a zombie
};

// Makes orphaned descendants children of this process.
void adoptOrphans();

// Returns all descendants of `root` except `except` and their descendants.
std::vector<ProcessFacts> descendantsOf(pid_t root, const std::set<pid_t>& except);

// Reaps adopted children that have ended. Children in `known` have other owners.
void reapAdopted(const std::set<pid_t>& known);

} // namespace mural::launch
