#include "tools/mural/network/probe_sockets.hpp"

#include <poll.h>

#include "transport/tcp/tcp_address.hpp"

namespace mural::cli {

namespace {
// Experimental address: never forwarded, and never filtered by snooping switches (RFC 3692, RFC 4541).
constexpr const char* kLinkLocal4 = "224.0.0.254";
constexpr const char* kLinkLocal6 = "ff02::114";
} // namespace

Result<ProbeSockets> ProbeSockets::open(const SocketAddress& group, const rsp::NetworkInterface& interface,
                                        uint64_t survey, bool doctor) {
    auto linkLocal = numericAddress(group.family() == AF_INET ? kLinkLocal4 : kLinkLocal6, tcpPort(group));
    if (!linkLocal) return linkLocal.error();
    auto own = rsp::UdpSocket::openOwn(interface, group.family(), kWantedBufferBytes);
    if (!own) return own.error();
    ProbeSockets sockets(std::move(*own), survey, doctor);
    sockets.group_ = group;
    sockets.linkLocal_ = *linkLocal;
    const auto join = [&](ProbePath path, const SocketAddress& address, std::optional<rsp::UdpSocket>& into) {
        auto socket = rsp::UdpSocket::openGroup(address, interface, kWantedBufferBytes);
        if (socket)
            into.emplace(std::move(*socket));
        else
            sockets.troubles_[static_cast<size_t>(path)] = socket.error().message;
    };
    join(ProbePath::Group, group, sockets.inGroup_);
    join(ProbePath::LinkLocal, *linkLocal, sockets.inLinkLocal_);
    return sockets;
}

uint16_t ProbeSockets::port() const { return tcpPort(own_.localAddress()); }

void ProbeSockets::send(ProbePath path, size_t sizeBytes, const SocketAddress& single) {
    std::vector<std::byte> datagram(sizeBytes);
    writeProbe({survey_, path, doctor_, static_cast<uint16_t>(sizeBytes)}, datagram);
    const SocketAddress& to = path == ProbePath::Single ? single : path == ProbePath::Group ? group_ : linkLocal_;
    // A rejected long datagram is not reported as an error; it is missing in the arrivals.
    if (auto r = own_.send(to, datagram, sizeBytes); !r && sizeBytes == kMinProbeBytes)
        troubles_[static_cast<size_t>(path)] = r.error().message;
}

void ProbeSockets::receive(rsp::UdpSocket& socket, bool multicast) {
    do {
        for (const rsp::UdpSocket::Datagram& d : socket.fetch()) {
            const auto probe = readProbe(d.bytes);
            if (!probe || probe->survey != survey_ || probe->fromDoctor == doctor_ ||
                (probe->path != ProbePath::Single) != multicast)
                continue;
            ++seen_[{probe->path, probe->sizeBytes}];
        }
    } while (socket.mayBeMore());
}

bool ProbeSockets::listen(Deadline deadline, int alsoFd) {
    while (true) {
        std::array<pollfd, 4> polled{{{own_.descriptor(), POLLIN, 0},
                                      {inGroup_ ? inGroup_->descriptor() : -1, POLLIN, 0},
                                      {inLinkLocal_ ? inLinkLocal_->descriptor() : -1, POLLIN, 0},
                                      {alsoFd, POLLIN, 0}}};
        const int64_t leftNs = deadline.leftNs(kNsPerS);
        (void)poll(polled.data(), polled.size(), static_cast<int>((leftNs + kNsPerMs - 1) / kNsPerMs));
        receive(own_, false);
        if (inGroup_) receive(*inGroup_, true);
        if (inLinkLocal_) receive(*inLinkLocal_, true);
        if (polled[3].revents != 0) return true;
        if (deadline.passed()) return false;
    }
}

} // namespace mural::cli
