// Checks over the whole command list: class, traits and effect of each command agree, and so do the classes that
// replay, capture and filters derive from them. The rules name each exception and its reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/filter/command_class.hpp"
#include "interposer/encode/draw_opcodes.hpp"
#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/features/window_use.hpp"
#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_table.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/opcode_names.hpp"
#include "streamcodec/wire/control_records.hpp"

using namespace mural;
using enum Trait;

namespace {

using Predicate = std::function<bool(uint16_t opcode)>;

// Every command with `premise` has `conclusion`, except those in `exceptions`.
struct Implication {
    std::string_view text;
    Predicate premise, conclusion;
    std::vector<uint16_t> exceptions;
};

template <class... Traits> Predicate has(Traits... traits) {
    return [=](uint16_t opcode) { return hasTrait(opcode, traits...); };
}

Predicate hasEffect(std::vector<EffectKind> kinds) {
    return [kinds = std::move(kinds)](uint16_t opcode) {
        return std::ranges::count(kinds, kCommandEffects[opcode].kind) > 0;
    };
}

Predicate operator!(const Predicate& p) {
    return [=](uint16_t opcode) { return !p(opcode); };
}

Predicate either(const Predicate& a, const Predicate& b) {
    return [=](uint16_t opcode) { return a(opcode) || b(opcode); };
}

Predicate both(const Predicate& a, const Predicate& b) {
    return [=](uint16_t opcode) { return a(opcode) && b(opcode); };
}

std::vector<uint16_t> sentCommands() {
    std::vector<uint16_t> sent;
    for (uint16_t opcode = wire::kFirstGlOpcode; opcode < op::kLimit; ++opcode)
        if (glOpcodeName(opcode) != nullptr) sent.push_back(opcode);
    return sent;
}

// Returns the names of the commands that break the rule, and of superfluous exceptions.
std::vector<std::string> disagreements(const Implication& rule) {
    std::vector<std::string> found;
    for (const uint16_t opcode : sentCommands()) {
        const bool breaks = rule.premise(opcode) && !rule.conclusion(opcode);
        const bool isException = std::ranges::count(rule.exceptions, opcode) > 0;
        if (breaks && !isException) found.emplace_back(glOpcodeName(opcode));
        if (!breaks && isException) found.push_back(std::string(glOpcodeName(opcode)) + " (not an exception)");
    }
    return found;
}

void expectAll(std::span<const Implication> rules) {
    for (const Implication& rule : rules) EXPECT_EQ(disagreements(rule), std::vector<std::string>()) << rule.text;
}

const Predicate kWrites = has(Draw, Pixels, Clear, ClearBuffer, ClearNamed, Begin, CallList); // to the draw framebuffer
const Predicate kUnknown = hasEffect({EffectKind::Unknown, EffectKind::UnknownNames});

} // namespace

TEST(CommandTraits, areOfClassDrawExactlyWhenTheCommandWritesPixelsOrOrdersThem) {
    const Predicate output = either(kWrites, has(Vertex, End, Compute, Barrier));
    const Implication rules[] = {
        {"output is of class draw", output, has(DrawClass), {}},
        {"class draw is output", has(DrawClass), output, {}},
        {"copies out of a framebuffer are state, unless they write to one",
         both(has(ReadsFramebuffer), !has(Pixels)),
         !has(DrawClass),
         {}},
    };
    expectAll(rules);
}

// A driver gives a window its size at the first of these commands; textures from drawables are refreshed before them.
TEST(CommandTraits, areWindowDrawsWhenTheyAccessFramebuffers) {
    const Predicate draws = [](uint16_t opcode) { return drawsIntoWindow(opcode); };
    const Implication rules[] = {
        {"output", kWrites, draws, {}},
        {"vertices", has(Vertex), draws, {}},
        {"positions", has(Position), has(Vertex), {}},
        {"reads", has(ReadsFramebuffer), draws, {}},
        {"nothing else", draws, has(DrawClass, ReadsFramebuffer), {}},
    };
    expectAll(rules);
    EXPECT_TRUE(drawsIntoWindow(wire::kOpClientArrays));
    EXPECT_FALSE(drawsIntoWindow(wire::kOpSwap));
    EXPECT_FALSE(drawsIntoWindow(UINT16_MAX));
}

