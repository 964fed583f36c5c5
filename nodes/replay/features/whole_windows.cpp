// Windows that a node draws whole although its pass has only every nth pixel. This starts with the frame after the one
// that needed it.
//
// Copies, and commands that write single pixels into a window, need all of its pixels. Texture lookups select a level
// by the distance to the next drawn pixel, which is n times too large. Rewritten desktop GLSL uses the window's
// distance (texture_gradients.hpp). Lookups of fixed function, ARB programs and OpenGL ES cannot be rewritten. In a
// zoomed picture, levels follow the zoomed pixels. Source: OpenGL 4.6, 8.14.1 (scale factor and level-of-detail).
#include <cstring>

#include "gl_opcodes.hpp"
#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural {

namespace {

constexpr GLuint kFixedUnits = 4; // texture units that are queried; textures of other units alone are not detected
// draws checked per frame; if any draw of a longer frame uses levels, one of these is assumed to
constexpr int kMaxLevelChecks = 256;

uint32_t secondOf(std::span<const std::byte> arguments) {
    uint32_t words[2] = {};
    std::memcpy(words, arguments.data(), std::min(arguments.size(), sizeof words));
    return words[1];
}

} // namespace

// Returns whether the next draw looks up textures with several levels, and selects these by the pixels drawn here.
bool Replay::choosesOwnLevels() const {
    const bool shaders = c_->program != 0 || c_->pipelineBound;
    if (!hasKernel() || !c_->shared || !c_->shared->texturesHaveLevels || (shaders && c_->api == wire::Api::Desktop))
        return false;
    if (shaders || !gl.glIsEnabledi || c_->api != wire::Api::Desktop) return true;
    if (c_->arbPositions || gl.glIsEnabled(GL_FRAGMENT_PROGRAM_ARB)) return true;
    for (GLuint unit = 0; unit < kFixedUnits; ++unit)
        for (const GLenum target : {GL_TEXTURE_2D, GL_TEXTURE_1D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP})
            if (gl.glIsEnabledi(target, unit)) return true;
    return false;
}

void Replay::onWholeWindow(uint16_t opcode, std::span<const std::byte> arguments) {
    const WholeUse use = wholeUseOf(opcode);
    if (use == WholeUse::None) return;
    if (use == WholeUse::Copies || use == WholeUse::Draw) {
        if (!drawsWindow() || !c_->draw || c_->draw->copied) return;
        Window& w = *c_->draw;
        w.copied = use == WholeUse::Copies || (++w.levelChecks <= kMaxLevelChecks && choosesOwnLevels());
        return;
    }
    if (!c_->shared) return;
    const uint32_t second = secondOf(arguments);
    const bool levels = use == WholeUse::AllLevels || (use == WholeUse::Level && second > 0) ||
                        (use == WholeUse::Levels && second > 1) ||
                        (use == WholeUse::Parameter && second == GL_GENERATE_MIPMAP);
    c_->shared->texturesHaveLevels = c_->shared->texturesHaveLevels || levels;
}

} // namespace mural
