#include "tests/transport/rsp/simulated_stream.hpp"

#include <algorithm>

namespace mural::rsp::test {

namespace {

constexpr size_t kMaxHosts = 256;

std::byte byteAt(uint64_t place) { return static_cast<std::byte>((place * 0x9e3779b97f4a7c15u) >> 56); }

SenderSettings senderSettings(const StreamPlan& plan) {
    SenderSettings s;
    s.shape = plan.shape;
    s.rate = plan.rate;
    s.parity = plan.parity;
    return s;
}

} // namespace

// Sends a datagram when the next one is requested, or at the end.
class SimulatedStream::Wire : public DatagramSink {
public:
    Wire(SimulatedStream& stream, DatagramSealer& sealer) : stream_(stream), sealer_(sealer) {}
    ~Wire() override { sendOut(); }
    std::span<std::byte> datagram(MemberId to, size_t bytes) override {
        sendOut();
        to_ = to;
        datagram_.assign(bytes + tagBytes(stream_.keys_.seal), std::byte{0});
        return std::span(datagram_).first(bytes);
    }

private:
    void sendOut() {
        if (datagram_.empty()) return;
        sealer_.seal(datagram_);
        if (to_ != kEverybody) return stream_.network_.send(to_, datagram_);
        for (size_t i = 0; i < stream_.members_.size(); ++i) stream_.network_.send(host(i), datagram_);
    }
    SimulatedStream& stream_;
    DatagramSealer& sealer_;
    MemberId to_ = 0;
    std::vector<std::byte> datagram_;
};

SimulatedStream::SimulatedStream(const StreamPlan& plan)
    : plan_(plan),
      network_(plan.seed, kMaxHosts),
      keys_(makeSessionKeys(plan.seal)),
      sealer_(keys_, 0),
      opener_(keys_),
      sender_(senderSettings(plan), Sequence(plan.first)) {
    network_.faults(0) = plan.toWriter;
    network_.onDatagram(0, [this](std::span<std::byte> d) {
        if (const auto f = readFeedback(opener_.open(d))) sender_.input(*f, network_.nowNs());
    });
    network_.onTimer(0, [this] { runSender(); });
    for (size_t i = 0; i < plan.members; ++i) join();
    network_.setTimer(0, network_.nowNs());
}

size_t SimulatedStream::join() {
    const size_t i = members_.size();
    SimulatedMember& m = members_.emplace_back();
    ReceiverSettings s;
    s.shape = plan_.shape;
    s.self = static_cast<MemberId>(host(i));
    s.socketDatagrams = plan_.socketDatagrams;
    m.sealer = std::make_unique<DatagramSealer>(keys_, s.self);
    m.opener = std::make_unique<DatagramOpener>(keys_);
    m.opener->addMember(0);
    opener_.addMember(s.self);
    m.receiver = std::make_unique<Receiver>(s, sender_.addMember(s.self, network_.nowNs()));
    m.readBytes = written_;
    m.lastProgressNs = m.readNs = network_.nowNs();
    network_.faults(host(i)) = plan_.toMembers;
    network_.setSocketDatagrams(host(i), plan_.socketDatagrams * 2); // repairs may exceed the edge
    network_.onDatagram(host(i), [this, &m](std::span<std::byte> d) {
        const auto opened = m.opener->open(d);
        const auto datagram = landed(opened, *m.receiver);
        if (datagram && !m.gone) m.receiver->input(*datagram, network_.nowNs());
    });
    network_.onTimer(host(i), [this, i] { runMember(i); });
    network_.setTimer(host(i), network_.nowNs());
    return i;
}

// Delivers as a socket does: randomly in place in the window or elsewhere.
std::optional<StreamDatagram> SimulatedStream::landed(std::span<const std::byte> datagram, Receiver& receiver) {
    if (datagram.size() <= kStreamHeaderBytes || network_.random() % 2 == 0) return readStream(datagram);
    const ReceiveBuffers landing = receiver.landing();
    if (datagram.size() > landing.bufferBytes) return readStream(datagram);
    std::byte* const place = landing.buffers[network_.random() % landing.buffers.size()];
    std::ranges::copy(datagram, place);
    return readStream({place, datagram.size()});
}

void SimulatedStream::write() {
    std::array<std::byte, 8192> piece;
    while (written_ < plan_.bytes) {
        if (flushAt_ == 0 && plan_.flushEveryBytes != 0)
            flushAt_ = written_ + 1 + network_.random() % (2 * plan_.flushEveryBytes);
        const uint64_t until = flushAt_ != 0 ? std::min(flushAt_, plan_.bytes) : plan_.bytes;
        const size_t want = std::min<uint64_t>(piece.size(), until - written_);
        for (size_t i = 0; i < want; ++i) piece[i] = byteAt(written_ + i);
        const size_t took = sender_.write(std::span(piece).first(want));
        written_ += took;
        if (written_ == flushAt_) {
            sender_.flush();
            flushAt_ = 0;
        }
        if (took < want) return;
    }
    if (!ended_) sender_.flush();
    ended_ = true;
}

void SimulatedStream::runSender() {
    write();
    Wire wire(*this, sealer_);
    const int64_t next = sender_.tick(network_.nowNs(), wire);
    network_.setTimer(0, std::max(next, network_.nowNs() + 1000));
}

void SimulatedStream::read(SimulatedMember& m) {
    const int64_t now = network_.nowNs();
    uint64_t may = UINT64_MAX;
    if (m.readBytesPerS > 0) may = static_cast<uint64_t>(m.readBytesPerS * static_cast<double>(now - m.readNs) * 1e-9);
    if (may == 0) return;
    m.readNs = now;
    while (may > 0) {
        const auto bytes = m.receiver->readable();
        if (bytes.empty()) break;
        const size_t count = std::min<uint64_t>(bytes.size(), may);
        for (size_t i = 0; i < count; ++i) m.wrongBytes += bytes[i] != byteAt(m.readBytes + i);
        m.readBytes += count;
        may -= count;
        m.receiver->consume(count);
        m.longestStallNs = std::max(m.longestStallNs, now - m.lastProgressNs);
        m.lastProgressNs = now;
    }
}

void SimulatedStream::runMember(size_t member) {
    SimulatedMember& m = members_[member];
    if (m.gone) return;
    read(m);
    Wire wire(*this, *m.sealer);
    int64_t next = m.receiver->tick(network_.nowNs(), wire);
    if (m.readBytesPerS > 0 && !m.receiver->readable().empty()) next = std::min(next, network_.nowNs() + 1'000'000);
    network_.setTimer(host(member), std::max(next, network_.nowNs() + 1000));
}

bool SimulatedStream::allRead() const {
    if (written_ < plan_.bytes) return false;
    return std::ranges::all_of(members_, [&](const SimulatedMember& m) { return m.gone || m.readBytes == written_; });
}

uint64_t SimulatedStream::wrongBytes() const {
    uint64_t count = 0;
    for (const auto& m : members_) count += m.wrongBytes;
    return count;
}

uint64_t SimulatedStream::refusedDatagrams() const {
    uint64_t count = opener_.refused().forged;
    for (const auto& m : members_) count += m.opener->refused().forged;
    return count;
}

bool SimulatedStream::run(int64_t forNs) {
    return run(forNs, [this] { return allRead() && sender_.allArrived(); });
}

bool SimulatedStream::run(int64_t forNs, const std::function<bool()>& until) {
    return network_.run(network_.nowNs() + forNs, until);
}

} // namespace mural::rsp::test
