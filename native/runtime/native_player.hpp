// Draws the frames of a program with the native API: the StreamPlayer of a node that runs the program's own binary.
//
// A frame depends on the objects of the application alone, never on earlier pictures. Skipped frames, changed areas and
// changed turns therefore need no state of other nodes.
#pragma once

#include <deque>
#include <map>
#include <set>

#include <mural/render.hpp>

#include "native/runtime/client_objects.hpp"
#include "native/runtime/gl_target.hpp"
#include "native/runtime/task_state.hpp"
#include "nodes/player/stream_player.hpp"

namespace mural::native {

class NativePlayer final : public StreamPlayer {
public:
    // Errors: the renderer's context cannot be created; Renderer::start has failed.
    static Result<std::unique_ptr<StreamPlayer>> open(std::unique_ptr<gl::Platform> platform,
                                                      const PlayerConfig& config, PlayerOutputs outputs,
                                                      std::unique_ptr<Renderer> renderer);
    ~NativePlayer() override;

    bool packet(uint32_t stream, std::span<const std::byte> payload) override;
    void preview(uint32_t stream, std::span<const std::byte> payload) override;
    void clientGone(uint32_t client) override;
    void drawAgain() override { skips_ = false; }
    [[nodiscard]] std::vector<wire::WindowTurn> turns() const override { return {}; }
    void takeTurns(std::span<const wire::WindowTurn>) override {}
    void beginTurns() override {}
    void resetShares(bool itself, std::function<void()> returned) override;
    void moveShares(const RangeAssignment& shares) override;
    void moveAreas(ViewportAssignment areas) override;
    [[nodiscard]] std::vector<std::byte> memberAreas() const override;
    bool takeMemberAreas(std::span<const std::byte> bytes) override;
    void beginAreas() override {}
    [[nodiscard]] wire::FrameValidity validity() const override { return wire::FrameValidity::Valid; }
    [[nodiscard]] const PlayerCounts& counts() const override { return counts_; }

private:
    struct Client {
        Client(ClientObjects::Send send, const ClientObjects::Await& await, bool mapsBlobs)
            : objects(std::move(send), await, mapsBlobs) {}
        ClientObjects objects;
        std::map<uint32_t, wire::WindowConfig> windows;
        wire::NativeFrame frame{};
    };

    NativePlayer(const PlayerConfig& config, PlayerOutputs outputs, std::unique_ptr<Renderer> renderer)
        : config_(config),
          out_(std::move(outputs)),
          renderer_(std::move(renderer)),
          share_(config.pass.share),
          ranges_(config.ranges) {}

    Client& clientOf(uint32_t id);
    void takeObjects(uint32_t stream, uint16_t opcode, std::span<const std::byte> arguments);
    bool record(Client& client, uint32_t clientId, uint16_t opcode, std::span<const std::byte> arguments);
    void onSwap(uint32_t clientId, Client& client, uint32_t window, uint32_t frame);
    void drawFrame(Client& client, uint32_t clientId, const FramePart& part, const wire::WindowConfig& window,
                   uint32_t frame);
    void compose(uint32_t clientId, const FramePart& part, uint32_t frame, PicturePart pixel, TaskState& task);
    std::vector<int> blendOrder(TaskState& state);
    const std::byte* pixelsOf(const FramePart& part, const PixelViewport& box);
    // Runs a task. Reports exceptions and GL errors once per text.
    void runTask(const char* name, const std::function<void()>& task);
    void reportOnce(const std::string& text);
    [[nodiscard]] bool takesRanges() const { return config_.pass.ranges > 1; }

    const PlayerConfig config_;
    PlayerOutputs out_;
    std::unique_ptr<GlTarget> target_;
    std::unique_ptr<Renderer> renderer_; // destroyed before the target
    Pipe pipe_;
    bool hasStarted_ = false;
    std::map<uint32_t, std::unique_ptr<Client>> clients_;
    uint64_t previewed_ = 0; // packets whose objects are known
    PlayerCounts counts_;
    bool skips_ = false;      // draws no frames
    bool isEnding_ = false;   // no more objects arrive: the program or the session has ended
    bool isComposing_ = true; // false: in resync, no composition before resetShares()
    std::optional<ViewportAssignment> areas_;
    Range share_;
    std::vector<Range> ranges_;                 // of all nodes of the picture, by rank
    uint32_t sharesNumber_ = 0;                 // 0: the initial shares
    std::deque<std::function<void()>> returns_; // to be called before the next composition
    std::optional<FramePart> lastPart_;
    std::optional<PicturePart> composed_; // the picture of all ranges, if this node collects it
    std::vector<std::byte> pixels_;       // of the latest pixelsOf()
    std::set<std::string> reported_;
};

} // namespace mural::native
