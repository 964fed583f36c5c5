#include "nodes/culling/culling_counts.hpp"

namespace mural::culling {

const char* nameOf(WhyWhole why) {
    switch (why) {
    case WhyWhole::FramebufferObject: return "framebuffer objects";
    case WhyWhole::Replicated: return "whole pictures";
    case WhyWhole::MovedPicture: return "moved pictures";
    case WhyWhole::NoDepth: return "windows without depth buffer";
    case WhyWhole::OpenQuery: return "queries";
    case WhyWhole::Memory: return "shaders that write memory";
    case WhyWhole::Stipple: return "line stipples";
    case WhyWhole::Command: return "other draw commands";
    case WhyWhole::Es: return "OpenGL ES";
    case WhyWhole::ClientMemory: return "client memory";
    case WhyWhole::ArbProgram: return "ARB vertex programs";
    case WhyWhole::Shader: return "shaders";
    case WhyWhole::Attribute: return "attributes";
    case WhyWhole::Viewports: return "viewports";
    case WhyWhole::NotFinite: return "invalid vertices";
    case WhyWhole::FirstUse: return "first uses";
    case WhyWhole::None:
    case WhyWhole::Count: break;
    }
    return "";
}

} // namespace mural::culling
