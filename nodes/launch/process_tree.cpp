#include "nodes/launch/process_tree.hpp"

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <dirent.h>
#include <map>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mural::launch {

namespace {

// Parses "pid (name) state ppid pgrp session …". The name may contain spaces and brackets, so the search starts at the
// end.
bool readFacts(pid_t pid, ProcessFacts& facts) {
    const std::string path = "/proc/" + std::to_string(pid) + "/stat";
    FILE* file = std::fopen(path.c_str(), "re");
    if (file == nullptr) return false;
    char text[1024];
    const size_t length = std::fread(text, 1, sizeof text - 1, file);
    std::fclose(file);
    const std::string_view line(text, length);
    const auto end = line.rfind(')');
    if (end == std::string_view::npos) return false;
    text[length] = '\0';
    int parent = 0;
    int group = 0;
    int session = 0;
    if (std::sscanf(text + end + 1, " %c %d %d %d", &facts.state, &parent, &group, &session) != 4) return false;
    facts.pid = pid;
    facts.parent = parent;
    facts.session = session;
    return true;
}

std::multimap<pid_t, ProcessFacts> allByParent() {
    std::multimap<pid_t, ProcessFacts> all;
    DIR* folder = opendir("/proc");
    if (folder == nullptr) return all;
    while (const dirent* entry = readdir(folder)) {
        if (std::isdigit(static_cast<unsigned char>(entry->d_name[0])) == 0) continue;
        ProcessFacts facts;
        if (readFacts(static_cast<pid_t>(std::atoi(entry->d_name)), facts)) all.emplace(facts.parent, facts);
    }
    closedir(folder);
    return all;
}

} // namespace

void adoptOrphans() { prctl(PR_SET_CHILD_SUBREAPER, 1); }

std::vector<ProcessFacts> descendantsOf(pid_t root, const std::set<pid_t>& except) {
    const auto byParent = allByParent();
    std::vector<ProcessFacts> found;
    std::vector<pid_t> open{root};
    while (!open.empty()) {
        const auto [first, last] = byParent.equal_range(open.back());
        open.pop_back();
        for (auto it = first; it != last; ++it) {
            if (except.count(it->second.pid) != 0) continue;
            found.push_back(it->second);
            open.push_back(it->second.pid);
        }
    }
    return found;
}

void reapAdopted(const std::set<pid_t>& known) {
    const pid_t self = getpid();
    for (const ProcessFacts& p : descendantsOf(self, known)) {
        if (p.parent == self && p.state == 'Z') waitpid(p.pid, nullptr, WNOHANG);
    }
}

} // namespace mural::launch
