// Feeds a sequence of arbitrary messages to a reader, a keeper, a writer and a queue. A damaged message changes no
// state, memory stays in proportion to the input, and a catalogue of the keeper is accepted by a new reader.
#include "objects/core/object_keeper.hpp"
#include "objects/ends/object_writer.hpp"
#include "objects/ends/reader_core.hpp"
#include "objects/queue/queue_master.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/objects/objects_input.hpp"

namespace mural::fuzz {

namespace {

using namespace mural::objects;

// Counts messages; their contents do not matter.
class CountingSink : public MessageSink {
public:
    void toAll(std::span<const std::byte> message) override { sentBytes += message.size(); }
    void toOne(PeerId, std::span<const std::byte> message) override { sentBytes += message.size(); }
    uint64_t sentBytes = 0;
};

void feedQueue(ObjectQueueMaster& queue, const Message& message) {
    if (const auto* ask = std::get_if<AskMessage>(&message)) (void)queue.input(1, *ask);
    if (const auto* done = std::get_if<DoneMessage>(&message)) (void)queue.input(1, *done);
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    CountingSink sink;
    ReaderEnd end(sink);
    ObjectKeeper keeper(sink);
    ObjectMaster master(sink, {.gatherNs = 1000});
    master.join(1, "reader");
    archive::EncodedSlots slots;
    archive::encodeSlots(FuzzedObject{}, slots);
    ObjectChange change{allSlots(slots.count), {}};
    for (uint32_t i = 0; i < slots.count; ++i) change.values.push_back({slots.bytesOf(i), {}});
    const auto number = master.share({Uuid{std::byte{1}}, {.mostUnread = 1}, archive::layoutOf<FuzzedObject>()});
    must(number && master.commit(number.value(), change), "the first commit succeeds");
    ObjectQueueMaster queue(sink, 1);
    must(static_cast<bool>(queue.push(slots.bytesOf(0))), "an open queue accepts an item");

    uint64_t meant = 0;
    int64_t nowNs = 0;
    uint64_t frame = 0;
    for (auto message = nextMessage(input); !message.empty(); message = nextMessage(input)) {
        nowNs += 700'000'000; // requests are repeated after a second
        const auto decoded = decode(message);
        if (decoded) {
            const auto again = encode(*decoded);
            must(decode(again.bytes()).has_value(), "an encoded message can be decoded");
            feedQueue(queue, *decoded);
            if (const auto* at = std::get_if<BlobAtMessage>(&*decoded)) {
                must(at->place.pid >= 0 && at->place.fd >= 0, "a place has no negative numbers");
                continue; // opens files of other processes
            }
        }
        meant += end.input(message, nowNs).ok();
        meant += keeper.input(message, nowNs).ok();
        meant += master.input(1, message, nowNs).ok();
        end.tick(nowNs);
        keeper.tick(nowNs);
        master.tick(nowNs);
        if (decoded && std::holds_alternative<CommitMessage>(*decoded)) {
            end.frame(++frame);
            (void)end.reader().stateAt<FuzzedObject>(frame, "object", Deadline::inMs(0));
            (void)end.reader().get(Ref<FuzzedObject>{{Uuid{std::byte{1}}, 0}}, Deadline::inMs(0));
            if (frame > 2) end.frameDone(frame - 2);
        }
    }
    ReaderEnd newcomer(sink);
    keeper.writeCatalogue(BlobTransfer::Bytes, [&](std::span<const std::byte> message) {
        must(decode(message).has_value(), "the catalogue has whole messages");
        (void)newcomer.input(message, nowNs);
    });
    return meant;
}

} // namespace mural::fuzz