TEST(CommandTraits, agreeWithEffects) {
    using enum EffectKind;
    const Predicate drawEffect = hasEffect({EffectKind::Draw, EffectKind::Compute, EffectKind::Clear,
                                            EffectKind::ClearBuffer, Blit, EffectKind::Barrier, EffectKind::Begin,
                                            EffectKind::Vertex, EffectKind::End, EffectKind::CallList, CallLists});
    const Implication rules[] = {
        // glPrimitiveRestartNV is no vertex: it restarts the primitive. The program's own context executes it to track
        // that.
        {"an effect on pixels is of class draw", drawEffect, has(DrawClass), {op::glPrimitiveRestartNV}},
        {"class draw has such an effect, or an unknown one", has(DrawClass), either(drawEffect, kUnknown), {}},
        {"draws and pixels",
         either(has(Trait::Draw, Pixels), has(SkippableDraw)),
         either(hasEffect({EffectKind::Draw, Blit}), kUnknown),
         {}},
        {"clears", has(Trait::Clear), hasEffect({EffectKind::Clear}), {}},
        {"clears of a buffer", has(Trait::ClearBuffer), hasEffect({EffectKind::ClearBuffer}), {}},
        {"vertices", has(Trait::Vertex), hasEffect({EffectKind::Vertex}), {}},
        {"begin", has(Trait::Begin), hasEffect({EffectKind::Begin}), {}},
        {"end", has(Trait::End), hasEffect({EffectKind::End}), {}},
        {"lists", has(Trait::CallList), hasEffect({EffectKind::CallList, CallLists}), {}},
        {"compute", has(Trait::Compute), either(hasEffect({EffectKind::Compute}), kUnknown), {}},
        {"barriers", has(Trait::Barrier), hasEffect({EffectKind::Barrier}), {}},
        {"copies to textures", hasEffect({TexCopyImage, TexCopySubImage}), has(ReadsFramebuffer), {}},
        {"matrices", hasEffect({MatrixLoad, MatrixChange, MatrixPush, MatrixPop}), has(Matrix), {}},
        {"no other matrices",
         has(Matrix),
         either(hasEffect({MatrixLoad, MatrixChange, MatrixPush, MatrixPop}), kUnknown),
         {}},
        {"queries begin", hasEffect({EffectKind::QueryBegin}), has(Trait::QueryBegin), {}},
        {"queries end", hasEffect({EffectKind::QueryEnd}), has(Trait::QueryEnd), {}},
        {"feedback begins", hasEffect({EffectKind::FeedbackBegin}), has(Trait::FeedbackBegin), {}},
        {"feedback ends", hasEffect({EffectKind::FeedbackEnd}), has(Trait::FeedbackEnd), {}},
        {"uploads to buffers", hasEffect({EffectKind::BufferData, EffectKind::BufferSubData}), has(BufferContents), {}},
        {"buffers with new memory", hasEffect({EffectKind::BufferData}), has(Allocates), {}},
        {"images with new memory",
         hasEffect({TexImage, TexStorage, TexCopyImage, TexMipmaps, RenderbufferStorage}),
         has(Allocates),
         {}},
        {"images of levels", hasEffect({TexImage, TexSubImage, TexCopyImage, TexCopySubImage}), has(TextureLevel), {}},
        {"storage of levels", hasEffect({TexStorage}), has(TextureLevels), {}},
        {"mipmaps", hasEffect({TexMipmaps}), has(TextureAnyLevel), {}},
        {"texture parameters", hasEffect({TexParameter}), has(TextureParameter), {}},
        {"capabilities", hasEffect({Cap}), has(OrderState), {}},
        {"framebuffers", hasEffect({FramebufferAttach, FramebufferNamed}), has(FramebufferObject), {}},
    };
    expectAll(rules);
}

