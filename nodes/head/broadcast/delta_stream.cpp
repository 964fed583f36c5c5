#include "nodes/head/broadcast/delta_stream.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "common/memory/malloc_tuning.hpp"
#include "common/base/quick_clock.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

constexpr uint64_t kFullStagedBytes = uint64_t{64} * 1024; // the size of a write without delta coding
// From these sizes on, the 0.8 us of reading the thread's CPU clock are negligible: for packets, which mostly repeat,
// and for new bytes. Shorter work is unlikely to be preempted, so the wall clock serves as well.
constexpr size_t kLongPacketBytes = size_t{256} << 10, kLongBytes = size_t{64} << 10;
constexpr uint64_t kMinChoiceBytes = 2048;
constexpr uint64_t kMaxDeferredBytes = uint64_t{256} << 20;
// The first loads of a program are copied several times. Page faults (3 us per new page) took half as long as the rest.
constexpr size_t kFirstBytes = size_t{16} << 20;
constexpr uint64_t kFullRawBytes = uint64_t{4} << 20; // a node decodes this much in 1 to 2 ms

int64_t (*clockFor(size_t sizeBytes))() { return sizeBytes >= kLongBytes ? threadCpuNowNs : quickNowNs; }

} // namespace

Result<std::unique_ptr<DeltaStream>> DeltaStream::open(const delta::Limits& limits) {
    auto coder = freshCoder(limits);
    if (!coder) return coder.error();
    std::unique_ptr<DeltaStream> deltaStream(new DeltaStream(limits, std::move(*coder)));
    reserveMallocMemory(kFirstBytes);
    return deltaStream;
}

DeltaStream::DeltaStream(const delta::Limits& limits, std::unique_ptr<Coder> coder)
    : limits_(limits),
      filter_(std::min(kMaxDeferredBytes, limits.cacheBytes / 4),
              [this](uint32_t stream, std::span<const std::byte> payload, const RecordOffsets* walked) {
                  encode(stream, payload, walked);
              }),
      coder_(std::move(coder)) {}

DeltaStream::Coder::Coder(const delta::Limits& limits)
    : deltaEncoder(limits), batchEncoder([](size_t sizeBytes) { return clockFor(sizeBytes)(); }) {}

Result<std::unique_ptr<DeltaStream::Coder>> DeltaStream::freshCoder(const delta::Limits& limits) {
    auto coder = std::make_unique<Coder>(limits);
    if (!coder->deltaEncoder.ready())
        return Error{"no memory for a delta cache of " + std::to_string(limits.cacheBytes >> 20) +
                     " MiB; choose a smaller --cache-size"};
    return coder;
}

std::unique_ptr<DeltaStream::Coder> DeltaStream::restart(std::unique_ptr<Coder> fresh) {
    const delta::DeltaEncoderCounts& c = coder_->deltaEncoder.counts();
    before_ = {before_.packets + c.packets,         before_.records + c.records,   before_.rawBytes + c.rawBytes,
               before_.stagedBytes + c.stagedBytes, before_.pageHits + c.pageHits, before_.newPages + c.newPages,
               before_.patches + c.patches};
    return std::exchange(coder_, std::move(fresh));
}

void DeltaStream::add(uint32_t stream, std::span<const std::byte> payload) {
    const SpanScope encodes(SpanKind::Encode);
    const bool isLong = payload.size() >= kLongPacketBytes;
    MedianTimer& usualNs = packetNs_.of(payload.size());
    if (!timesFrame_ && !isLong && usualNs.isKnown()) {
        filterPacket(stream, payload);
        encodeNs_ += static_cast<uint64_t>(usualNs.value());
        return;
    }
    nowNs_ = isLong ? threadCpuNowNs : quickNowNs;
    const int64_t beganNs = nowNs_();
    sendNs_ = deltaNs_ = 0;
    timesDelta_ = true;
    filterPacket(stream, payload);
    timesDelta_ = false;
    const auto ns = static_cast<uint64_t>(nowNs_() - beganNs - sendNs_);
    encodeNs_ += ns;
    measured_.filterNs += ns - std::min(ns, deltaNs_);
    if (!isLong) usualNs.add(static_cast<double>(ns));
}

void DeltaStream::miss(uint32_t stream, std::span<const std::byte> payload) {
    missed_ = true;
    filterPacket(stream, payload);
    missed_ = false;
}

void DeltaStream::filterPacket(uint32_t stream, std::span<const std::byte> payload) {
    if (!filters_) return encode(stream, payload);
    if (wire::clientOf(stream) != 0) {
        filter_.setDropsRedundant(redundancy_.dropsRedundant());
        return filter_.add(stream, payload);
    }
    // Commands of the head: data of an ended program is dropped. Before most other commands all deferred data is sent,
    // as for a node that joins now.
    uint32_t words[2] = {};
    std::memcpy(words, payload.data(), std::min(payload.size(), sizeof words));
    const auto command = static_cast<wire::HeadCommand>(words[0]);
    if (command == wire::HeadCommand::ClientGone)
        filter_.clientGone(words[1]);
    else if (command != wire::HeadCommand::ClockProbe && command != wire::HeadCommand::Statistics &&
             command != wire::HeadCommand::ProveOutput && command != wire::HeadCommand::WantPreview)
        filter_.releaseAll();
    encode(stream, payload);
}

