// Spellings of enumeration values.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "balancer/config/config.hpp"

namespace mural::config {

template <class E> struct Spelling {
    std::string_view word;
    E value;
};

// The writer uses the first of several spellings.
inline constexpr auto spellings(Eye) {
    return std::to_array<Spelling<Eye>>({{"CYCLOP", Eye::Cyclop}, {"LEFT", Eye::Left}, {"RIGHT", Eye::Right}});
}
inline constexpr auto spellings(Task) {
    return std::to_array<Spelling<Task>>(
        {{"CLEAR", Task::Clear}, {"DRAW", Task::Draw}, {"ASSEMBLE", Task::Assemble}, {"READBACK", Task::Readback}});
}
inline constexpr auto spellings(Buffer) {
    return std::to_array<Spelling<Buffer>>({{"COLOR", Buffer::Color}, {"DEPTH", Buffer::Depth}});
}
inline constexpr auto spellings(ColorComponent) {
    return std::to_array<Spelling<ColorComponent>>(
        {{"RED", ColorComponent::Red}, {"GREEN", ColorComponent::Green}, {"BLUE", ColorComponent::Blue}});
}
inline constexpr auto spellings(FrameType) {
    return std::to_array<Spelling<FrameType>>({{"memory", FrameType::Memory}, {"texture", FrameType::Texture}});
}
inline constexpr auto spellings(WallType) {
    return std::to_array<Spelling<WallType>>({{"fixed", WallType::Fixed}, {"HMD", WallType::Hmd}});
}
inline constexpr auto spellings(ViewMode) {
    return std::to_array<Spelling<ViewMode>>({{"MONO", ViewMode::Mono}, {"STEREO", ViewMode::Stereo}});
}
inline constexpr auto spellings(FocusMode) {
    return std::to_array<Spelling<FocusMode>>({{"fixed", FocusMode::Fixed},
                                               {"relative_to_origin", FocusMode::RelativeToOrigin},
                                               {"relative_to_observer", FocusMode::RelativeToObserver}});
}
inline constexpr auto spellings(SplitMode) {
    return std::to_array<Spelling<SplitMode>>({{"2D", SplitMode::TwoD},
                                               {"DB", SplitMode::Db},
                                               {"HORIZONTAL", SplitMode::Horizontal},
                                               {"VERTICAL", SplitMode::Vertical}});
}
// The last two lines map types of early releases to the closest type of today.
inline constexpr auto spellings(ConnectionType) {
    return std::to_array<Spelling<ConnectionType>>({{"TCPIP", ConnectionType::Tcp},
                                                    {"PIPE", ConnectionType::Pipe},
                                                    {"RSP", ConnectionType::Rsp},
                                                    {"RDMA", ConnectionType::Rdma},
                                                    {"UDT", ConnectionType::Udt},
                                                    {"SDP", ConnectionType::Tcp},
                                                    {"IB", ConnectionType::Rdma},
                                                    {"MCIP", ConnectionType::Rsp},
                                                    {"PGM", ConnectionType::Rsp}});
}
inline constexpr auto spellings(PathStep) {
    return std::to_array<Spelling<PathStep>>({{"canvas", PathStep::Canvas},
                                              {"segment", PathStep::Segment},
                                              {"layout", PathStep::Layout},
                                              {"view", PathStep::View}});
}

template <class E> constexpr std::string_view wordOf(E value) {
    for (const auto& s : spellings(E{})) {
        if (s.value == value) return s.word;
    }
    return {};
}

// Selects among words with the same integer when an attribute is written.
enum class AttributeKind : uint8_t { Switch, Number, Statistics, Affinity };

} // namespace mural::config
