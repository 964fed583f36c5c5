// Identifiers of bindings: kind, target, unit or index.
#pragma once

#include <cstdint>

#include "streamcodec/effect_rules.hpp"

namespace mural::snapshot {

enum class Slot : uint8_t {
    Texture = 1,
    Buffer,
    IndexedBuffer,
    DrawFramebuffer,
    ReadFramebuffer,
    Renderbuffer,
    VertexArray,
    Sampler,
    Image,
    Program,
    Pipeline,
    Feedback,
    ArbProgram
};

constexpr uint64_t slotOf(Slot kind, uint32_t target = 0, uint32_t index = 0) {
    return uint64_t{static_cast<uint8_t>(kind)} << 56 | uint64_t{index & 0xffffff} << 32 | target;
}
constexpr Slot slotKind(uint64_t slot) { return static_cast<Slot>(slot >> 56); }
constexpr uint32_t slotTarget(uint64_t slot) { return static_cast<uint32_t>(slot); }
constexpr uint32_t slotIndex(uint64_t slot) { return static_cast<uint32_t>(slot >> 32) & 0xffffff; }
constexpr ObjectType typeOf(Slot kind) {
    switch (kind) {
    case Slot::Texture:
    case Slot::Image: return ObjectType::Texture;
    case Slot::Buffer:
    case Slot::IndexedBuffer: return ObjectType::Buffer;
    case Slot::DrawFramebuffer:
    case Slot::ReadFramebuffer: return ObjectType::Framebuffer;
    case Slot::Renderbuffer: return ObjectType::Renderbuffer;
    case Slot::VertexArray: return ObjectType::VertexArray;
    case Slot::Sampler: return ObjectType::Sampler;
    case Slot::Program: return ObjectType::Program;
    case Slot::Pipeline: return ObjectType::Pipeline;
    case Slot::Feedback: return ObjectType::Feedback;
    default: return ObjectType::ArbProgram;
    }
}

} // namespace mural::snapshot
