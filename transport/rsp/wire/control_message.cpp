#include "transport/rsp/wire/control_message.hpp"

#include <algorithm>
#include <type_traits>

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
    void text(const std::string& value) {
        bytes(std::as_bytes(std::span(value)).first(std::min(value.size(), kMaxTextBytes)));
    }
    void datagram(const std::vector<std::byte>& value) { bytes(value); }
    void sequence(Sequence value) { number(value.value()); }
    template <class Enum> void choice(Enum value, Enum /*last*/) { number(static_cast<uint8_t>(value)); }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    void bytes(std::span<const std::byte> value) {
        number(static_cast<uint32_t>(value.size()));
        bytes_.insert(bytes_.end(), value.begin(), value.end());
    }

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
    void text(std::string& value) {
        const auto b = bytes(kMaxTextBytes);
        value.assign(reinterpret_cast<const char*>(b.data()), b.size());
    }
    void datagram(std::vector<std::byte>& value) {
        const auto b = bytes(kMaxTunnelBytes);
        value.assign(b.begin(), b.end());
    }
    void sequence(Sequence& value) {
        uint32_t n = 0;
        number(n);
        value = Sequence(n);
    }
    // last: the largest valid value.
    template <class Enum> void choice(Enum& value, Enum last) {
        uint8_t n = 0;
        number(n);
        if (n > static_cast<uint8_t>(last)) fail();
        value = static_cast<Enum>(n);
    }
    [[nodiscard]] bool whole() const { return good_ && left_.empty(); }

private:
    std::span<const std::byte> bytes(size_t maximum) {
        uint32_t count = 0;
        number(count);
        if (count > maximum || count > left_.size()) return fail(), std::span<const std::byte>{};
        const auto value = left_.first(count);
        left_ = left_.subspan(count);
        return value;
    }
    void fail() {
        good_ = false;
        left_ = {};
    }

    std::span<const std::byte> left_;
    bool good_ = true;
};

// The fields of each message, in their order on the wire. Coder is Writer or Reader.
template <class M, class Message> concept Is = std::is_same_v<std::remove_const_t<M>, Message>;

template <class Coder, Is<Join> M> void visitFields(Coder& c, M& m) {
    c.fixed(m.uuid);
    c.number(m.udpPort);
    c.number(m.socketDatagrams);
    c.number(m.maxDatagramBytes);
    c.number(m.seals);
    c.flag(m.multicast);
}
template <class Coder, Is<Welcome> M> void visitFields(Coder& c, M& m) {
    c.number(m.self);
    c.number(m.keys.session);
    c.choice(m.keys.seal, Seal::ChaCha);
    c.fixed(m.keys.secret);
    c.text(m.group);
    c.number(m.datagramBytes);
    c.number(m.windowDatagrams);
    c.number(m.probeNonce);
}
template <class Coder, Is<Probed> M> void visitFields(Coder& c, M& m) { c.number(m.nonce); }
template <class Coder, Is<MemberCame> M> void visitFields(Coder& c, M& m) {
    c.number(m.id);
    c.fixed(m.uuid);
    c.text(m.address);
    c.number(m.udpPort);
    c.flag(m.multicast);
}
template <class Coder, Is<StreamStart> M> void visitFields(Coder& c, M& m) {
    c.number(m.writer);
    c.number(m.reader);
    c.sequence(m.first);
}
template <class Coder, Is<MemberGone> M> void visitFields(Coder& c, M& m) {
    c.number(m.id);
    c.choice(m.reason, GoneReason::Removed);
}
template <class Coder, Is<Tunnel> M> void visitFields(Coder& c, M& m) {
    c.number(m.to);
    c.datagram(m.datagram);
}
template <class Coder, Is<Refused> M> void visitFields(Coder& c, M& m) { c.text(m.why); }
template <class Coder, Is<Leave> M> void visitFields(Coder&, M&) {}
template <class Coder, Is<Ping> M> void visitFields(Coder& c, M& m) {
    c.number(m.number);
    c.flag(m.answer);
}
template <class Coder, Is<Rerouted> M> void visitFields(Coder& c, M& m) {
    c.number(m.id);
    c.flag(m.multicast);
    c.number(m.probeNonce);
}

// The index of an alternative in the variant is its type on the wire.
template <size_t I = 0> std::optional<ControlMessage> decodeKind(size_t kind, Reader& r) {
    if constexpr (I < std::variant_size_v<ControlMessage>) {
        if (kind != I) return decodeKind<I + 1>(kind, r);
        std::variant_alternative_t<I, ControlMessage> message;
        visitFields(r, message);
        if (!r.whole()) return {};
        return message;
    } else {
        return {};
    }
}

} // namespace

std::vector<std::byte> encode(const ControlMessage& message) {
    Writer w(message.index());
    std::visit([&](const auto& m) { visitFields(w, m); }, message);
    return w.take();
}

std::optional<ControlMessage> decode(std::span<const std::byte> bytes) {
    Reader r(bytes);
    uint8_t kind = 0xff;
    r.number(kind);
    return decodeKind(kind, r);
}

} // namespace mural::rsp
