#include "streamcodec/snapshot/live_command_log.hpp"

#include <algorithm>
#include <cstring>

#include "streamcodec/snapshot/liveness_sweep.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::snapshot {
namespace {

constexpr size_t kLargeBytes = 4096; // larger entries have memory of their own and are not moved
constexpr size_t kMinItems = 8192;   // minimum for a sweep
constexpr size_t kMinBytes = size_t{4} << 20;
constexpr size_t kMinKeys = 16384;

} // namespace

void LiveCommandLog::append(uint32_t stream, std::span<const std::byte> payload, bool pinned) {
    RecordWalk walk(payload);
    RecordView r;
    while (walk.next(r)) record(stream, r, payload.subspan(r.offset, r.sizeBytes), pinned);
}

void LiveCommandLog::record(uint32_t stream, const RecordView& r, std::span<const std::byte> bytes, bool pinned) {
    Pending& pending = pending_[stream];
    const bool whole = tracker_.record(stream, r, pending.effect);
    const bool alone = pending.bytes.empty();
    if (!alone || !whole) {
        if (!pinned) pending.bytes.insert(pending.bytes.end(), bytes.begin(), bytes.end());
        if (!whole) return;
    }
    if (pending.effect.always || !pending.effect.entries.empty())
        put(stream, alone ? bytes : std::span<const std::byte>(pending.bytes), pending.effect, pinned);
    pending.bytes.clear();
    if (pending.bytes.capacity() > size_t{1} << 20) pending.bytes.shrink_to_fit();
    pending.effect.clear();
    // Side effects become a command of their own.
    const std::vector<std::byte> rest = tracker_.takeSideEffects(stream);
    RecordWalk walk(rest);
    RecordView left;
    Effect effect;
    while (walk.next(left)) {
        effect.clear();
        (void)tracker_.record(stream, left, effect);
        put(stream, std::span(rest).subspan(left.offset, left.sizeBytes), effect, pinned);
    }
}

void LiveCommandLog::put(uint32_t stream, std::span<const std::byte> bytes, const Effect& effect, bool pinned) {
    Item item;
    item.stream = stream;
    item.always = effect.always;
    item.pinned = pinned;
    item.effectAt = static_cast<uint32_t>(effects_.size());
    item.effects = static_cast<uint32_t>(effect.entries.size());
    effects_.insert(effects_.end(), effect.entries.begin(), effect.entries.end());
    item.sizeBytes = pinned ? 0 : static_cast<uint32_t>(bytes.size());
    if (item.sizeBytes >= kLargeBytes) {
        item.large = std::make_unique_for_overwrite<std::byte[]>(item.sizeBytes);
        std::memcpy(item.large.get(), bytes.data(), item.sizeBytes);
        largeBytes_ += item.sizeBytes;
    } else if (!pinned) {
        item.at = bytes_.size();
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    items_.push_back(std::move(item));
}

void LiveCommandLog::settlePending() {
    for (auto& [stream, pending] : pending_) {
        if (pending.bytes.empty()) continue;
        Effect begun;
        begun.always = true;
        put(stream, pending.bytes, begun, false);
        pending.bytes.clear();
    }
}

void LiveCommandLog::clientGone(uint32_t client) {
    tracker_.clientGone(client);
    std::erase_if(pending_, [client](const auto& p) { return wire::clientOf(p.first) == client; });
    for (Item& item : items_)
        if (wire::clientOf(item.stream) == client) item.effects = 0, item.always = item.pinned = false;
    compact();
}

bool LiveCommandLog::compactIfGrown() {
    const bool due = items_.size() > std::max(grownItems_, kMinItems) ||
                     bytes_.size() + largeBytes_ > std::max(grownBytes_, kMinBytes) ||
                     keys_.used() > std::max(grownKeys_, kMinKeys);
    if (due) compact();
    return due;
}

void LiveCommandLog::compact() {
    std::vector<bool> stays(items_.size());
    LivenessSweep sweep(keys_);
    sweep.keepsAfterAll = [&](uint32_t number) { stays[number] = true; };
    for (size_t i = items_.size(); i-- > 0;) {
        const Item& item = items_[i];
        const bool gl = item.effects > 0 || item.always;
        if (gl && sweep.command(static_cast<uint32_t>(i), std::span(effects_).subspan(item.effectAt, item.effects),
                                item.always || item.pinned))
            stays[i] = true;
    }
    size_t live = 0, effects = 0, bytes = 0;
    largeBytes_ = 0;
    for (size_t i = 0; i < items_.size(); ++i) {
        if (!stays[i]) continue;
        Item item = std::move(items_[i]);
        std::move(effects_.begin() + item.effectAt, effects_.begin() + item.effectAt + item.effects,
                  effects_.begin() + static_cast<std::ptrdiff_t>(effects));
        item.effectAt = static_cast<uint32_t>(effects);
        effects += item.effects;
        if (item.large) {
            largeBytes_ += item.sizeBytes;
        } else if (item.sizeBytes > 0) {
            std::memmove(bytes_.data() + bytes, bytes_.data() + item.at, item.sizeBytes);
            item.at = bytes;
            bytes += item.sizeBytes;
        }
        items_[live++] = std::move(item);
    }
    items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(live), items_.end());
    effects_.resize(effects);
    bytes_.resize(bytes);
    grownItems_ = 2 * items_.size();
    grownBytes_ = 2 * (bytes_.size() + largeBytes_);
    if (keys_.used() > std::max(grownKeys_, kMinKeys)) forgetKeys();
}

void LiveCommandLog::forgetKeys() {
    std::vector<bool> used(keys_.size());
    for (const EffectEntry& e : effects_) used[e.key] = true;
    for (const auto& [stream, pending] : pending_)
        for (const EffectEntry& e : pending.effect.entries) used[e.key] = true;
    tracker_.forEachKey([&](Key key) { used[key] = true; });
    keys_.keepOnly(std::move(used));
    grownKeys_ = 2 * keys_.used();
}

void LiveCommandLog::forEach(const std::function<void(uint32_t, std::span<const std::byte>)>& take) const {
    for (const Item& item : items_) {
        if (item.sizeBytes > 0)
            take(item.stream, {item.large ? item.large.get() : bytes_.data() + item.at, item.sizeBytes});
    }
    for (const auto& [stream, pending] : pending_)
        if (!pending.bytes.empty()) take(stream, pending.bytes);
}

size_t LiveCommandLog::sizeBytes() const {
    constexpr size_t kKeyBytes = 32; // including its table entry
    size_t pending = 0;
    for (const auto& [stream, p] : pending_) pending += p.bytes.size();
    return bytes_.size() + largeBytes_ + pending + items_.size() * sizeof(Item) +
           effects_.size() * sizeof(EffectEntry) + keys_.used() * kKeyBytes;
}

void LiveCommandLog::clear() {
    std::vector<Item>().swap(items_);
    std::vector<EffectEntry>().swap(effects_);
    std::vector<std::byte>().swap(bytes_);
    pending_.clear();
    largeBytes_ = 0;
}

} // namespace mural::snapshot
