// Messages from the head to the render nodes. A packet of the head's own stream, streamOf(0, 0), holds one message.
#pragma once

#include <cstdint>

namespace mural::wire {

// First word of a packet of the head's own stream.
constexpr uint32_t kNoNode = 0xFFFFFFFF;

enum class HeadCommand : uint32_t {
    Setup = 1,      // json: tiles, regions, outputs, backend, rewriting mode (nodes/session/session_config.hpp)
    ClientGone = 2, // u32 client: frees its contexts and windows
    Finish = 3,     // the last packet: the node replies Goodbye and exits
    // json: {"pictures", "swaps"}: HOST:PORT of each node that composites pictures, or leads a swap barrier, by its
    // number.
    Exchange = 4,
    // u32 view, u32 node, u32 first, u32 incarnation, u32 absent*: the restarted node, which has received everything
    // before, is a member from here on. All members reply ViewReached.
    //   first        1: no other member has phases; the phases restart
    //   incarnation  of the node
    //   absent       nodes that are no members; the node's picture is composited without them
    // node kNoNode: no node becomes a member; only a position.
    Activate = 5,
    // u32 number, u32 draws: to a node in resync, which replies Synchronized. draws = 1: it draws each window from its
    // next frame on.
    Synchronize = 6,
    ResetDictionary = 7, // the dictionary is cleared: later batches refer to nothing earlier
    // u32 number: members with phases, or with areas that move, reply Turns for a node whose resync begins here.
    RequestPhase = 8,
    Turns = 9, // contents of a member's Turns message: to a node in resync, after all packets before that RequestPhase
    JoinMulticast = 10, // u32 node: joins the multicast group of its Setup; packets continue on its own connection
    // SwitchToMulticastCommand: the last packet, or batch, on the node's own connection. The group carries it too, and
    // carries all later ones alone.
    SwitchToMulticast = 11,
    // u32 number, u32 nodes, {f64 x, y, w, h, zoom} of each: area of the picture, and zoom relative to Setup's. A
    // window takes them at its next full clear.
    ViewportAssignment = 12,
    // u32 number, u32 nodes, {f64 start, end} of each: the ranges of a frame's draws that nodes draw, from the next
    // shared draws of each window on.
    RangeAssignment = 13,
    Statistics = 14,  // u32 on: the node sends FrameSpans with each frame from here on, or no longer
    ClockProbe = 15,  // i64 sentNs: the node replies ClockReply
    Leave = 16,       // u32 node: that node sends everything about earlier packets, replies Goodbye, and is no member
    Overlay = 17,     // u32 mode of each node, by number (nodes/overlay/overlay_mode.hpp): drawn over its windows
    ProveOutput = 18, // ProveOutputCommand: the node replies OutputProof (streamcodec/wire/output_proof.hpp)
    WantPreview = 19, // WantPreviewCommand: nodes with windows reply PreviewTile (streamcodec/wire/preview_tile.hpp)
};
struct SwitchToMulticastCommand {
    uint32_t node;
    uint32_t skipLow, skipHigh; // bytes that the group carried between the join and this packet, or batch
};

} // namespace mural::wire
