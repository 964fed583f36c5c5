#include "objects/core/blob_intake.hpp"

#include <algorithm>

namespace mural::objects {

std::shared_ptr<BlobEntry> BlobIntake::entryFor(const BlobRef& ref) {
    std::weak_ptr<BlobEntry>& known = entries_[ref.name];
    std::shared_ptr<BlobEntry> entry = known.lock();
    if (entry && entry->ref == ref) return entry;
    entry = std::make_shared<BlobEntry>();
    entry->ref = ref;
    const Blob blob = store_.find(ref.name);
    if (blob.sizeBytes() == ref.sizeBytes) {
        entry->blob = blob;
        entry->isHere = true;
    }
    known = entry;
    if (entries_.size() >= sweepAt_) {
        std::erase_if(entries_, [](const auto& item) { return item.second.expired(); });
        sweepAt_ = std::max<size_t>(64, 2 * entries_.size());
    }
    return entry;
}

void BlobIntake::request(const std::shared_ptr<BlobEntry>& entry, int64_t nowNs) {
    if (entry->isHere || requests_.contains(entry->ref.name)) return;
    if (entry->ref.sizeBytes > options_.mostBlobBytes) return; // the state stays incomplete
    if (std::ranges::any_of(queue_, [&](const auto& waiting) { return waiting->ref.name == entry->ref.name; })) return;
    queue_.push_back(entry);
    startRequests(nowNs);
}

void BlobIntake::startRequests(int64_t nowNs) {
    while (!queue_.empty() && requests_.size() < kMaxRequests) {
        const std::shared_ptr<BlobEntry> entry = queue_.front();
        queue_.pop_front();
        if (entry->isHere || entry.use_count() == 1) continue; // arrived, or no state refers to it any more
        const auto [at, isNew] =
            requests_.try_emplace(entry->ref.name, Request{entry, BlobAssembly(entry->ref.name, entry->ref.sizeBytes),
                                                           0, options_.requestsPlaces, nowNs, nowNs});
        if (isNew) ask(entry->ref.name, at->second, nowNs);
    }
}

void BlobIntake::ask(const BlobName& name, Request& request, int64_t nowNs) {
    const uint64_t from = request.assembly.receivedBytes();
    const uint64_t window = rate_.bytesPerSecond() == 0 ? kFirstWindowBytes : kWindowBytes;
    const uint64_t end = std::min(request.assembly.sizeBytes(), from + window);
    request.askedBytes = end;
    request.progressNs = request.askedNs = nowNs;
    const bool takesPlace = request.takesPlace && from == 0;
    sender_.toOne(kWriter,
                  WantBlobMessage{name, from, static_cast<uint32_t>(end - from), takesPlace, rate_.bytesPerSecond()});
}

Result<void> BlobIntake::input(const BlobBeginMessage& message) {
    const BlobRef& blob = message.blob;
    if (blob.sizeBytes == 0 || blob.sizeBytes > options_.mostBlobBytes)
        return Error{"blob " + textOf(blob.name) + " of " + std::to_string(blob.sizeBytes) +
                     " bytes is refused: at most " + std::to_string(options_.mostBlobBytes) + " bytes are allowed"};
    std::erase_if(pushes_, [&](const auto& push) { return push.first == blob.name; });
    if (pushes_.size() >= kMaxPushes) pushes_.pop_front();
    pushes_.emplace_back(blob.name, BlobAssembly(blob.name, blob.sizeBytes));
    return {};
}

Result<void> BlobIntake::input(const BlobDataMessage& message, int64_t nowNs) {
    const bool isCoded = message.coding != PieceCoding::Raw;
    const auto raw =
        decodePiece(message.coding, message.bytes, isCoded ? message.rawBytes : message.bytes.size(), decoded_);
    if (!raw) return Error{"blob " + textOf(message.name) + ": a coded piece is damaged; it is requested again"};
    const auto push = std::ranges::find_if(pushes_, [&](const auto& item) { return item.first == message.name; });
    if (push != pushes_.end() && push->second.add(message.offset, *raw) && push->second.isComplete()) {
        BlobAssembly assembly = std::move(push->second);
        pushes_.erase(push);
        const Result<Blob> blob = assembly.finish();
        if (!blob) return blob.error();
        pushed_.push_back(arrived(blob.value()));
        startRequests(nowNs);
        return {};
    }
    const auto found = requests_.find(message.name);
    if (found == requests_.end()) return {};
    Request& request = found->second;
    rate_.received(message.bytes.size(), message.codingMicroseconds * int64_t{1000}, request.askedNs, nowNs);
    if (!request.assembly.add(message.offset, *raw)) return {}; // a gap; asked for again later
    request.progressNs = nowNs;
    if (!request.assembly.isComplete()) {
        if (request.assembly.receivedBytes() >= request.askedBytes) ask(message.name, request, nowNs);
        return {};
    }
    BlobAssembly assembly = std::move(request.assembly);
    const std::shared_ptr<BlobEntry> entry = request.entry.lock();
    requests_.erase(found);
    const Result<Blob> blob = assembly.finish();
    if (blob) {
        arrived(blob.value());
    } else if (entry) {
        queue_.push_back(entry);
    }
    startRequests(nowNs);
    if (!blob) return blob.error();
    return {};
}

void BlobIntake::writePushed(BlobTransfer transfer, const MessageFunction& emit) const {
    for (const Blob& blob : pushed_) sendBlob(blob, transfer, emit);
    for (const auto& [name, assembly] : pushes_) {
        emit(encode(BlobBeginMessage{{name, assembly.sizeBytes()}}).bytes());
        emit(encode(BlobDataMessage{name, 0, PieceCoding::Raw, 0, 0, assembly.received()}).bytes());
    }
}

void BlobIntake::input(const BlobAtMessage& message, int64_t nowNs) {
    const BlobPlace& place = message.place;
    if (place.sizeBytes > options_.mostBlobBytes) return;
    if (const Blob known = store_.find(place.name); known.sizeBytes() == place.sizeBytes && !known.empty()) {
        pushed_.push_back(known);
        return;
    }
    const Result<Blob> blob = openPlace(place, options_.open);
    const auto request = requests_.find(place.name);
    if (!blob) {
        mappingProblem_ = blob.error().message;
        if (request == requests_.end()) return;
        request->second.takesPlace = false;
        return ask(place.name, request->second, nowNs);
    }
    const bool isRequested = request != requests_.end();
    const Blob stored = arrived(blob.value());
    if (!isRequested) pushed_.push_back(stored);
    startRequests(nowNs);
}

Result<void> BlobIntake::input(const RefuseMessage& message, int64_t nowNs) {
    if (message.reason != Refusal::UnknownBlob || requests_.erase(message.name) == 0) return {};
    startRequests(nowNs);
    return Error{"the writer no longer has blob " + textOf(message.name) +
                 "; keep a reference to it until its readers have received it"};
}

Blob BlobIntake::arrived(const Blob& blob) {
    const Blob stored = store_.insert(blob);
    requests_.erase(blob.name());
    const auto found = entries_.find(blob.name());
    const std::shared_ptr<BlobEntry> entry = found == entries_.end() ? nullptr : found->second.lock();
    if (entry && !entry->isHere && entry->ref.sizeBytes == stored.sizeBytes()) {
        entry->blob = stored;
        entry->isHere = true;
    }
    return stored;
}

void BlobIntake::tick(int64_t nowNs) {
    std::erase_if(requests_, [](const auto& item) { return item.second.entry.expired(); });
    for (auto& [name, request] : requests_)
        if (nowNs - request.progressNs >= kRetryNs) ask(name, request, nowNs);
    startRequests(nowNs);
}

} // namespace mural::objects
