// The model of resources as in the file: node, pipe, window, channel.
#pragma once

#include <string>
#include <vector>

#include "balancer/config/attribute_values.hpp"
#include "balancer/config/source_position.hpp"
#include "common/geometry/viewport.hpp"

namespace mural::config {

enum class ConnectionType : uint8_t { Tcp, Pipe, Rsp, Rdma, Udt };

// An address that a node listens on.
struct Connection {
    std::optional<ConnectionType> type;
    std::optional<std::string> hostname;   // RSP: the multicast group
    std::optional<std::string> interface_; // RSP: address of the network interface
    std::optional<uint32_t> port;
    std::optional<uint32_t> bandwidth; // in kB/s of 1024 bytes
    std::optional<std::string> filename;
    SourcePosition at;
    friend bool operator==(const Connection&, const Connection&) = default;
};

struct ChannelAttributes {
    Attribute hintStatistics, hintSendToken;
    std::optional<std::string> dumpImage;
    friend bool operator==(const ChannelAttributes&, const ChannelAttributes&) = default;
};

struct Channel {
    std::optional<std::string> name;
    std::optional<Viewport> viewport; // in pixels if its size exceeds 1, otherwise relative to the window
    ChannelAttributes attributes;
    SourcePosition at;
    friend bool operator==(const Channel&, const Channel&) = default;
};

struct WindowAttributes {
    Attribute hintCoreProfile, hintOpenglMajor, hintOpenglMinor, hintStereo, hintDoublebuffer, hintFullscreen,
        hintDecoration;
    Attribute hintSwapsync, hintDrawable, hintStatistics, hintScreensaver, hintGrabPointer;
    Attribute planesColor, planesAlpha, planesDepth, planesStencil, planesAccum, planesAccumAlpha, planesSamples;
    friend bool operator==(const WindowAttributes&, const WindowAttributes&) = default;
};

struct Window {
    std::optional<std::string> name;
    std::optional<Viewport> viewport; // in pixels if its size exceeds 1, otherwise relative to the pipe
    WindowAttributes attributes;
    std::vector<Channel> channels;
    SourcePosition at;
    friend bool operator==(const Window&, const Window&) = default;
};

struct PipeAttributes {
    Attribute hintThread, hintAffinity;
    friend bool operator==(const PipeAttributes&, const PipeAttributes&) = default;
};

// One GPU and the thread that feeds it.
struct Pipe {
    std::optional<std::string> name;
    std::optional<uint32_t> port;     // number of the X server
    std::optional<uint32_t> device;   // X screen, or GPU index
    std::optional<Viewport> viewport; // in pixels; empty: the machine's screen
    PipeAttributes attributes;
    std::vector<Window> windows;
    SourcePosition at;
    friend bool operator==(const Pipe&, const Pipe&) = default;
};

struct NodeAttributes {
    std::optional<std::string> launchCommand;
    std::optional<char> launchCommandQuote;
    Attribute launchTimeout; // ms
    Attribute threadModel, hintAffinity, hintStatistics;
    friend bool operator==(const NodeAttributes&, const NodeAttributes&) = default;
};

struct Node {
    std::optional<std::string> name;
    std::optional<std::string> host;
    std::vector<Connection> connections;
    NodeAttributes attributes;
    std::vector<Pipe> pipes;
    SourcePosition at;
    friend bool operator==(const Node&, const Node&) = default;
};

// Returns true if a viewport is in pixels. [0 0 1 1] is the whole, never one pixel.
[[nodiscard]] constexpr bool inPixels(const Viewport& v) { return v.w > 1 || v.h > 1; }

} // namespace mural::config
