#include "transport/fabric/fabric_provider.hpp"

#include <algorithm>
#include <cstring>
#include <rdma/fi_domain.h>

#include "transport/fabric/fabric_message.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural::fabric {

namespace {

constexpr uint32_t kApiVersion = FI_VERSION(1, 11);
constexpr const char* kProvider = "provider";

Result<std::string> providerWanted(const ConnectionDescription& description) {
    std::string wanted;
    for (const auto& [name, value] : description.parameters) {
        if (name != kProvider) return Error{toText(description) + ": unknown parameter \"" + name + "\"; use provider"};
        wanted = value;
    }
    return wanted;
}

// Both ends post a fixed number of buffers, whose memory may require registration.
Info makeHints(const std::string& provider) {
    Info hints(fi_allocinfo());
    if (!hints) return hints;
    hints->caps = FI_MSG;
    hints->mode = FI_CONTEXT | FI_CONTEXT2;
    hints->ep_attr->type = FI_EP_MSG;
    hints->domain_attr->mr_mode = FI_MR_LOCAL | FI_MR_ALLOCATED | FI_MR_PROV_KEY | FI_MR_VIRT_ADDR;
    hints->domain_attr->threading = FI_THREAD_DOMAIN;
    hints->tx_attr->inject_size = kHeaderBytes;
    hints->tx_attr->size = kSends + kControls;
    hints->rx_attr->size = kReceives;
    if (!provider.empty()) hints->fabric_attr->prov_name = strdup(provider.c_str());
    return hints;
}

// Resolves names first, because libfabric would do so without a deadline.
Result<std::vector<std::string>> numbersOf(const ConnectionDescription& description, Role role, Deadline deadline) {
    if (description.host.empty() || description.host == "*") return std::vector<std::string>{""};
    auto found = resolveTcp(description.host, description.port,
                            role == Role::Listen ? TcpRole::Listen : TcpRole::Connect, deadline);
    if (!found) { // its text begins with tcp://...
        const size_t reason = tcpText(description.host, description.port).size();
        return Error{toText(description) + found.error().message.substr(reason)};
    }
    std::vector<std::string> numbers;
    for (const TcpAddress& each : *found) numbers.push_back(numericText(each));
    return numbers;
}

} // namespace

Result<std::vector<Info>> findProviders(const ConnectionDescription& description, Role role, Deadline deadline) {
    const auto wanted = providerWanted(description);
    if (!wanted) return wanted.error();
    const auto numbers = numbersOf(description, role, deadline);
    if (!numbers) return numbers.error();
    const Info hints = makeHints(wanted.value());
    if (!hints) return Error{toText(description) + ": out of memory"};
    const std::string port = std::to_string(description.port);
    std::vector<Info> all;
    int code = 0;
    for (const std::string& number : numbers.value()) {
        fi_info* list = nullptr;
        const uint64_t flags = (role == Role::Listen ? FI_SOURCE : 0) | (number.empty() ? 0 : FI_NUMERICHOST);
        const int answer =
            fi_getinfo(kApiVersion, number.empty() ? nullptr : number.c_str(), port.c_str(), flags, hints.get(), &list);
        if (answer != 0) code = answer;
        while (list) { // splits the list into single entries
            fi_info* next = std::exchange(list->next, nullptr);
            all.emplace_back(list);
            list = next;
        }
    }
    if (!all.empty()) return all;
    return Error{toText(description) + ": libfabric has no provider for it" +
                 (code == 0 ? "" : " (" + codeText(code) + ")") + "; fi_info -t FI_EP_MSG lists the providers"};
}

Result<SharedFabric> openFabric(const fi_info& info) {
    fid_fabric* fabric = nullptr;
    if (const int code = fi_fabric(info.fabric_attr, &fabric, nullptr); code != 0)
        return Error{"fabric: cannot open the provider " + providerOf(info) + ": " + codeText(code) +
                     "; try another one with provider=NAME"};
    return SharedFabric(fabric, CloseFid());
}

std::string fabricText(const std::string& host, uint16_t port, const std::string& provider) {
    return "fabric://" + endpointText(host, port) + "?" + kProvider + "=" + provider;
}

std::string fabricText(const void* address, size_t sizeBytes, const std::string& provider,
                       const std::string& otherwise) {
    SocketAddress ip;
    ip.sizeBytes = static_cast<socklen_t>(std::min(sizeBytes, sizeof ip.storage));
    std::memcpy(&ip.storage, address, ip.sizeBytes);
    if (ip.family() != AF_INET && ip.family() != AF_INET6) return otherwise;
    return fabricText(numericText(ip), tcpPort(ip), provider);
}

std::string providerOf(const fi_info& info) { return info.fabric_attr->prov_name ? info.fabric_attr->prov_name : "?"; }

} // namespace mural::fabric
