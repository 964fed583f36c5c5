#include "tests/objects/object_simulation.hpp"

#include <algorithm>

namespace mural::objects::test {

namespace {

constexpr size_t kMaxReaders = 6;
constexpr size_t kMaxSharedObjects = 24;
constexpr uint64_t kFramesUnderWay = 3;

archive::TypeLayout layoutWith(uint32_t slots) {
    archive::TypeLayout layout;
    layout.typeName = "Simulated";
    layout.fieldCount = slots;
    layout.hash = slots;
    return layout;
}

} // namespace

ObjectSimulation::ObjectSimulation(const SimulationOptions& options)
    : options_(options),
      random_(options.seed),
      master_(std::make_unique<ObjectMaster>(fromWriter_, MasterOptions{.keepsPushed = !options.usesKeeper,
                                                                        .gatherNs = options.seed % 2 ? 2'000'000 : 0})),
      keeper_(std::make_unique<ObjectKeeper>(fromKeeper_)) {}

std::string ObjectSimulation::run() {
    for (int i = 0; i < options_.steps && problem_.empty(); ++i) step();
    if (problem_.empty()) drain();
    if (problem_.empty()) checkEnd();
    return problem_;
}

void ObjectSimulation::fail(const std::string& problem) {
    if (problem_.empty()) problem_ = "seed " + std::to_string(options_.seed) + ": " + problem;
}

ObjectSimulation::Bytes ObjectSimulation::randomBytes() {
    Bytes bytes(below(8) == 0 ? below(300) : below(12));
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random_());
    return bytes;
}

