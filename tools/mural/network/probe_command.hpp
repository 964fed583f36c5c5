// Starts of probe processes on hosts: the command line, and the addresses under which a host finds this machine.
#pragma once

#include <string>
#include <vector>

namespace mural::cli {

std::vector<std::string> splitWords(const std::string& text, char separator);

// The command that starts `mural network-member` on a host. remoteMural: empty: the path of this binary.
std::vector<std::string> probeCommand(const std::string& launchCommand, const std::string& remoteMural,
                                      const std::string& host);

// Returns the source address that the kernel would use towards a host; empty for an unknown name or another family.
std::string ownAddressTowards(const std::string& host, int family);

// Returns this machine's addresses of the family, `first` before all others. Members answer datagrams to the address
// that they connect to.
std::vector<std::string> ownAddresses(const std::string& first, int family, bool withLoopback);

} // namespace mural::cli
