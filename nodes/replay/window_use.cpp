#include "nodes/replay/window_use.hpp"

#include <string_view>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/opcode_names.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

namespace {

bool clearsBuffer(std::string_view name) {
    return name == "glClear" || name == "glClearBufferfv" || name == "glClearBufferfi" || name == "glClearBufferiv" || name == "glClearBufferuiv";
}

bool draws(std::string_view name) {
    if (name.starts_with("glDrawBuffer")) return false;
    if (clearsBuffer(name)) return true;
    for (const std::string_view stem : {"glDraw", "glMultiDraw", "glMultiMode", "glBegin", "glCallList", "glRect", "glEvalMesh", "glBitmap", "glCopyPixels", "glBlit", "glAccum", "glClear"}) {
        if (!name.starts_with(stem)) continue;
        // State, not drawing: glClearColor, glBeginQuery, …
        if (stem == "glBegin") return name == "glBegin";
        if (stem == "glClear") return name.starts_with("glClearNamedFramebuffer");
        return true;
    }
    return false;
}

} // namespace

WindowUse useOf(uint16_t opcode) {
    static const auto kUses = [] {
        std::vector<WindowUse> uses(op::kLimit, WindowUse::None);
        for (uint16_t o = wire::kFirstGlOpcode; o < op::kLimit; ++o) {
            const char* name = glOpcodeName(o);
            const std::string_view text = name ? name : "";
            if (text.starts_with("glBeginTransformFeedback") || text.starts_with("glResumeTransformFeedback")) uses[o] = WindowUse::FeedbackBegins;
            else if (text.starts_with("glEndTransformFeedback")) uses[o] = WindowUse::FeedbackEnds;
            else if (draws(text)) uses[o] = clearsBuffer(text) ? WindowUse::Clears : WindowUse::Draws;
        }
        return uses;
    }();
    return kUses[opcode];
}

} // namespace mural