TEST(CommandTraits, excludeEachOther) {
    const Implication rules[] = {
        {"skippable draws are draws", has(SkippableDraw), has(Draw), {}},
        {"rectangles are draws", has(DrawRectangle), has(Draw), {}},
        {"rectangles are not skippable", has(DrawRectangle), !has(SkippableDraw), {}},
        {"draws from feedback are draws", has(FeedbackDraw), has(Draw), {}},
        {"pixels of all planes are pixels", has(AllPlanes), has(Pixels), {}},
        {"draws are not pixels",
         has(Draw),
         !has(Pixels, Clear, ClearBuffer, ClearNamed, Vertex, Begin, End, CallList),
         {}},
        {"state is not output",
         has(OrderState, Matrix, Viewport, RasterPosition, UniformMatrix4, BufferContents),
         !has(DrawClass),
         {}},
        {"memory is not output",
         has(Allocates, TextureLevel, TextureLevels, TextureAnyLevel, TextureParameter),
         !has(DrawClass),
         {}},
    };
    expectAll(rules);
}

TEST(CommandUses, agreeInReplay) {
    const auto range = [](RangeUse use) -> Predicate {
        return [=](uint16_t opcode) { return rangeUseOf(opcode) == use; };
    };
    const auto eye = [](EyeUse use) -> Predicate { return [=](uint16_t opcode) { return eyeUseOf(opcode) == use; }; };
    const auto whole = [](WholeUse use) -> Predicate {
        return [=](uint16_t opcode) { return wholeUseOf(opcode) == use; };
    };
    const auto window = [](WindowUse use) -> Predicate {
        return [=](uint16_t opcode) { return useOf(opcode) == use; };
    };
    const Predicate writes = either(window(WindowUse::Draws), window(WindowUse::Clears));
    const Predicate rangeKnows =
        either(either(range(RangeUse::Draw), range(RangeUse::Begin)),
               either(range(RangeUse::Clear), either(range(RangeUse::Read), range(RangeUse::Feedback))));
    const Implication rules[] = {
        {"output is of class draw", writes, has(DrawClass), {}},
        // Sort-last sees the commands of a list, or counts them when the list is compiled.
        {"sort-last classifies output", writes, rangeKnows, {op::glCallList, op::glCallLists}},
        {"draws of sort-last write", either(range(RangeUse::Draw), range(RangeUse::Clear)), writes, {}},
        {"primitives of sort-last write", range(RangeUse::Begin), writes, {}},
        {"draws of sort-last move with the eye",
         either(range(RangeUse::Draw), range(RangeUse::Begin)),
         eye(EyeUse::Draw),
         {}},
        // A raster position is transformed as a vertex, and an image from the client is part of the scene.
        {"draws of the eye write", both(eye(EyeUse::Draw), !has(RasterPosition)), writes, {}},
        {"lists", eye(EyeUse::List), whole(WholeUse::Draw), {}},
        {"draws sample textures",
         either(range(RangeUse::Draw), range(RangeUse::Begin)),
         either(whole(WholeUse::Draw), whole(WholeUse::Copies)),
         {}},
        {"commands that sample textures are output",
         either(whole(WholeUse::Draw), whole(WholeUse::Copies)),
         writes,
         {}},
    };
    expectAll(rules);
}

// Deferred uploads are sent before a command that may read them.
TEST(CommandClasses, excludeCommandsThatMayReadDeferredUploads) {
    using filter::CommandClass;
    const auto about = [](CommandClass c) -> Predicate {
        return [=](uint16_t opcode) { return filter::CommandKinds::all()[opcode].about == c; };
    };
    const auto role = [](filter::StateRole r) -> Predicate {
        return [=](uint16_t opcode) { return filter::stateRoleOf(opcode) == r; };
    };
    const Predicate pass = about(CommandClass::Pass);
    const Implication rules[] = {
        {"draws", has(Draw, Compute, RasterPosition), !pass, {}},
        {"images and bitmaps", both(has(Pixels), !has(ReadsFramebuffer)), !pass, {}},
        {"primitives", has(Begin, End, CallList), !pass, {}},
        {"uploads", has(TextureLevel, TextureLevels, TextureAnyLevel, BufferContents), !pass, {}},
        {"output uses or changes state",
         kWrites,
         either(role(filter::StateRole::Use), role(filter::StateRole::Change)),
         {}},
        {"copies use state",
         has(ReadsFramebuffer),
         either(role(filter::StateRole::Use), role(filter::StateRole::Change)),
         {}},
        {"cells set state", role(filter::StateRole::Set), !has(DrawClass), {}},
    };
    expectAll(rules);
}

