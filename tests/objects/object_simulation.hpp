// A simulated session of objects: a writer, a keeper and readers that join, leave and receive messages in random
// schedules. A simple model of all committed versions decides whether readers see the right bytes.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <random>
#include <string>

#include "objects/core/object_keeper.hpp"
#include "objects/core/object_master.hpp"
#include "objects/core/object_mirror.hpp"

namespace mural::objects::test {

// Defects of the connections, or of the program around the state machines, that a test plants.
enum class Fault : uint8_t { None, DeltaLost, OrderSwapped, WrongVersion, TokenKept };

struct SimulationOptions {
    uint64_t seed = 1;
    int steps = 1000;
    // True: newcomers receive the keeper's catalogue, as in a session. False: the writer's, on a lane of their own.
    bool usesKeeper = true;
    Fault fault = Fault::None;
};

class ObjectSimulation {
public:
    explicit ObjectSimulation(const SimulationOptions& options);
    // Runs all steps, then delivers everything. Returns the first deviation from the model; empty: none.
    std::string run();

    [[nodiscard]] bool hasFault() const { return hasFault_; } // the fault has been planted
    [[nodiscard]] uint64_t delivered() const { return delivered_; }
    [[nodiscard]] uint64_t commits() const { return commits_; }
    [[nodiscard]] uint64_t states() const { return states_; } // compared with the model

private:
    using Bytes = std::vector<std::byte>;
    struct ModelVersion {
        std::vector<Bytes> slots;
        std::vector<std::vector<Blob>> blobs;
    };
    struct ModelObject {
        Uuid id{};
        ShareOptions options;
        uint32_t slotCount = 1;
        bool isShared = true;
        std::vector<ModelVersion> versions;
    };
    // The versions that a party must have after its received messages.
    struct Expectation {
        std::map<ObjectNumber, Version> newest; // pushed or offered
        uint64_t frame = 0;
        std::map<uint64_t, std::map<ObjectNumber, Version>> frames;
    };
    // Keeps the messages of one party until the simulation collects them.
    class Line : public MessageSink {
    public:
        void toAll(std::span<const std::byte> message) override { all.emplace_back(message.begin(), message.end()); }
        void toOne(PeerId peer, std::span<const std::byte> message) override {
            one.emplace_back(peer, Bytes(message.begin(), message.end()));
        }
        std::vector<Bytes> all;
        std::vector<std::pair<PeerId, Bytes>> one;
    };
    struct Reader {
        PeerId id = 0;
        std::unique_ptr<Line> toWriter;
        std::unique_ptr<ObjectMirror> mirror;
        size_t position = 0; // in the lane to all
        std::deque<Bytes> own;
        Expectation expected;
        uint64_t doneFrame = 0;
        uint64_t firstFrame = 0; // first frame that it sees in full
    };

    void step();
    void share();
    void commit();
    void unshare();
    void frame();
    void finishFrame(Reader& reader);
    void join();
    void lose();
    void ask(Reader& reader);
    bool deliver(Reader& reader);
    bool deliverOwn(Reader& reader);
    bool deliverRequest();
    bool advanceKeeper();
    void drain();
    void collect();
    void receive(Reader& reader, const Bytes& message, bool isToAll);
    static void expect(Expectation& expected, const Bytes& message);
    [[nodiscard]] Bytes damaged(const Bytes& message);

    void fail(const std::string& problem);
    void compare(const Reader& reader, ObjectNumber number, const ObjectState& state);
    void checkObject(const Reader& reader, ObjectNumber number);
    void checkFrames(const Reader& reader);
    void checkEnd();

    size_t below(size_t count) { return count == 0 ? 0 : random_() % count; }
    Bytes randomBytes();

    const SimulationOptions options_;
    std::mt19937_64 random_;
    int64_t nowNs_ = 0;
    Line fromWriter_, fromKeeper_;
    std::unique_ptr<ObjectMaster> master_;
    std::unique_ptr<ObjectKeeper> keeper_;
    std::vector<Bytes> stream_; // the lane to all; an empty message ends a frame
    size_t keeperPosition_ = 0;
    Expectation keeperExpected_;
    std::vector<std::unique_ptr<Reader>> readers_;
    std::vector<std::pair<PeerId, Bytes>> requests_;
    std::map<ObjectNumber, ModelObject> model_;
    std::vector<Blob> blobs_;
    uint64_t frame_ = 0;
    PeerId nextReader_ = 1;
    bool hasFault_ = false;
    std::string problem_;
    uint64_t delivered_ = 0, commits_ = 0, states_ = 0;
};

} // namespace mural::objects::test
