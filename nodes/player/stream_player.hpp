// The interface of players, which draw the streams of programs on a render node. The node process owns one player: a
// Replay for captured programs (nodes/replay), or the tasks of a program that uses the native API (native/runtime).
//
// Thread safety: the player's thread calls everything, which is the thread of the node's stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/gl/gl_platform.hpp"
#include "nodes/player/player_setup.hpp"
#include "nodes/session/range_assignment.hpp"
#include "nodes/session/viewport_assignment.hpp"
#include "streamcodec/wire/node_messages.hpp"

namespace mural {

class StreamPlayer {
public:
    virtual ~StreamPlayer() = default;
    // Plays the payload of one packet. Returns false if the stream is broken beyond this packet; the log has the
    // reason.
    virtual bool packet(uint32_t stream, std::span<const std::byte> payload) = 0;
    // Called for a packet that arrives while the player waits in PlayerOutputs::readAhead. packet() follows later, in
    // order. Must not draw.
    virtual void preview(uint32_t /*stream*/, std::span<const std::byte> /*payload*/) {}
    virtual void clientGone(uint32_t client) = 0;
    // Ends the skipping of frames: each window is drawn from its next frame on.
    virtual void drawAgain() = 0;
    // Time-multiplex: returns the state of all windows that determines their turns.
    [[nodiscard]] virtual std::vector<wire::WindowTurn> turns() const = 0;
    // Sets the turns that another node reported for this position of the stream.
    virtual void takeTurns(std::span<const wire::WindowTurn> turns) = 0;
    // Called if no node has the turns. The node of the first turn keeps frames in progress, and all nodes restart their
    // counts.
    virtual void beginTurns() = 0;
    // Sort-last: handles the return of a node; `itself`: this node has returned. All nodes of the picture call it at
    // the same position of the stream. `returned` is called between the last composition without the returned node and
    // the first one with it.
    virtual void resetShares(bool itself, std::function<void()> returned) = 0;
    // Announces new shares. Each window adopts them with the first shared draw of its next frame.
    virtual void moveShares(const RangeAssignment& shares) = 0;
    // Requires PlayerConfig::areas. Applies new areas to each window at its next frame that allows it.
    virtual void moveAreas(ViewportAssignment areas) = 0;
    // Returns the payload of a Turns message: the areas that divide this node's windows.
    [[nodiscard]] virtual std::vector<std::byte> memberAreas() const = 0;
    // Sets the areas from such a payload of another node. Returns false if malformed.
    virtual bool takeMemberAreas(std::span<const std::byte> bytes) = 0;
    // Called if no node has the areas. Divides all windows by the latest ones.
    virtual void beginAreas() = 0;
    // Reports whether the next shown frames depend on skipped draws.
    [[nodiscard]] virtual wire::FrameValidity validity() const = 0;
    [[nodiscard]] virtual const PlayerCounts& counts() const = 0;
};

// Makes the player of a node. `platform` becomes the player's. Errors: the node cannot draw.
using MakePlayer = std::function<Result<std::unique_ptr<StreamPlayer>>(
    std::unique_ptr<gl::Platform> platform, const PlayerConfig& config, PlayerOutputs outputs)>;

} // namespace mural
