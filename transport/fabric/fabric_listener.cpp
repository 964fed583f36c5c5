// Listens with a passive libfabric endpoint; its requests become connections.
#include <algorithm>
#include <rdma/fi_cm.h>
#include <rdma/fi_endpoint.h>
#include <sys/socket.h>
#include <unistd.h>

#include "transport/fabric/fabric_connect.hpp"
#include "transport/fabric/fabric_connection.hpp"
#include "transport/fabric/fabric_provider.hpp"

namespace mural::fabric {

namespace {

constexpr int64_t kLookupMs = 5000;
constexpr int64_t kHandshakeMs = 5000; // timeout of a present peer's handshake

class FabricListener final : public Listener {
public:
    static Result<std::unique_ptr<Listener>> open(fi_info& info, const ConnectionDescription& at);
    // A forked child leaves the parent's resources alone.
    ~FabricListener() override {
        if (getpid() != ownerPid_) (void)passive_.release();
    }

    Result<std::unique_ptr<Connection>> accept(Deadline deadline) override;
    [[nodiscard]] std::string describe() const override { return description_; }

private:
    FabricListener() = default;
    Result<std::unique_ptr<Connection>> accept(Event request, Deadline deadline);

    SharedFabric fabric_;
    EventQueue events_;
    Handle<fid_pep> passive_;
    std::string provider_;
    std::string description_;
    pid_t ownerPid_ = getpid();
};

// Peers cannot connect to the wildcard address, so the description contains this host's name.
std::string listenerText(const ConnectionDescription& at, fid_pep& passive, const std::string& provider) {
    sockaddr_storage address{};
    size_t sizeBytes = sizeof address;
    if (fi_getname(&passive.fid, &address, &sizeBytes) != 0) return fabricText(at.host, at.port, provider);
    const std::string bound = fabricText(&address, sizeBytes, provider, fabricText(at.host, at.port, provider));
    char name[256] = "";
    const bool any = at.host.empty() || at.host == "*";
    if (!any || gethostname(name, sizeof name - 1) != 0 || name[0] == 0) return bound;
    return fabricText(name, parseConnectionDescription(bound)->port, provider);
}

Result<std::unique_ptr<Listener>> FabricListener::open(fi_info& info, const ConnectionDescription& at) {
    const auto fabric = openFabric(info);
    if (!fabric) return fabric.error();
    auto events = EventQueue::open(fabric.value());
    if (!events) return events.error();
    std::unique_ptr<FabricListener> made(new FabricListener);
    made->fabric_ = fabric.value();
    made->events_ = std::move(*events);
    made->provider_ = providerOf(info);
    fid_pep* passive = nullptr;
    int code = fi_passive_ep(made->fabric_.get(), &info, &passive, nullptr);
    if (code == 0) {
        made->passive_.reset(passive);
        code = fi_pep_bind(passive, &made->events_.get()->fid, 0);
    }
    if (code == 0) code = fi_listen(passive);
    if (code != 0) {
        return Error{fabricText(at.host, at.port, made->provider_) + ": cannot listen: " + codeText(code) +
                     "; choose another port, address or provider"};
    }
    made->description_ = listenerText(at, *passive, made->provider_);
    return std::unique_ptr<Listener>(std::move(made));
}

// A peer that gives up before it is accepted, or that is not Mural, is not an error of the listener.
Result<std::unique_ptr<Connection>> FabricListener::accept(Deadline deadline) {
    while (true) {
        Event event = events_.next(deadline);
        if (event.kind == Event::Kind::Request) {
            auto made = accept(std::move(event), deadline);
            if (made || deadline.passed()) return made;
        } else if (event.kind == Event::Kind::None) {
            return Error{
                description_ +
                ": deadline passed without a connection; check that the peer was started and can connect to this port"};
        } else if (event.kind == Event::Kind::Failed && !event.passing()) {
            return Error{description_ + ": accept: " + codeText(event.code) + "; listen again"};
        }
    }
}

Result<std::unique_ptr<Connection>> FabricListener::accept(Event request, Deadline deadline) {
    const auto greeting = readGreeting(request.greeting);
    if (!greeting) {
        fi_reject(passive_.get(), request.info->handle, nullptr, 0);
        return Error{description_ + ": the peer is not a Mural of this version; check both versions"};
    }
    auto endpoint = Endpoint::open(fabric_, *request.info);
    if (!endpoint) {
        fi_reject(passive_.get(), request.info->handle, nullptr, 0);
        return Error{description_ + ": " + endpoint.error().message};
    }
    const int64_t leftMs = deadline.leftNs(kHandshakeMs * kNsPerMs) / kNsPerMs + 1;
    if (auto connected = (*endpoint)->accept(Deadline::inMs(leftMs)); !connected)
        return Error{description_ + ": " + connected.error().message};
    std::string peer = (*endpoint)->peerText(description_);
    return std::unique_ptr<Connection>(
        std::make_unique<FabricConnection>(std::move(*endpoint), *greeting, std::move(peer)));
}

} // namespace

Result<std::unique_ptr<Listener>> listenFabric(const ConnectionDescription& at) {
    auto providers = findProviders(at, Role::Listen, Deadline::inMs(kLookupMs));
    if (!providers) return providers.error();
    Error first;
    for (size_t i = 0; i < providers->size(); ++i) {
        auto made = FabricListener::open(*(*providers)[i], at);
        if (made) return made;
        if (i == 0) first = made.error();
    }
    return first;
}

} // namespace mural::fabric
