#include "tools/mural/network/probe_command.hpp"

#include <algorithm>
#include <sstream>
#include <sys/socket.h>

#include "common/ipc/file_descriptor.hpp"
#include "nodes/launch/environment.hpp"
#include "transport/rsp/io/network_interface.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kResolveMs = 5'000;

// Quotes a word for the shell that the launch command runs on the host.
std::string quotedForShell(const std::string& word) {
    if (word.find_first_of(" \t\"'\\$`*?[]()<>|&;!#~") == std::string::npos) return word;
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

} // namespace

std::vector<std::string> splitWords(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);)
        if (!part.empty()) parts.push_back(part);
    return parts;
}

std::vector<std::string> probeCommand(const std::string& launchCommand, const std::string& remoteMural,
                                      const std::string& host) {
    std::vector<std::string> command = splitWords(launchCommand, ' ');
    for (const std::string& word :
         {host, quotedForShell(remoteMural.empty() ? launch::ownBinary() : remoteMural), std::string("network-member")})
        command.push_back(word);
    return command;
}

std::string ownAddressTowards(const std::string& host, int family) {
    auto addresses = resolveTcp(host.substr(host.find('@') + 1), 9, TcpRole::Connect, Deadline::inMs(kResolveMs));
    if (!addresses) return {};
    for (const TcpAddress& a : *addresses) {
        if (a.family() != family) continue;
        // Connecting a datagram socket sends nothing but selects the route.
        const FileDescriptor fd(::socket(a.family(), SOCK_DGRAM | SOCK_CLOEXEC, 0));
        if (::connect(fd.get(), a.get(), a.sizeBytes) == 0) return numericText(localTcpAddress(fd.get()));
    }
    return {};
}

std::vector<std::string> ownAddresses(const std::string& first, int family, bool withLoopback) {
    std::vector<std::string> texts;
    if (!first.empty()) texts.push_back(first);
    auto all = rsp::networkInterfaces();
    if (!all) return texts;
    for (const rsp::NetworkInterface& i : *all) {
        if (i.loopback && !withLoopback) continue;
        for (const SocketAddress& address : i.addresses) {
            const std::string text = numericText(address);
            if (address.family() != family) continue;
            if (text.find('%') == std::string::npos && std::ranges::find(texts, text) == texts.end())
                texts.push_back(text);
        }
    }
    return texts;
}

} // namespace mural::cli
