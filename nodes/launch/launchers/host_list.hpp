// Lists of hosts: Slurm's compressed form, and host files. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::launch {

constexpr size_t kMaxHosts = 65'536;

// Expands "wall[1-3,07],gpu2,r[1-2]n[1-4]", as Slurm writes SLURM_JOB_NODELIST (man scontrol, hostlist expressions).
// Numbers keep their leading zeros. Errors: brackets, an invalid range, more than kMaxHosts hosts.
Result<std::vector<std::string>> expandHostList(std::string_view text);

// One host of a host file, and the number of nodes on it.
struct HostEntry {
    std::string name;
    int nodes = 0; // 0: not given
};

// Reads a host file: one host per line, then optionally `slots=N`, as Open MPI's, or `:N` after the name, as MPICH's.
// `#` begins a comment. file: for errors, which name it and the line.
Result<std::vector<HostEntry>> hostsOfFile(std::string_view text, const std::string& file);

// True for a word that ssh and the others accept as a host: USER@HOST, an address, or @NAME of a waiting node.
bool isHostName(std::string_view word);

} // namespace mural::launch