// The compiler evaluates the table. GCC 12 loses defaults other than 0 for elements that the table does not name.
TEST(CommandEffects, haveDefaultsForCommandsThatAreNeverSent) {
    for (uint16_t opcode = 0; opcode < op::kLimit; ++opcode) {
        if (glOpcodeName(opcode) != nullptr) continue;
        EXPECT_EQ(effectOf(opcode), CommandEffect{}) << opcode;
    }
    EXPECT_EQ(effectOf(op::kLimit), CommandEffect{});
    EXPECT_EQ(traitsOf(op::kLimit), 0U);
}

TEST(CommandEffects, agreeWithCellsAndRoles) {
    using enum EffectKind;
    const Predicate hasCell = [](uint16_t opcode) { return effectOf(opcode).cell != StateCell::None; };
    const Predicate isChecked = [](uint16_t opcode) { return effectOf(opcode).check != StateCheck::Any; };
    const Predicate splits = [](uint16_t opcode) { return effectOf(opcode).list != ListRole::Native; };
    const Predicate divides = [](uint16_t opcode) { return effectOf(opcode).draw.count > 0; };
    const Predicate names = [](uint16_t opcode) { return effectOf(opcode).nameNumber > 0; };
    const Implication rules[] = {
        {"cells are state", hasCell, hasEffect({Cell, EffectKind::Limit, MatrixMode}), {}},
        {"checks belong to cells", isChecked, hasCell, {}},
        {"cells do not stand alone", hasCell, !has(StandsAlone), {}},
        {"divisible draws are draws from arrays", divides, has(SkippableDraw), {}},
        {"capabilities and calls of lists split lists", either(hasEffect({Cap}), has(Trait::CallList)), splits, {}},
        {"accumulation splits lists", has(Accumulates), splits, {}},
        {"bindings name an object", hasEffect({Bind, BindIndexed, UseProgram, FramebufferAttach}), names, {}},
        {"bindings and attachments have a type",
         hasEffect({Bind, BindIndexed, UseProgram, FramebufferAttach}),
         [](uint16_t opcode) { return effectOf(opcode).object != ObjectType::None; },
         {}},
        {"layers are attached to framebuffers", has(AttachesLayer), has(FramebufferObject), {}},
        {"clears of one plane",
         has(ClearsColor, ClearsDepth, ClearsStencil, ClearsDepthStencil),
         has(Trait::ClearBuffer),
         {}},
        {"bitmaps and accumulation are pixels of one kind",
         has(Bitmap, Accumulates),
         both(has(Pixels), !has(AllPlanes)),
         {}},
        {"inputs of links set programs", has(LinkInput), hasEffect({ProgramSet}), {}},
        {"samplers are uniforms", has(SamplerUniform), hasEffect({Uniform, ProgramUniform}), {}},
    };
    expectAll(rules);
}

// Aliases share the opcode and the class of their canonical command.
TEST(CommandTable, hasEverySentCommandWithOneClass) {
    for (const CommandInfo& c : commandTable()) {
        const char* const name = c.opcode == 0 ? nullptr : glOpcodeName(c.opcode);
        if (name == nullptr) continue;
        EXPECT_EQ(hasTrait(c.opcode, DrawClass), std::string_view(c.commandClass) == "draw") << c.name;
        EXPECT_TRUE(c.supported) << c.name;
        EXPECT_EQ(std::string_view(findCommand(name)->commandClass), c.commandClass) << c.name;
    }
}

// These commands were of class `state`, although all other tables had them as draws.
TEST(CommandTraits, classifyRectanglesInWindowCoordinatesAsDraws) {
    for (const uint16_t opcode :
         {op::glDrawTexfOES, op::glDrawTexfvOES, op::glDrawTexiOES, op::glDrawTexivOES, op::glDrawTexsOES,
          op::glDrawTexsvOES, op::glDrawTexxOES, op::glDrawTexxvOES, op::glDrawTextureNV}) {
        EXPECT_TRUE(hasTrait(opcode, DrawClass)) << glOpcodeName(opcode);
        EXPECT_TRUE(drawsIntoWindow(opcode)) << glOpcodeName(opcode);
        EXPECT_EQ(useOf(opcode), WindowUse::Draws) << glOpcodeName(opcode);
        EXPECT_EQ(wholeUseOf(opcode), WholeUse::Copies) << glOpcodeName(opcode);
    }
}
