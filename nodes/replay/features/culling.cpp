// Leaves out draws, and clusters of draws, that cannot touch this node's area.
//
// Anything that is not proven is drawn. The rules follow from experiments (docs/architecture/culling.md): which draws a
// driver may be spared without a change of any other pixel.
#include "nodes/replay/features/culling.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "nodes/replay/engine/command_uses.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/record.hpp"

namespace mural {

namespace {

using culling::WhyWhole;

// Larger draws do not count in the report.
constexpr uint64_t kMaxCounted = uint64_t{1} << 31;
// A planted fault: planes inside of the area.
constexpr double kPlantedMargin = -40;

uint32_t cullWord(std::span<const std::byte> bytes, size_t index) {
    uint32_t word = 0;
    if (bytes.size() >= 4 * (index + 1)) std::memcpy(&word, bytes.data() + 4 * index, 4);
    return word;
}

// Reads the indices of a draw from its record. A blob holds larger ones; null: none.
bool readClientIndices(std::span<const std::byte> value, const std::vector<std::byte>* blob,
                       replay::CullingDraw& draw) {
    const uint32_t tag = cullWord(value, 0);
    std::span<const std::byte> bytes;
    if (tag == record::kTagBlob && blob)
        bytes = *blob;
    else if (tag <= record::kInlineBytes && value.size() >= size_t{4} + tag)
        bytes = value.subspan(4, tag);
    draw.indices = bytes;
    draw.indexOffset = reinterpret_cast<uintptr_t>(bytes.data());
    return !bytes.empty() && bytes.size() >= draw.count * replay::indexBytesOf(draw.indexType);
}

// Reads the record of a draw. Returns nothing for other commands. blob: the oldest one of the record's stream, or null.
std::optional<replay::CullingDraw> cullingDrawOf(uint16_t opcode, std::span<const std::byte> arguments,
                                                 const std::vector<std::byte>* blob) {
    const DrawWords& words = effectOf(opcode).draw;
    if (words.count == 0) return std::nullopt;
    replay::CullingDraw draw;
    draw.mode = cullWord(arguments, 0);
    const auto count = static_cast<int32_t>(cullWord(arguments, words.count));
    draw.count = count > 0 ? static_cast<uint64_t>(count) : 0;
    if (words.instances > 0) draw.instances = cullWord(arguments, words.instances);
    if (words.first > 0) draw.first = static_cast<int32_t>(cullWord(arguments, words.first));
    if (words.indices == 0) return draw;
    draw.indexType = cullWord(arguments, words.type);
    if (cullWord(arguments, words.indices) != record::kTagOffset) {
        if (words.base > 0 || arguments.size() < 4 * size_t{words.indices} ||
            !readClientIndices(arguments.subspan(4 * size_t{words.indices}), blob, draw))
            return std::nullopt;
        return draw;
    }
    if (arguments.size() < 4 * (words.indices + size_t{3})) return std::nullopt;
    if (words.base > 0) draw.first = static_cast<int32_t>(cullWord(arguments, words.base));
    std::memcpy(&draw.indexOffset, arguments.data() + 4 * (words.indices + size_t{1}), 8);
    return draw;
}

} // namespace

replay::ContextCulling& Replay::cullingOf(ContextState& c) {
    if (c.culling) return *c.culling;
    c.culling = std::make_shared<replay::ContextCulling>();
    c.culling->state.facts.isEs = c.api != wire::Api::Desktop;
    c.culling->state.facts.hasMatrices = c.api == wire::Api::Desktop && !c.core;
    c.culling->state.facts.isCore = c.core;
    c.culling->state.facts.version = c.version;
    if (c.shared) ++c.shared->culling.contexts;
    return *c.culling;
}

// Records what a command may change. Called before its execution.
void Replay::onCulling(uint16_t opcode, std::span<const std::byte> arguments) {
    if (!c_->shared) return;
    replay::CullingState& state = cullingOf(*c_).state;
    replay::CullingGroup& group = c_->shared->culling;
    using State = replay::CullingState;
    const bool seesContents = !culling_->plantsContents;
    const auto anyChanged = [&] {
        if (seesContents) group.anyBufferChanged();
    };
    switch (cullUseOf(opcode)) {
    case CullUse::None: break;
    case CullUse::Draw:
        // Rectangles and meshes are primitives of glBegin in the driver.
        state.hasPendingPrimitives = state.hasPendingPrimitives || !hasTrait(opcode, Trait::SkippableDraw);
        onCulledMemory();
        break;
    case CullUse::Matrices: state.matrixChanged(); break;
    case CullUse::MatrixMode:
        // An error within a primitive. A list may be compiled without execution.
        state.setMatrixMode(cullWord(arguments, 0), !state.isInPrimitive && !c_->compiling);
        break;
    case CullUse::Raster: state.changed(State::Raster); break;
    case CullUse::Cap:
        group.capSeen(cullWord(arguments, 0));
        if (group.hasSeen(cullWord(arguments, 0))) state.changed(State::Raster);
        break;
    case CullUse::Arrays: state.changed(State::Arrays); break;
    case CullUse::VertexArray:
        group.hasVertexArrays = group.hasVertexArrays || cullWord(arguments, 0) != 0;
        state.changed(State::VertexArray);
        break;
    case CullUse::IndexBuffer:
        if (cullWord(arguments, 0) == GL_ELEMENT_ARRAY_BUFFER) state.changed(State::IndexBuffer);
        break;
    case CullUse::BoundContents:
        if (!seesContents) break;
        if (cullWord(arguments, 0) == GL_ARRAY_BUFFER)
            group.bufferChanged(c_->arrayBuffer);
        else if (cullWord(arguments, 0) == GL_ELEMENT_ARRAY_BUFFER && bound_)
            group.bufferChanged(state.indexBuffer(gl));
        else
            anyChanged();
        break;
    case CullUse::NamedContents:
        if (seesContents) group.bufferChanged(name(Kind::Buffer, cullWord(arguments, 0)));
        break;
    case CullUse::ReadsPicture:
        if (c_->packBuffer) anyChanged();
        break;
    case CullUse::AllContents: anyChanged(); break;
    case CullUse::DeletedBuffers:
        anyChanged();
        state.changed(State::Arrays);
        if (effectOf(opcode).object == ObjectType::Buffer && (group.contexts > 1 || group.hasVertexArrays))
            onDeletedBuffers(arguments);
        break;
    case CullUse::Program: state.changed(State::Program); break;
    case CullUse::Link: ++group.links; break;
    case CullUse::Uniforms: ++group.uniforms; break;
    case CullUse::List: // its parts change the state (culling_lists.cpp)
        state.hasPendingPrimitives = true;
        onCulledMemory();
        break;
    case CullUse::Pops:
        state.changed(State::Matrices | State::Raster | State::Program);
        state.setMatrixMode(0, false);
        state.hasPendingPrimitives = true;
        onCulledMemory();
        break;
    case CullUse::EndImmediate: state.isInPrimitive = false; break;
    case CullUse::Immediate:
        state.hasPendingPrimitives = state.isInPrimitive = true;
        onCulledMemory();
        break;
    case CullUse::Everything:
        state.changed(State::All);
        state.setMatrixMode(0, false);
        anyChanged();
        ++group.links;
        ++group.uniforms;
        break;
    }
}

void Replay::onDeletedBuffers(std::span<const std::byte> arguments) {
    NoBlobs blobs;
    Args in(arguments, blobs);
    const auto count = in.get<GLsizei>();
    const Data names = in.data();
    if (!in.ok() || count < 0 || names.size() < 4 * static_cast<uint64_t>(count))
        return c_->shared->culling.unknownBuffersDeleted();
    for (GLsizei i = 0; i < count; ++i) {
        GLuint app = 0;
        std::memcpy(&app, names.as<std::byte>() + 4 * static_cast<ptrdiff_t>(i), 4);
        if (app != 0) c_->shared->culling.bufferDeleted(name(Kind::Buffer, app));
    }
}

// Called for draws, whose shaders may write to buffers.
void Replay::onCulledMemory() {
    if ((c_->program != 0 || c_->pipelineBound) && mayWriteMemory(c_->program)) c_->shared->culling.anyBufferChanged();
}

// Control records that change contents, arrays or programs.
void Replay::onCullingRecord(uint16_t opcode, std::span<const std::byte> arguments) {
    if (!c_->shared) return;
    replay::ContextCulling& its = cullingOf(*c_);
    switch (opcode) {
    case wire::kOpBlobBegin:
    case wire::kOpBlobData:
    case wire::kOpSwap:
    case wire::kOpFrontPicture:
    case wire::kOpRequestPixels:
    case wire::kOpRequestTexImage:
    case wire::kOpRequestBuffer:
    case wire::kOpRequestQuery:
    case wire::kOpRequestProgram:
    case wire::kOpMakeCurrent:
    case wire::kOpWindow:
    case wire::kOpFinish:
    case wire::kOpErrorReported: break;
    case wire::kOpClientArrays: its.state.changed(replay::CullingState::Arrays); break;
    case wire::kOpBufferBytes:
        if (!culling_->plantsContents) c_->shared->culling.bufferChanged(name(Kind::Buffer, cullWord(arguments, 0)));
        break;
    default:
        its.state.changed(replay::CullingState::All);
        its.state.setMatrixMode(0, false);
        c_->shared->culling.anyBufferChanged();
        ++c_->shared->culling.links;
        ++c_->shared->culling.uniforms;
    }
}

// OpenGL ES 2 has neither a way to read buffers nor queries of samples.
bool Replay::canReadBuffers() const {
    if (c_->api == wire::Api::Desktop) return gl.glGetBufferSubData != nullptr;
    return c_->api == wire::Api::Es2 && c_->version >= 30 && gl.glMapBufferRange && gl.glUnmapBuffer;
}

// Returns why the next draw is drawn whole, from the state of window and context.
WhyWhole Replay::whyUnexamined(uint16_t opcode, const std::optional<replay::CullingDraw>& draw) {
    const bool isShader = c_->program != 0 || c_->pipelineBound;
    if (!drawsWindow()) return WhyWhole::FramebufferObject;
    if (isReplicatedDraw() || !c_->draw || !c_->shared || c_->draw->drawn.empty()) return WhyWhole::Replicated;
    if (drawsLean() || movesPicture() || movesView() || takesRanges() || drawsOtherPixels())
        return WhyWhole::MovedPicture;
    if (c_->draw->isFlat || c_->draw->config.depth + c_->draw->config.stencil == 0) return WhyWhole::NoDepth;
    if (!canReadBuffers()) return WhyWhole::Es;
    if (!c_->openQueries.empty() || c_->feedsBack) return WhyWhole::OpenQuery;
    if (c_->pipelineBound || (isShader && mayWriteMemory(c_->program))) return WhyWhole::Memory;
    if (stipplesLines()) return WhyWhole::Stipple;
    if (!draw) return effectOf(opcode).draw.count > 0 ? WhyWhole::ClientMemory : WhyWhole::Command;
    if (draw->mode > GL_POLYGON) return WhyWhole::Command;
    return WhyWhole::None;
}

// Whether the rules allow parts of the draw. All forms with clusters, in a window with a depth buffer, gave equal
// pixels in clusters; other modes have none.
bool Replay::canCut(const replay::CullingDraw& draw, const replay::CullingProgram* program,
                    const replay::CullingState::RasterState& raster) const {
    const bool restarts = draw.indexType != 0 && (raster.restarts || raster.restartsAtLargest);
    return draw.instances == 1 && !restarts && (!program || program->mayCut);
}

// The planes of the current view and area; null: the view is not linear.
const culling::TilePlanes* Replay::planesFor(double margin, replay::CullingProgram* program,
                                             std::span<const replay::CullingArray> arrays) {
    replay::ContextCulling& its = cullingOf(*c_);
    replay::CullingPlanes& known = its.planes;
    const replay::CullingGroup& group = c_->shared->culling;
    const auto& raster = its.state.raster(gl, group);
    const GLuint nodeName = program ? name(Kind::Program, c_->program) : 0;
    if (its.state.facts.hasMatrices) (void)its.state.matrices(gl);
    size_t components = 0; // one octal digit per array
    for (const replay::CullingArray& array : arrays)
        components = components * 8 + static_cast<size_t>(array.components);
    const bool isKnownView = known.view == its.state.matricesNumber() && known.program == nodeName &&
                             known.components == components &&
                             (!program || (known.uniforms == group.uniforms && known.links == group.links));
    if (culling_->plantsMargin) margin = kPlantedMargin;
    const bool isKnownArea =
        known.raster == its.state.rasterNumber() && known.area == c_->draw->drawn && known.margin == margin;
    if (isKnownView && isKnownArea) return known.planes ? &*known.planes : nullptr;
    std::optional<culling::LinearView> before;
    if (culling_->plantsMatrix) before = known.linear;
    if (!isKnownView) known.linear = linearView(nodeName, program, arrays);
    known.program = nodeName;
    known.view = its.state.matricesNumber();
    known.raster = its.state.rasterNumber();
    known.uniforms = group.uniforms;
    known.links = group.links;
    known.components = components;
    known.area = c_->draw->drawn;
    known.margin = margin;
    known.planes.reset();
    if (!known.linear) return nullptr;
    const bool usesOldView = culling_->plantsMatrix && before && before->inputs == known.linear->inputs;
    known.planes.emplace(usesOldView ? *before : *known.linear, raster.viewport, known.area, margin);
    return &*known.planes;
}

// Finds the program of the next draw. Returns why its positions are unknown; null and None: fixed function.
WhyWhole Replay::whyNoView(replay::CullingProgram*& program) {
    const auto& raster = cullingOf(*c_).state.raster(gl, c_->shared->culling);
    program = nullptr;
    if (raster.isUpsideDown || c_->viewportsDiffer) return WhyWhole::Viewports;
    if (c_->program == 0 && raster.isArbProgram) return WhyWhole::ArbProgram;
    if (c_->program != 0) program = &cullingProgram(name(Kind::Program, c_->program));
    return (program ? !program->view : !cullingOf(*c_).state.facts.hasMatrices) ? WhyWhole::Shader : WhyWhole::None;
}

// Decides a draw. On Cut::Ranges, culling_->ranges has the kept parts.
culling::Cut Replay::cutOf(const replay::CullingDraw& draw, WhyWhole& why) {
    replay::ContextCulling& its = cullingOf(*c_);
    const auto& raster = its.state.raster(gl, c_->shared->culling);
    const auto whole = [&](WhyWhole reason) {
        why = reason;
        return culling::Cut::Whole;
    };
    replay::CullingProgram* program = nullptr;
    if (const WhyWhole reason = whyNoView(program); reason != WhyWhole::None) return whole(reason);
    if (const WhyWhole reason = readArrays(program, culling_->arrays); reason != WhyWhole::None) return whole(reason);
    const GLuint indices = draw.indexType ? its.state.indexBuffer(gl) : 0;
    if (draw.indexType && (indices != 0) != draw.indices.empty()) return whole(WhyWhole::ClientMemory);
    if (indices && c_->shared->culling.isAmbiguous(indices)) return whole(WhyWhole::Attribute);
    const bool mayCut = canCut(draw, program, raster);
    const replay::FoundBoxes found = boxesOf(draw, culling_->arrays, why);
    if (!found.boxes) return culling::Cut::Whole;
    const culling::TilePlanes* const planes = planesFor(raster.marginOf(draw.mode), program, culling_->arrays);
    if (!planes) return whole(WhyWhole::Shader);
    const bool isTried = !found.payoff->isPaused() && mayCut;
    found.payoff->skip();
    const culling::Cut cut =
        culling::cutDraw(*found.boxes, *planes, draw.count, culling::formOf(draw.mode), isTried, culling_->ranges);
    const bool saved = cut != culling::Cut::Whole;
    if (isTried || saved || found.isStreamed) found.payoff->tried(saved);
    return cut;
}

void Replay::countCulling(culling::Cut cut, uint64_t vertices, uint64_t kept, WhyWhole why) {
    culling::CullingCounts& counts = counts_.culling;
    ++(cut == culling::Cut::Whole    ? counts.drawsWhole
       : cut == culling::Cut::Ranges ? counts.drawsCut
                                     : counts.drawsLeftOut);
    counts.verticesDrawn += kept;
    counts.verticesLeftOut += vertices - std::min(kept, vertices);
    if (why != WhyWhole::None) counts.unexamined[static_cast<size_t>(why)] += vertices;
}

// Mesa collects neighbouring primitives of glBegin into one batch, whose pixels depend on the batch. Any draw separates
// them, so one without vertices takes the place of a draw that is left out.
void Replay::separatePrimitives() {
    if (std::exchange(cullingOf(*c_).state.hasPendingPrimitives, false)) gl.glDrawArrays(GL_POINTS, 0, 0);
}

// Returns true if nothing more of the draw must be drawn.
bool Replay::cullDraw(uint16_t opcode, std::span<const std::byte> arguments, BlobQueue& blobs) {
    const DrawWords& words = effectOf(opcode).draw;
    const bool mayHaveBlob = &blobs == this && s_ && s_->blobs.size() > (s_->blobMissing == 0 ? 0U : 1U);
    const auto draw = cullingDrawOf(opcode, arguments, mayHaveBlob ? &s_->blobs.front() : nullptr);
    uint64_t vertices = draw ? draw->count * draw->instances : words.count > 0 ? cullWord(arguments, words.count) : 0;
    if (vertices > kMaxCounted) vertices = 0; // GL refuses it
    WhyWhole why = whyUnexamined(opcode, draw);
    if (why == WhyWhole::None && c_->draw->drawn.contains(c_->draw->whole)) return false;
    const culling::Cut cut = why == WhyWhole::None ? cutOf(*draw, why) : culling::Cut::Whole;
    uint64_t kept = 0;
    for (const culling::VertexRange& range : culling_->ranges) kept += cut == culling::Cut::Ranges ? range.count : 0;
    if (cut == culling::Cut::Whole) kept = vertices;
    countCulling(cut, vertices, kept, why);
    if (cut != culling::Cut::Nothing) cullingOf(*c_).state.hasPendingPrimitives = false;
    if (cut == culling::Cut::Whole) return false;
    if (culling_->mode == CullingMode::Audit) auditDraw(*draw, cut);
    if (cut == culling::Cut::Ranges)
        issue(*draw, culling_->ranges);
    else
        separatePrimitives();
    bool found = false; // the blob of the record, which no command takes now
    if (!draw->indices.empty() && cullWord(arguments, words.indices) == record::kTagBlob) (void)blobs.takeBlob(found);
    return true;
}

} // namespace mural