void ObjectSimulation::step() {
    nowNs_ += static_cast<int64_t>(below(400'000));
    const size_t action = below(100);
    Reader* const reader = readers_.empty() ? nullptr : readers_[below(readers_.size())].get();
    if (action < 2) {
        share();
    } else if (action < 22) {
        commit();
    } else if (action < 23) {
        unshare();
    } else if (action < 27) {
        frame();
    } else if (action < 28) {
        join();
    } else if (action < 29 && below(3) == 0) {
        lose();
    } else if (action < 32 && reader) {
        ask(*reader);
    } else if (action < 36 && reader) {
        finishFrame(*reader);
    } else if (action < 45) {
        deliverRequest();
    } else if (action < 55) {
        advanceKeeper();
    } else if (action < 58 && reader) {
        reader->mirror->tick(nowNs_);
    } else if (action < 60) {
        master_->tick(nowNs_);
    } else if (action < 70 && reader) {
        deliverOwn(*reader);
    } else if (reader) {
        deliver(*reader);
    }
    collect();
}

void ObjectSimulation::share() {
    const auto isShared = [](const auto& item) { return item.second.isShared; };
    if (static_cast<size_t>(std::ranges::count_if(model_, isShared)) >= kMaxSharedObjects) return;
    ModelObject object;
    for (std::byte& byte : object.id) byte = static_cast<std::byte>(random_());
    object.options.sharing = static_cast<Sharing>(below(4));
    object.options.delivery = below(3) == 0 ? Delivery::OnDemand : Delivery::Push;
    object.options.keptVersions = static_cast<uint32_t>(below(3));
    object.options.mostUnread = below(4) == 0 ? 3 : 0;
    object.options.name = "object " + std::to_string(below(40));
    object.slotCount = below(10) == 0 ? 64 : static_cast<uint32_t>(1 + below(6));
    const auto number = master_->share({object.id, object.options, layoutWith(object.slotCount)});
    if (!number) return fail(number.error().message);
    model_[number.value()] = object;
}

void ObjectSimulation::commit() {
    if (model_.empty()) return;
    auto at = model_.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(below(model_.size())));
    auto& [number, object] = *at;
    if (!object.isShared || (object.options.sharing == Sharing::Static && !object.versions.empty())) return;
    if (master_->readerBehind(number)) return;
    const bool isWhole = object.versions.empty() || object.options.sharing != Sharing::Delta;
    ModelVersion next = object.versions.empty() ? ModelVersion{} : object.versions.back();
    next.slots.resize(object.slotCount);
    next.blobs.resize(object.slotCount);
    uint64_t slots = isWhole ? allSlots(object.slotCount) : random_() & random_() & allSlots(object.slotCount);
    if (slots == 0) slots = 1;
    for (uint32_t i = 0; i < object.slotCount; ++i) {
        if ((slots >> i & 1) == 0) continue;
        next.slots[i] = randomBytes();
        next.blobs[i].clear();
        if (below(10) != 0) continue;
        if (blobs_.size() < 30 || below(4) == 0) {
            Bytes contents = randomBytes();
            if (below(10) == 0) contents.resize(below(700'000));
            contents.push_back(std::byte{1});
            blobs_.push_back(Blob::copyOf(contents).value());
        }
        next.blobs[i].push_back(blobs_[below(blobs_.size())]);
        next.slots[i].resize(24); // encoded bytes are never shorter than their references
    }
    ObjectChange change;
    change.slots = slots;
    for (uint32_t i = 0; i < object.slotCount; ++i)
        if ((slots >> i & 1) != 0) change.values.push_back({next.slots[i], next.blobs[i]});
    object.versions.push_back(next);
    ++commits_;
    const auto version = master_->commit(number, change);
    if (!version) return fail(version.error().message);
    if (version.value() != object.versions.size()) fail("a version was skipped");
}

void ObjectSimulation::unshare() {
    if (model_.empty() || below(2) == 0) return;
    auto at = model_.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(below(model_.size())));
    if (!at->second.isShared) return;
    at->second.isShared = false;
    master_->unshare(at->first);
}

void ObjectSimulation::frame() {
    uint64_t slowest = frame_;
    for (const auto& reader : readers_) slowest = std::min(slowest, reader->doneFrame);
    if (frame_ >= slowest + kFramesUnderWay) return; // the frame credit
    collect();
    master_->frame(++frame_);
    stream_.emplace_back();
}

void ObjectSimulation::finishFrame(Reader& reader) {
    if (reader.doneFrame >= reader.expected.frame) return;
    checkFrames(reader);
    ++reader.doneFrame;
    reader.expected.frames.erase(reader.doneFrame);
    reader.mirror->frameDone(reader.doneFrame);
    uint64_t slowest = frame_;
    for (const auto& other : readers_) slowest = std::min(slowest, other->doneFrame);
    master_->frameDone(slowest);
}

void ObjectSimulation::join() {
    if (readers_.size() >= kMaxReaders) return;
    auto reader = std::make_unique<Reader>();
    reader->id = nextReader_++;
    reader->toWriter = std::make_unique<Line>();
    reader->mirror = std::make_unique<ObjectMirror>(*reader->toWriter);
    collect();
    if (options_.usesKeeper) {
        reader->position = keeperPosition_;
        reader->expected.newest = keeperExpected_.newest;
        reader->expected.frame = keeperExpected_.frame;
        reader->mirror->frame(keeperExpected_.frame);
        reader->mirror->frameDone(keeperExpected_.frame);
        reader->doneFrame = reader->firstFrame = keeperExpected_.frame;
        keeper_->writeCatalogue(BlobTransfer::Bytes, [&](std::span<const std::byte> message) {
            const auto result = reader->mirror->input(message, nowNs_);
            if (!result) fail("catalogue: " + result.error().message);
        });
        if (!reader->mirror->hasCatalogue()) fail("the catalogue has no end");
        master_->join(reader->id, "reader");
    } else {
        reader->position = stream_.size();
        reader->expected.frame = reader->doneFrame = reader->firstFrame = frame_;
        reader->mirror->frame(frame_);
        reader->mirror->frameDone(frame_);
        master_->join(reader->id, "reader");
    }
    readers_.push_back(std::move(reader));
}

void ObjectSimulation::lose() {
    if (readers_.empty()) return;
    const size_t at = below(readers_.size());
    const PeerId id = readers_[at]->id;
    readers_.erase(readers_.begin() + static_cast<std::ptrdiff_t>(at));
    if (options_.fault != Fault::TokenKept) {
        master_->leave(id);
    } else {
        hasFault_ = true;
    }
    std::erase_if(requests_, [&](const auto& request) { return request.first == id && below(2) == 0; });
}

void ObjectSimulation::ask(Reader& reader) {
    if (model_.empty()) return;
    auto at = model_.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(below(model_.size())));
    const Version version = below(2) == 0 ? 0 : below(at->second.versions.size() + 1);
    reader.mirror->want({at->second.id, version}, nowNs_);
}

// Moves new messages into the lanes.
void ObjectSimulation::collect() {
    for (Bytes& message : fromWriter_.all) stream_.push_back(std::move(message));
    fromWriter_.all.clear();
    for (auto& [peer, message] : fromWriter_.one)
        for (auto& reader : readers_)
            if (reader->id == peer) reader->own.push_back(message);
    fromWriter_.one.clear();
    for (auto& reader : readers_) {
        for (auto& [peer, message] : reader->toWriter->one) requests_.emplace_back(reader->id, std::move(message));
        reader->toWriter->one.clear();
    }
}

// Requests of readers overtake each other.
bool ObjectSimulation::deliverRequest() {
    if (requests_.empty()) return false;
    const size_t at = below(requests_.size());
    const auto [reader, message] = requests_[at];
    requests_.erase(requests_.begin() + static_cast<std::ptrdiff_t>(at));
    (void)master_->input(reader, message, nowNs_); // may refer to a lost reader
    ++delivered_;
    return true;
}

void ObjectSimulation::expect(Expectation& expected, const Bytes& message) {
    if (message.empty()) {
        expected.frames[++expected.frame] = expected.newest;
        return;
    }
    const auto decoded = decode(message);
    if (const auto* commit = std::get_if<CommitMessage>(&*decoded)) {
        Version& newest = expected.newest[commit->number];
        newest = std::max(newest, commit->version); // replies to several readers may be old
    } else if (const auto* offer = std::get_if<OfferMessage>(&*decoded)) {
        expected.newest[offer->number] = offer->version;
    } else if (const auto* ended = std::get_if<UnshareMessage>(&*decoded)) {
        expected.newest.erase(ended->number);
    }
}

bool ObjectSimulation::advanceKeeper() {
    if (keeperPosition_ >= stream_.size()) return false;
    const Bytes& message = stream_[keeperPosition_++];
    expect(keeperExpected_, message);
    if (message.empty()) return true;
    const auto result = keeper_->input(message, nowNs_);
    if (!result) fail("keeper: " + result.error().message);
    ++delivered_;
    return true;
}

ObjectSimulation::Bytes ObjectSimulation::damaged(const Bytes& message) {
    if (hasFault_ || message.empty() || options_.fault != Fault::WrongVersion || below(20) != 0) return message;
    auto decoded = decode(message);
    auto* const commit = std::get_if<CommitMessage>(&*decoded);
    if (!commit || commit->base == 0) return message;
    hasFault_ = true;
    ++commit->version;
    ++commit->base;
    const auto buffer = encode(*decoded);
    return {buffer.bytes().begin(), buffer.bytes().end()};
}

bool ObjectSimulation::deliver(Reader& reader) {
    if (reader.position >= stream_.size()) return false;
    const auto kindAt = [&](size_t at) {
        return at < stream_.size() && !stream_[at].empty() ? static_cast<MessageKind>(stream_[at].front())
                                                           : MessageKind::Share;
    };
    const auto isDelta = [&](size_t at) {
        const auto decoded = decode(stream_[at]);
        const auto* const commit = std::get_if<CommitMessage>(&*decoded);
        return commit && commit->base != 0 && model_.at(commit->number).isShared;
    };
    const bool isCommit = kindAt(reader.position) == MessageKind::Commit;
    if (!hasFault_ && options_.fault == Fault::DeltaLost && isCommit && below(5) == 0 && isDelta(reader.position)) {
        hasFault_ = true;
        expect(reader.expected, stream_[reader.position++]);
        return true;
    }
    const Bytes message = stream_[reader.position];
    const Bytes following = reader.position + 1 < stream_.size() ? stream_[reader.position + 1] : Bytes();
    if (!hasFault_ && options_.fault == Fault::OrderSwapped && isCommit && !following.empty() &&
        kindAt(reader.position + 1) == MessageKind::Commit && isDelta(reader.position + 1)) {
        const auto first = decode(message), second = decode(following);
        if (std::get<CommitMessage>(*first).number == std::get<CommitMessage>(*second).number) {
            hasFault_ = true;
            reader.position += 2;
            receive(reader, following, true);
            receive(reader, message, true);
            return true;
        }
    }
    ++reader.position;
    receive(reader, message, true);
    return true;
}

bool ObjectSimulation::deliverOwn(Reader& reader) {
    if (reader.own.empty()) return false;
    const Bytes message = std::move(reader.own.front());
    reader.own.pop_front();
    receive(reader, message, false);
    return true;
}

void ObjectSimulation::receive(Reader& reader, const Bytes& message, bool isToAll) {
    ++delivered_;
    if (isToAll) expect(reader.expected, message);
    if (message.empty()) return reader.mirror->frame(reader.expected.frame);
    const auto decoded = decode(message);
    const auto result = reader.mirror->input(isToAll ? damaged(message) : message, nowNs_);
    const bool isRefusal = std::holds_alternative<RefuseMessage>(*decoded);
    if (!result && !isRefusal) fail("reader: " + result.error().message);
    if (const auto* commit = std::get_if<CommitMessage>(&*decoded)) checkObject(reader, commit->number);
}

void ObjectSimulation::compare(const Reader& reader, ObjectNumber number, const ObjectState& state) {
    ++states_;
    const ModelObject& object = model_.at(number);
    const std::string name = "reader " + std::to_string(reader.id) + ", object " + std::to_string(number) +
                             " version " + std::to_string(state.version);
    if (state.version == 0 || state.version > object.versions.size()) return fail(name + " was never committed");
    const ModelVersion& version = object.versions[state.version - 1];
    for (uint32_t i = 0; i < object.slotCount; ++i) {
        if (state.slots[i]->bytes != version.slots[i]) return fail(name + ": other bytes in slot " + std::to_string(i));
        if (state.slots[i]->blobs.size() != version.blobs[i].size()) return fail(name + ": other blobs");
        for (size_t k = 0; k < version.blobs[i].size(); ++k)
            if (!(state.slots[i]->blobs[k]->blob == version.blobs[i][k])) {
                const BlobName want = version.blobs[i][k].name();
                for (size_t at = 0; at < stream_.size(); ++at) {
                    if (stream_[at].empty()) continue;
                    const auto m = decode(stream_[at]);
                    if (const auto* b = std::get_if<BlobBeginMessage>(&*m); b && b->blob.name == want)
                        printf("%zu begin %llu\n", at, (unsigned long long)b->blob.sizeBytes);
                    if (const auto* b = std::get_if<BlobDataMessage>(&*m); b && b->name == want)
                        printf("%zu data %llu +%zu\n", at, (unsigned long long)b->offset, b->bytes.size());
                    if (const auto* c = std::get_if<CommitMessage>(&*m))
                        for (auto& v : c->values)
                            for (auto& r : v.blobs)
                                if (r.name == want)
                                    printf("%zu commit %u v%llu base %llu del %d\n", at, c->number,
                                           (unsigned long long)c->version, (unsigned long long)c->base,
                                           int(model_[c->number].options.delivery));
                    if (const auto* u = std::get_if<UnshareMessage>(&*m)) printf("%zu unshare %u\n", at, u->number);
                }
                return fail(name + ": another blob " + std::to_string(version.blobs[i][k].sizeBytes()) + " here " +
                            std::to_string(state.slots[i]->blobs[k]->isHere));
            }
    }
}

void ObjectSimulation::checkObject(const Reader& reader, ObjectNumber number) {
    const auto object = model_.find(number);
    const auto expected = reader.expected.newest.find(number);
    if (object == model_.end() || expected == reader.expected.newest.end()) return;
    const auto found = reader.mirror->find({object->second.id, 0});
    const bool isPushed = object->second.options.delivery == Delivery::Push;
    if (found.state) {
        compare(reader, number, *found.state);
        if (options_.usesKeeper && isPushed && found.state->version != expected->second)
            fail("reader " + std::to_string(reader.id) + " has version " + std::to_string(found.state->version) +
                 " of object " + std::to_string(number) + " instead of " + std::to_string(expected->second));
    } else if (options_.usesKeeper && isPushed && expected->second > 0) {
        fail("reader " + std::to_string(reader.id) + " has no state of object " + std::to_string(number));
    }
}

// Every frame in progress sees exactly the versions that were committed before its end.
void ObjectSimulation::checkFrames(const Reader& reader) {
    for (const auto& [frame, versions] : reader.expected.frames) {
        if (frame <= reader.doneFrame) continue;
        for (const auto& [number, version] : versions) {
            const ModelObject& object = model_.at(number);
            if (version == 0 || object.options.sharing == Sharing::Unbuffered) continue;
            const auto found = reader.mirror->findAtFrame(object.id, frame);
            const bool isPushed = object.options.delivery == Delivery::Push;
            const std::string name = "reader " + std::to_string(reader.id) + ", frame " + std::to_string(frame) +
                                     ", object " + std::to_string(number);
            if (found.state && (options_.usesKeeper || isPushed)) {
                compare(reader, number, *found.state);
                if (options_.usesKeeper && found.state->version != version)
                    fail(name + " has version " + std::to_string(found.state->version) + " instead of " +
                         std::to_string(version));
            } else if (options_.usesKeeper && isPushed) {
                fail(name + " has no state");
            }
        }
    }
}

void ObjectSimulation::drain() {
    // Three rounds: replies cause further requests, and lost replies are requested again.
    for (int round = 0; round < 3 && problem_.empty(); ++round) {
        for (auto& reader : readers_)
            for (const auto& [number, object] : model_)
                if (object.isShared) reader->mirror->want({object.id, 0}, nowNs_);
        for (bool moved = true; moved && problem_.empty();) {
            collect();
            moved = advanceKeeper() || deliverRequest();
            for (auto& reader : readers_) moved = deliver(*reader) || deliverOwn(*reader) || moved;
            nowNs_ += 3'000'000;
            master_->tick(nowNs_);
        }
        nowNs_ += 2 * BlobIntake::kRetryNs;
        for (auto& reader : readers_) reader->mirror->tick(nowNs_);
        collect();
    }
}

void ObjectSimulation::checkEnd() {
    for (const auto& reader : readers_) {
        checkFrames(*reader);
        for (const auto& [number, object] : model_) {
            if (!object.isShared || object.versions.empty()) continue;
            const auto found = reader->mirror->find({object.id, 0});
            const std::string name = "at the end, reader " + std::to_string(reader->id) + ", object " +
                                     std::to_string(number) + " version " + std::to_string(object.versions.size());
            if (!found.state) return fail(name + " is missing");
            compare(*reader, number, *found.state);
            if (found.state->version != object.versions.size())
                return fail(name + " is at version " + std::to_string(found.state->version));
        }
    }
    for (const auto& [number, object] : model_) {
        if (object.options.delivery == Delivery::OnDemand || !object.isShared || object.versions.empty()) continue;
        const StatePointer state = keeper_->newest(object.id);
        if (!state) return fail("the keeper has no state of object " + std::to_string(number));
        compare({}, number, *state);
        if (state->version != object.versions.size()) return fail("the keeper has an old version");
        if (const auto behind = master_->readerBehind(number)) return fail("the token of a reader is missing");
    }
    if (keeper_->objectCount() != master_->objectCount()) return fail("the keeper has other objects than the writer");
}

} // namespace mural::objects::test
