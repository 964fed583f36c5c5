#include "transport/rsp/wire/control_message.hpp"

#include <algorithm>

#include "common/base/little_endian.hpp"

namespace mural::rsp {

namespace {

constexpr size_t kMaxTextBytes = 1024;
constexpr size_t kMaxTunnelBytes = 65'536;

class Writer {
public:
    explicit Writer(size_t kind) { number(static_cast<uint8_t>(kind)); }
    template <std::unsigned_integral T> void number(T value) {
        const size_t at = bytes_.size();
        bytes_.resize(at + sizeof value);
        storeLittle(bytes_.data() + at, value);
    }
    void flag(bool value) { number(static_cast<uint8_t>(value)); }
    template <size_t N> void fixed(const std::array<std::byte, N>& value) {
        bytes_.insert(bytes_.end(), value.begin(), value.end());
    }
    void bytes(std::span<const std::byte> value) {
        number(static_cast<uint32_t>(value.size()));
        bytes_.insert(bytes_.end(), value.begin(), value.end());
    }
    void text(const std::string& value) {
        bytes(std::as_bytes(std::span(value)).first(std::min(value.size(), kMaxTextBytes)));
    }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

// After the first missing or invalid field every read fails.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
    template <std::unsigned_integral T> void number(T& value) {
        if (left_.size() < sizeof value) return fail();
        value = loadLittle<T>(left_.data());
        left_ = left_.subspan(sizeof value);
    }
    void flag(bool& value) {
        uint8_t n = 0;
        number(n);
        if (n > 1) fail();
        value = n == 1;
    }
    template <size_t N> void fixed(std::array<std::byte, N>& value) {
        if (left_.size() < N) return fail();
        std::copy_n(left_.begin(), N, value.begin());
        left_ = left_.subspan(N);
    }
    std::span<const std::byte> bytes(size_t maximum) {
        uint32_t count = 0;
        number(count);
        if (count > maximum || count > left_.size()) return fail(), std::span<const std::byte>{};
        const auto value = left_.first(count);
        left_ = left_.subspan(count);
        return value;
    }
    void text(std::string& value) {
        const auto b = bytes(kMaxTextBytes);
        value.assign(reinterpret_cast<const char*>(b.data()), b.size());
    }
    void fail() {
        good_ = false;
        left_ = {};
    }
    [[nodiscard]] bool whole() const { return good_ && left_.empty(); }

private:
    std::span<const std::byte> left_;
    bool good_ = true;
};

void put(Writer& w, const Join& m) {
    w.fixed(m.uuid);
    w.number(m.udpPort);
    w.number(m.socketDatagrams);
    w.number(m.maxDatagramBytes);
    w.number(m.seals);
    w.flag(m.multicast);
}
void get(Reader& r, Join& m) {
    r.fixed(m.uuid);
    r.number(m.udpPort);
    r.number(m.socketDatagrams);
    r.number(m.maxDatagramBytes);
    r.number(m.seals);
    r.flag(m.multicast);
}
void put(Writer& w, const Welcome& m) {
    w.number(m.self);
    w.number(m.keys.session);
    w.number(static_cast<uint8_t>(m.keys.seal));
    w.fixed(m.keys.secret);
    w.text(m.group);
    w.number(m.datagramBytes);
    w.number(m.windowDatagrams);
    w.number(m.probeNonce);
}
void get(Reader& r, Welcome& m) {
    uint8_t seal = 0;
    r.number(m.self);
    r.number(m.keys.session);
    r.number(seal);
    if (seal > static_cast<uint8_t>(Seal::ChaCha)) r.fail();
    m.keys.seal = static_cast<Seal>(seal);
    r.fixed(m.keys.secret);
    r.text(m.group);
    r.number(m.datagramBytes);
    r.number(m.windowDatagrams);
    r.number(m.probeNonce);
}
void put(Writer& w, const Probed& m) { w.number(m.nonce); }
void get(Reader& r, Probed& m) { r.number(m.nonce); }
void put(Writer& w, const MemberCame& m) {
    w.number(m.id);
    w.fixed(m.uuid);
    w.text(m.address);
    w.number(m.udpPort);
    w.flag(m.multicast);
}
void get(Reader& r, MemberCame& m) {
    r.number(m.id);
    r.fixed(m.uuid);
    r.text(m.address);
    r.number(m.udpPort);
    r.flag(m.multicast);
}
void put(Writer& w, const StreamStart& m) {
    w.number(m.writer);
    w.number(m.reader);
    w.number(m.first.value());
}
void get(Reader& r, StreamStart& m) {
    uint32_t first = 0;
    r.number(m.writer);
    r.number(m.reader);
    r.number(first);
    m.first = Sequence(first);
}
void put(Writer& w, const MemberGone& m) {
    w.number(m.id);
    w.number(static_cast<uint8_t>(m.reason));
}
void get(Reader& r, MemberGone& m) {
    uint8_t reason = 0;
    r.number(m.id);
    r.number(reason);
    if (reason > static_cast<uint8_t>(GoneReason::Removed)) r.fail();
    m.reason = static_cast<GoneReason>(reason);
}
void put(Writer& w, const Tunnel& m) {
    w.number(m.to);
    w.bytes(m.datagram);
}
void get(Reader& r, Tunnel& m) {
    r.number(m.to);
    const auto b = r.bytes(kMaxTunnelBytes);
    m.datagram.assign(b.begin(), b.end());
}
void put(Writer& w, const Refused& m) { w.text(m.why); }
void get(Reader& r, Refused& m) { r.text(m.why); }
void put(Writer&, const Leave&) {}
void get(Reader&, Leave&) {}
void put(Writer& w, const Ping& m) {
    w.number(m.number);
    w.flag(m.answer);
}
void get(Reader& r, Ping& m) {
    r.number(m.number);
    r.flag(m.answer);
}

void put(Writer& w, const Rerouted& m) {
    w.number(m.id);
    w.flag(m.multicast);
    w.number(m.probeNonce);
}
void get(Reader& r, Rerouted& m) {
    r.number(m.id);
    r.flag(m.multicast);
    r.number(m.probeNonce);
}

// The index of an alternative in the variant is its type on the wire.
template <size_t I = 0> std::optional<ControlMessage> decodeKind(size_t kind, Reader& r) {
    if constexpr (I < std::variant_size_v<ControlMessage>) {
        if (kind != I) return decodeKind<I + 1>(kind, r);
        std::variant_alternative_t<I, ControlMessage> message;
        get(r, message);
        if (!r.whole()) return {};
        return message;
    } else {
        return {};
    }
}

} // namespace

std::vector<std::byte> encode(const ControlMessage& message) {
    Writer w(message.index());
    std::visit([&](const auto& m) { put(w, m); }, message);
    return w.take();
}

std::optional<ControlMessage> decode(std::span<const std::byte> bytes) {
    Reader r(bytes);
    uint8_t kind = 0xff;
    r.number(kind);
    return decodeKind(kind, r);
}

} // namespace mural::rsp
