// Writes the corpus of objects_fuzz. Usage: objects_fuzz_seeds FOLDER. It has sessions of a writer, catalogues, and the
// messages of readers, queues and barriers.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "objects/core/object_keeper.hpp"
#include "objects/core/object_master.hpp"
#include "tests/fuzz/objects/objects_input.hpp"

namespace mural::fuzz {
namespace {

using namespace mural::objects;

class SeedFile : public MessageSink {
public:
    void toAll(std::span<const std::byte> message) override { add(message); }
    void toOne(PeerId, std::span<const std::byte> message) override { add(message); }
    void add(std::span<const std::byte> message) {
        bytes_.push_back(static_cast<char>(message.size() & 0xff));
        bytes_.push_back(static_cast<char>(message.size() >> 8));
        for (const std::byte byte : message) bytes_.push_back(static_cast<char>(byte));
        messages.emplace_back(message.begin(), message.end());
    }
    void add(const Message& message) { add(encode(message).bytes()); }
    void save(const std::filesystem::path& path) const {
        std::ofstream(path, std::ios::binary).write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    }
    std::vector<std::vector<std::byte>> messages;

private:
    std::vector<char> bytes_;
};

FuzzedObject exampleObject(int step) {
    FuzzedObject object;
    object.angle = step;
    object.title = "frame " + std::to_string(step);
    object.heights = {1, 2, static_cast<float>(step)};
    object.names = {"a", "bc"};
    object.flags = {{1, true}, {2, step % 2 != 0}};
    if (step % 3 == 1) object.choice = Range{.1, .2};
    if (step % 3 == 2) object.choice = "text";
    if (step % 2) object.area = PixelViewport{1, 2, 3, 4};
    object.tree = {step, {{1, {}}, {2, {{3, {}}}}}};
    const std::vector<std::byte> mesh(static_cast<size_t>(20 + step), std::byte{7});
    object.mesh = Blob::copyOf(mesh).value();
    return object;
}

void commit(ObjectMaster& master, ObjectNumber number, const FuzzedObject& object, uint64_t only) {
    archive::EncodedSlots slots;
    archive::encodeSlots(object, slots);
    ObjectChange change;
    change.slots = only & allSlots(slots.count);
    for (uint32_t i = 0; i < slots.count; ++i)
        if ((change.slots >> i & 1) != 0) change.values.push_back({slots.bytesOf(i), slots.blobsOf(i)});
    (void)master.commit(number, change);
}

void saveSession(const std::filesystem::path& folder, Sharing sharing, Delivery delivery, const std::string& name) {
    SeedFile file, ignored;
    ObjectMaster master(file, {.gatherNs = 0});
    ObjectKeeper keeper(ignored);
    const ShareOptions options{.sharing = sharing, .delivery = delivery, .mostUnread = 2, .name = "object"};
    const auto number = master.share({Uuid{std::byte{1}}, options, archive::layoutOf<FuzzedObject>()});
    for (int step = 0; step < 4; ++step)
        commit(master, number.value(), exampleObject(step), sharing == Sharing::Delta && step > 0 ? 0x155 : UINT64_MAX);
    for (const auto& message : file.messages) (void)keeper.input(message, 0);
    file.add(WantMessage{number.value(), 0, 1});
    file.add(WantBlobMessage{exampleObject(3).mesh.name(), 0, 100});
    file.add(TokenMessage{number.value(), 1});
    file.add(UnshareMessage{number.value()});
    file.save(folder / name);
    SeedFile catalogue;
    keeper.writeCatalogue(BlobTransfer::Bytes, [&](std::span<const std::byte> message) { catalogue.add(message); });
    if (delivery == Delivery::Push) catalogue.save(folder / (name + "_catalogue"));
}

} // namespace
} // namespace mural::fuzz

int main(int argc, char** argv) {
    using namespace mural::fuzz;
    if (argc != 2) return std::fputs("objects_fuzz_seeds FOLDER\n", stderr), 2;
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    saveSession(folder, mural::Sharing::Delta, mural::Delivery::Push, "delta");
    saveSession(folder, mural::Sharing::Instance, mural::Delivery::Push, "instance");
    saveSession(folder, mural::Sharing::Delta, mural::Delivery::OnDemand, "on_demand");
    saveSession(folder, mural::Sharing::Unbuffered, mural::Delivery::OnDemand, "unbuffered");
    SeedFile others;
    others.add(AskMessage{1, 3});
    others.add(DoneMessage{1, 1});
    others.add(ItemMessage{1, 1, 2, {}});
    others.add(ClosedMessage{1});
    others.add(EnterMessage{1, 2, 3});
    others.add(GoMessage{1, 2, 3});
    others.add(LateMessage{1, 2, "left"});
    others.add(RefuseMessage{Refusal::GoneVersion, 1, 2, {}});
    others.add(BlobAtMessage{{{}, 100'000, 1, 2, 3}});
    others.save(folder / "others");
    return 0;
}
