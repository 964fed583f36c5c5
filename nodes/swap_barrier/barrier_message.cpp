#include "nodes/swap_barrier/barrier_message.hpp"

#include "common/base/little_endian.hpp"

namespace mural {

namespace {

class Writer {
public:
    explicit Writer(std::byte* at) : at_(at) {}
    void put(const SwapKey& key) {
        for (const uint32_t word : {key.client, key.window, key.frame}) storeLittle(at_, word), at_ += 4;
    }
    void put(int64_t ns) { storeLittle(at_, static_cast<uint64_t>(ns)), at_ += 8; }

private:
    std::byte* at_;
};

class Reader {
public:
    explicit Reader(const std::byte* at) : at_(at) {}
    SwapKey key() {
        SwapKey k;
        for (uint32_t* word : {&k.client, &k.window, &k.frame}) *word = loadLittle<uint32_t>(at_), at_ += 4;
        return k;
    }
    int64_t ns() {
        at_ += 8;
        return static_cast<int64_t>(loadLittle<uint64_t>(at_ - 8));
    }

private:
    const std::byte* at_;
};

} // namespace

std::array<std::byte, kReadyBytes> encode(const BarrierReady& ready) {
    std::array<std::byte, kReadyBytes> bytes;
    Writer w(bytes.data());
    w.put(ready.key), w.put(ready.shownKey);
    for (const int64_t ns : {ready.shownNs, ready.sentNs, ready.errorNs}) w.put(ns);
    return bytes;
}

std::array<std::byte, kGoBytes> encode(const BarrierGo& go) {
    std::array<std::byte, kGoBytes> bytes;
    Writer w(bytes.data());
    w.put(go.key);
    for (const int64_t ns : {go.readySentNs, go.arrivedNs, go.leftNs, go.showNs}) w.put(ns);
    return bytes;
}

BarrierReady decodeReady(std::span<const std::byte, kReadyBytes> bytes) {
    Reader r(bytes.data());
    BarrierReady ready;
    ready.key = r.key(), ready.shownKey = r.key();
    ready.shownNs = r.ns(), ready.sentNs = r.ns(), ready.errorNs = r.ns();
    return ready;
}

BarrierGo decodeGo(std::span<const std::byte, kGoBytes> bytes) {
    Reader r(bytes.data());
    BarrierGo go;
    go.key = r.key();
    go.readySentNs = r.ns(), go.arrivedNs = r.ns(), go.leftNs = r.ns(), go.showNs = r.ns();
    return go;
}

} // namespace mural
