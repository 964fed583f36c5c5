// Culling of display lists: a node leaves out native lists of nothing but primitives that cannot touch its area.
//
// Lists are not divided. Mesa's attributes differed after lists that were cut between primitives and state
// (docs/architecture/culling.md).
#include <algorithm>
#include <cstring>
#include <utility>

#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "nodes/replay/features/culling.hpp"
#include "streamcodec/command_effects.hpp"

namespace mural {

namespace {

using culling::WhyWhole;
using State = replay::CullingState;

constexpr unsigned kUnknownChanges = State::Matrices | State::Raster | State::Program;

// Parts of the state that a command in a list changes.
unsigned changesOf(uint16_t opcode, std::span<const std::byte> arguments, replay::CullingGroup& group) {
    switch (cullUseOf(opcode)) {
    case CullUse::None:
    case CullUse::Draw:
    case CullUse::Immediate:
    case CullUse::EndImmediate: return 0;
    case CullUse::Matrices:
    case CullUse::MatrixMode: return State::Matrices;
    case CullUse::Raster: return State::Raster;
    case CullUse::Cap: {
        GLenum cap = 0;
        if (arguments.size() >= sizeof cap) std::memcpy(&cap, arguments.data(), sizeof cap);
        group.capSeen(cap);
        return group.hasSeen(cap) ? unsigned{State::Raster} : 0U;
    }
    default: return kUnknownChanges;
    }
}

} // namespace

// Called for each command of a list before its compilation. A list that is also executed during its compilation is
// drawn whole, because its primitives also reach the frame at once.
void Replay::onListed(uint16_t opcode, std::span<const std::byte> arguments) {
    if (opcode < wire::kFirstGlOpcode || effectOf(opcode).kind == EffectKind::EndList || !c_->shared) return;
    replay::ContextCulling& its = cullingOf(*c_);
    const bool isSplit = !c_->compilesPrimitive && splitsLists(opcode, arguments);
    if (isSplit) return; // in no native list
    its.section.take(opcode, arguments);
    its.sectionChanges |= changesOf(opcode, arguments, c_->shared->culling);
}

void Replay::setAttributes(std::span<const replay::ListedAttribute> attributes) {
    NoBlobs blobs;
    for (const replay::ListedAttribute& attribute : attributes) {
        Args in(attribute.arguments, blobs);
        (void)replayFunction(attribute.opcode)(*this, in);
    }
}

// Called after the end of a native list. Attributes that primitives set are left behind by a primitive with one vertex,
// which draws nothing: Mesa treats attributes outside of primitives in another way.
void Replay::endListSection() {
    if (!c_->shared || c_->building.items.empty()) return;
    replay::ContextCulling& its = cullingOf(*c_);
    DisplayListItem& item = c_->building.items.back();
    item.cullingChanges = std::exchange(its.sectionChanges, 0);
    const replay::ListSection section = std::exchange(its.section, {});
    if (!section.isPlain() || c_->compileMode != GL_COMPILE) return;
    auto primitives = std::make_shared<replay::ListedPrimitives>(section.primitives());
    if (!section.attributesBefore().empty() || !section.attributesInside().empty()) {
        primitives->after = gl.glGenLists(1);
        gl.glNewList(primitives->after, GL_COMPILE);
        setAttributes(section.attributesBefore());
        gl.glBegin(GL_TRIANGLES);
        setAttributes(section.attributesInside());
        gl.glVertex2f(0, 0);
        gl.glEnd();
        gl.glEndList();
    }
    item.primitives = std::move(primitives);
}

bool Replay::isListedOutside(const replay::ListedPrimitives& primitives, WhyWhole& why) {
    replay::CullingState& state = cullingOf(*c_).state;
    replay::CullingProgram* program = nullptr;
    why = whyNoView(program);
    if (why == WhyWhole::None && program && program->attributes != std::vector<GLint>{-1}) why = WhyWhole::Attribute;
    if (why != WhyWhole::None) return false;
    double margin = 0;
    for (GLenum mode = GL_POINTS; mode <= GL_POLYGON; ++mode)
        if (primitives.modes >> mode & 1)
            margin = std::max(margin, state.raster(gl, c_->shared->culling).marginOf(mode));
    const replay::CullingArray position{.components = 4};
    const culling::TilePlanes* const planes = planesFor(margin, program, {&position, 1});
    if (!planes) why = WhyWhole::Shader;
    return planes && planes->inputs() == primitives.lowest.size() &&
           planes->placeOf(primitives.lowest.data(), primitives.highest.data()) == culling::Place::Outside;
}

// Called before a native list of the program is executed. Returns true if the node leaves it out.
bool Replay::cullListed(const DisplayListItem& item) {
    if (!c_->shared) return false;
    replay::CullingState& state = cullingOf(*c_).state;
    unsigned changes = item.cullingChanges;
    if (culling_->plantsLists) changes &= ~unsigned{State::Matrices};
    const bool isLeftOut = [&] {
        if (!item.primitives || c_->compiling) return false;
        replay::CullingDraw draw;
        draw.mode = GL_TRIANGLES;
        WhyWhole why = state.isInPrimitive ? WhyWhole::Command : whyUnexamined(0, draw);
        if (why == WhyWhole::None && c_->draw->drawn.contains(c_->draw->whole)) return false;
        const uint64_t vertices = item.primitives->vertices;
        const bool isOutside = why == WhyWhole::None && isListedOutside(*item.primitives, why);
        countCulling(isOutside ? culling::Cut::Nothing : culling::Cut::Whole, vertices, isOutside ? 0 : vertices, why);
        return isOutside;
    }();
    if (isLeftOut) {
        if (culling_->mode == CullingMode::Audit) auditSamples([&] { gl.glCallList(item.native); });
        separatePrimitives();
        if (item.primitives->after) gl.glCallList(item.primitives->after);
    }
    state.changed(changes);
    if (changes & State::Matrices) state.setMatrixMode(0, false);
    return isLeftOut;
}

} // namespace mural
