// Windows of which a node draws all pixels, though its pass has every nth one only: from the frame behind the one in which that was seen.
//
// What puts pixels into a window one by one, or copies them, needs all of them to be there. And what looks textures up chooses their level
// by the distance to the next pixel that is drawn, which is n times as far: desktop GLSL is given the window's (texture_gradients.hpp), but
// the lookups of fixed function, ARB programs and OpenGL ES are not ours to change. A zoom's levels are those of its own pixels.
// Source: OpenGL 4.6, 8.14.1 (scale factor and level-of-detail).
#include <cstring>

#include "gl_opcodes.hpp"
#include "nodes/replay/command_uses.hpp"
#include "nodes/replay/replay.hpp"

namespace mural {

namespace {

constexpr GLuint kFixedUnits = 4; // that are asked for; who textures by others only, does not by these
constexpr int kMostAsked = 256;   // draws of a frame: of more, one that does is among them

uint32_t secondOf(std::span<const std::byte> arguments) {
    uint32_t words[2] = {};
    std::memcpy(words, arguments.data(), std::min(arguments.size(), sizeof words));
    return words[1];
}

} // namespace

// Whether the next draw looks textures up that have levels, by something that chooses them by the pixels that are drawn here.
bool Replay::choosesOwnLevels() const {
    const bool shaders = c_->program != 0 || c_->pipelineBound;
    if (!hasKernel() || !c_->shared || !c_->shared->texturesHaveLevels || (shaders && c_->api == wire::Api::Desktop)) return false;
    if (shaders || !gl.glIsEnabledi || c_->api != wire::Api::Desktop) return true;
    if (c_->arbPositions || gl.glIsEnabled(GL_FRAGMENT_PROGRAM_ARB)) return true;
    for (GLuint unit = 0; unit < kFixedUnits; ++unit)
        for (const GLenum target : {GL_TEXTURE_2D, GL_TEXTURE_1D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP})
            if (gl.glIsEnabledi(target, unit)) return true;
    return false;
}

void Replay::noteWholeWindow(uint16_t opcode, std::span<const std::byte> arguments) {
    const WholeUse use = wholeUseOf(opcode);
    if (use == WholeUse::None) return;
    if (use == WholeUse::Copies || use == WholeUse::Draw) {
        if (!drawsWindow() || !c_->draw || c_->draw->copied) return;
        Window& w = *c_->draw;
        w.copied = use == WholeUse::Copies || (++w.askedOfLevels <= kMostAsked && choosesOwnLevels());
        return;
    }
    if (!c_->shared) return;
    const uint32_t second = secondOf(arguments);
    const bool levels = use == WholeUse::AllLevels || (use == WholeUse::Level && second > 0) || (use == WholeUse::Levels && second > 1) || (use == WholeUse::Parameter && second == GL_GENERATE_MIPMAP);
    c_->shared->texturesHaveLevels = c_->shared->texturesHaveLevels || levels;
}

} // namespace mural