void DeltaStream::encode(uint32_t stream, std::span<const std::byte> payload, const RecordOffsets* walked) {
    if (missed_) return;
    const int64_t startedNs = timesDelta_ ? nowNs_() : 0;
    coder_->deltaEncoder.add(stream, payload, walked);
    if (timesDelta_) deltaNs_ += static_cast<uint64_t>(nowNs_() - startedNs);
    ++packets_;
    if (!full() || !send_) return coder_->deltaEncoder.ownBytes();
    const int64_t beganNs = nowNs_();
    send_();
    sendNs_ += nowNs_() - beganNs;
    coder_->deltaEncoder.ownBytes();
}

// Returns whether references already replace most bytes. Another coding then gains little, and loses dictionary space.
bool DeltaStream::isMostlyDropped() const {
    return measured_.rawBytes >= kMinChoiceBytes && measured_.droppedBytes > measured_.rawBytes / 2;
}

bool DeltaStream::full() const {
    return coder_->deltaEncoder.stagedBytes() >= kFullStagedBytes || coder_->deltaEncoder.rawBytes() >= kFullRawBytes;
}

Result<std::span<const std::byte>> DeltaStream::take() {
    const SpanScope encodes(SpanKind::Encode);
    delta::DeltaEncoder& encoder = coder_->deltaEncoder;
    const bool frameGoesOn = full(), isLong = encoder.stagedBytes() >= kLongBytes, timed = timesFrame_ || isLong;
    const auto now = clockFor(encoder.stagedBytes());
    const int64_t beganNs = timed ? now() : 0;
    measured_.rawBytes += encoder.rawBytes();
    measured_.pageBytes += encoder.pageBytes();
    measured_.droppedBytes += encoder.droppedBytes();
    auto batch = coder_->batchEncoder.encode(encoder.finish(), link_.nsPerByte(), encoder.plain());
    encoder.clear();
    packets_ = 0;
    const auto ns = timed ? static_cast<uint64_t>(now() - beganNs) : static_cast<uint64_t>(takeNs_.value());
    encodeNs_ += ns;
    if (timed && !isLong) takeNs_.add(static_cast<double>(ns));
    if (batch) {
        wireBytes_ += batch->size();
        measured_.wireBytes += batch->size();
    }
    if (!frameGoesOn || measured_.rawBytes > kFullRawBytes) {
        delta::ModeSelector& mode = coder_->mode;
        const double frameNs = timesFrame_ ? static_cast<double>(encodeNs_ - measured_.encodeNs) : -1;
        // Deferred data costs the same either way.
        if (isMostlyDropped())
            mode.mostlyPlain();
        else if (timesFrame_)
            mode.measured(measured_.rawBytes, measured_.pageBytes, measured_.wireBytes,
                          static_cast<int64_t>(frameNs) - static_cast<int64_t>(measured_.filterNs), link_.nsPerByte());
        else
            mode.unmeasured();
        if (mode.plain() != encoder.plain())
            redundancy_.disturbed();
        else
            redundancy_.frame(filter_.counts().inBytes - measured_.programBytes, measured_.wireBytes,
                              timesFrame_ ? frameNs + static_cast<double>(measured_.wireBytes) * link_.nsPerByte()
                                          : -1);
        timesFrame_ = mode.wantsTime() || redundancy_.wantsTime();
        if (mode.plain() != encoder.plain())
            log::debug(log::Topic::Stream, "delta coding ", mode.plain() ? "stops searching" : "searches",
                       " for known data");
        encoder.beginFrame(mode.plain(), frameGoesOn);
        measured_ = {0, 0, 0, 0, encodeNs_, filter_.counts().inBytes, 0};
    }
    publishCounts();
    return batch;
}

void DeltaStream::publishCounts() {
    const delta::DeltaEncoderCounts& c = coder_->deltaEncoder.counts();
    const delta::DeltaEncoderCounts& b = before_;
    const auto set = [](std::atomic<uint64_t>& to, uint64_t value) { to.store(value, std::memory_order_relaxed); };
    set(published_.packets, b.packets + c.packets);
    set(published_.records, b.records + c.records);
    set(published_.rawBytes, b.rawBytes + c.rawBytes);
    set(published_.stagedBytes, b.stagedBytes + c.stagedBytes);
    set(published_.pageHits, b.pageHits + c.pageHits);
    set(published_.newPages, b.newPages + c.newPages);
    set(published_.patches, b.patches + c.patches);
    set(published_.wireBytes, wireBytes_);
    set(published_.encodeNs, encodeNs_);
    const filter::CommandFilterCounts& h = filter_.counts();
    set(published_.filterInBytes, h.inBytes);
    set(published_.filterOutBytes, h.outBytes);
    set(published_.deferredRecords, h.deferredRecords);
    set(published_.droppedRecords, h.droppedRecords);
    set(published_.droppedBytes, h.droppedBytes);
    set(published_.deferredBytes, h.deferredBytes);
}

DeltaCounts DeltaStream::counts() const {
    const auto of = [](const std::atomic<uint64_t>& from) { return from.load(std::memory_order_relaxed); };
    DeltaCounts c;
    c.on = true;
    c.packer = {of(published_.packets),  of(published_.records),  of(published_.rawBytes), of(published_.stagedBytes),
                of(published_.pageHits), of(published_.newPages), of(published_.patches)};
    c.wireBytes = of(published_.wireBytes);
    c.encodeNs = of(published_.encodeNs);
    c.filter = {of(published_.filterInBytes),  of(published_.filterOutBytes), of(published_.deferredRecords),
                of(published_.droppedRecords), of(published_.droppedBytes),   of(published_.deferredBytes)};
    return c;
}

} // namespace mural
