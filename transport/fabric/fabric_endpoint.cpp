#include "transport/fabric/fabric_endpoint.hpp"

#include <cstdlib>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "transport/fabric/fabric_provider.hpp"

namespace mural::fabric {

namespace {

constexpr size_t kPageBytes = 4096;
constexpr int64_t kWaitSliceMs = 1000; // bounds the damage of a provider that misses a wake-up

Error cannot(const std::string& provider, const char* what, long code) {
    return Error{"fabric (" + provider + "): cannot " + what + ": " + codeText(code) +
                 "; try another provider with provider=NAME"};
}

} // namespace

Result<std::unique_ptr<Endpoint>> Endpoint::open(const SharedFabric& fabric, fi_info& info) {
    std::unique_ptr<Endpoint> made(new Endpoint);
    made->fabric_ = fabric;
    made->provider_ = providerOf(info);
    const auto* address = static_cast<const std::byte*>(info.dest_addr);
    if (address) made->address_.assign(address, address + info.dest_addrlen);
    auto events = EventQueue::open(fabric);
    if (!events) return events.error();
    made->events_ = std::move(*events);
    made->wake_ = FileDescriptor(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
    if (!made->wake_.valid()) return Error{"fabric: too many open files; raise the limit (ulimit -n)"};
    fid_domain* domain = nullptr;
    if (const int code = fi_domain(fabric.get(), &info, &domain, nullptr); code != 0)
        return cannot(made->provider_, "open the card", code);
    made->domain_.reset(domain);
    if (auto r = made->openQueue(domain); !r) return r.error();
    if (auto r = made->openMemory(domain); !r) return r.error();
    if (auto r = made->openEndpoint(domain, info); !r) return r.error();
    return made;
}

// Operations end with the endpoint, so it is destroyed before their memory and contexts.
Endpoint::~Endpoint() { endpoint_.reset(); }

Result<void> Endpoint::openQueue(fid_domain* domain) {
    fi_cq_attr attributes{};
    attributes.size = kReceives + kSends + kControls;
    attributes.format = FI_CQ_FORMAT_MSG;
    attributes.wait_obj = FI_WAIT_FD;
    fid_cq* queue = nullptr;
    if (const int code = fi_cq_open(domain, &attributes, &queue, nullptr); code != 0)
        return cannot(provider_, "open a completion queue", code);
    queue_.reset(queue);
    if (const int code = fi_control(&queue->fid, FI_GETWAIT, &queueDescriptor_); code != 0)
        return cannot(provider_, "wait for completions with a descriptor", code);
    return {};
}

Result<void> Endpoint::openMemory(fid_domain* domain) {
    const size_t sizeBytes = (kReceives + kSends) * kMessageBytes;
    memory_.reset(static_cast<std::byte*>(std::aligned_alloc(kPageBytes, sizeBytes)));
    if (!memory_) return cannot(provider_, "allocate memory for messages", FI_ENOMEM);
    fid_mr* registered = nullptr;
    if (const int code = fi_mr_reg(domain, memory_.get(), sizeBytes, FI_SEND | FI_RECV, 0, 1, 0, &registered, nullptr);
        code != 0)
        return cannot(provider_, "register memory (the limit of locked memory, ulimit -l, may be too low)", code);
    registered_.reset(registered);
    return {};
}

Result<void> Endpoint::openEndpoint(fid_domain* domain, fi_info& info) {
    fid_ep* endpoint = nullptr;
    if (const int code = fi_endpoint(domain, &info, &endpoint, nullptr); code != 0)
        return cannot(provider_, "open an endpoint", code);
    endpoint_.reset(endpoint);
    int code = fi_ep_bind(endpoint, &events_.get()->fid, 0);
    if (code == 0) code = fi_ep_bind(endpoint, &queue_->fid, FI_TRANSMIT | FI_RECV);
    if (code == 0) code = fi_enable(endpoint);
    if (code != 0) return cannot(provider_, "enable an endpoint", code);
    for (Slot slot = 0; slot < kReceives; ++slot) {
        if (const long posted = receive(slot); posted != 0) return cannot(provider_, "receive", posted);
    }
    return {};
}

Result<Greeting> Endpoint::connect(Deadline deadline) {
    const auto own = makeGreeting();
    if (const int code = fi_connect(endpoint_.get(), address_.data(), own.data(), own.size()); code != 0)
        return Error{"cannot connect: " + codeText(code) + "; check the address and the provider"};
    const auto answer = awaitConnected(deadline);
    if (!answer) return answer.error();
    if (const auto greeting = readGreeting(answer.value())) return *greeting;
    return Error{"the peer is not a Mural of this version; check the address and both versions"};
}

Result<void> Endpoint::accept(Deadline deadline) {
    const auto own = makeGreeting();
    if (const int code = fi_accept(endpoint_.get(), own.data(), own.size()); code != 0)
        return Error{"cannot accept: " + codeText(code)};
    const auto connected = awaitConnected(deadline);
    if (!connected) return connected.error();
    return {};
}

Result<std::vector<std::byte>> Endpoint::awaitConnected(Deadline deadline) {
    Event event = events_.next(deadline);
    switch (event.kind) {
    case Event::Kind::Connected: return std::move(event.greeting);
    case Event::Kind::Failed:
        return Error{"cannot connect: " + codeText(event.code) + "; check that the peer listens there"};
    case Event::Kind::None:
        return Error{"deadline passed without a reply; check the address, and that the peer accepts connections"};
    default: return Error{"the peer disconnected during the connection setup; see its messages"};
    }
}

long Endpoint::receive(Slot slot) {
    return fi_recv(endpoint_.get(), memory(slot).data(), kMessageBytes, fi_mr_desc(registered_.get()), 0,
                   &contexts_[slot]);
}

long Endpoint::send(Slot slot, size_t sizeBytes) {
    return fi_send(endpoint_.get(), memory(slot).data(), sizeBytes, fi_mr_desc(registered_.get()), 0, &contexts_[slot]);
}

long Endpoint::inject(const Header& header) { return fi_inject(endpoint_.get(), header.data(), header.size(), 0); }

int Endpoint::completions(std::span<Completion> into, long& code) {
    std::array<fi_cq_msg_entry, 16> entries{};
    const ssize_t got = fi_cq_read(queue_.get(), entries.data(), std::min(entries.size(), into.size()));
    if (got == -FI_EAGAIN) return 0;
    if (got == -FI_EAVAIL) {
        fi_cq_err_entry why{};
        code = fi_cq_readerr(queue_.get(), &why, 0) > 0 ? why.err : FI_EIO;
        return -1;
    }
    if (got < 0) {
        code = got;
        return -1;
    }
    for (size_t i = 0; i < static_cast<size_t>(got); ++i) {
        const auto* context = static_cast<const Context*>(entries[i].op_context);
        into[i] = {static_cast<Slot>(context - contexts_.data()), entries[i].len};
    }
    return static_cast<int>(got);
}

bool Endpoint::shutDownMeanwhile() {
    const Event event = events_.next(Deadline::inMs(0));
    return event.kind == Event::Kind::Shutdown || event.kind == Event::Kind::Failed;
}

bool Endpoint::mayExpectWakeUp() {
    fid* waited[] = {&queue_->fid, &events_.get()->fid};
    return fi_trywait(fabric_.get(), waited, 2) == 0;
}

bool Endpoint::sleep(Deadline deadline) {
    pollfd polled[] = {{queueDescriptor_, POLLIN, 0}, {events_.descriptor(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
    const int64_t leftNs = deadline.leftNs(kWaitSliceMs * kNsPerMs);
    // interrupted: the caller polls again
    const int ready = poll(polled, 3, static_cast<int>((leftNs + kNsPerMs - 1) / kNsPerMs));
    if (polled[2].revents != 0) {
        eventfd_t times = 0;
        eventfd_read(wake_.get(), &times);
    }
    return ready <= 0 || polled[1].revents != 0;
}

void Endpoint::wake() { eventfd_write(wake_.get(), 1); }

std::string Endpoint::peerText(const std::string& otherwise) const {
    sockaddr_storage address{};
    size_t sizeBytes = sizeof address;
    if (fi_getpeer(endpoint_.get(), &address, &sizeBytes) != 0) return otherwise;
    return fabricText(&address, sizeBytes, provider_, otherwise);
}

} // namespace mural::fabric
