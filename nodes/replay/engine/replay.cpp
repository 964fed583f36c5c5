#include "nodes/replay/engine/replay.hpp"

#include <cstring>
#include <string_view>

#include "common/log/log.hpp"
#include "gl_opcodes.hpp"
#include "streamcodec/command_traits.hpp"
#include "streamcodec/opcode_names.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {

Replay::Replay(std::unique_ptr<gl::Platform> platform, PlayerConfig config, PlayerOutputs outputs)
    : platform_(std::move(platform)),
      config_(std::move(config)),
      out_(std::move(outputs)),
      lackingReported_(op::kLimit, false) {
    share_ = config_.pass.share;
    knowsTurns_ = knowsCosts_ = knowsAreas_ = !config_.isResyncing;
    if (config_.areas) areas_ = std::make_shared<const ViewportAssignment>(*config_.areas);
    hasSkipped_ = skips_ = maySkip();
    if (config_.culling != CullingMode::Off && !config_.lean)
        culling_ = std::make_unique<replay::Culling>(config_.culling, config_.plant);
    counts_.culling.isOn = culling_ != nullptr;
}

Replay::~Replay() {
    // Frees contexts before the surfaces that they may be current with.
    (void)platform_->makeCurrent(nullptr, nullptr, nullptr);
    for (auto& [id, client] : clients_) client.contexts.clear();
}

bool Replay::packet(uint32_t stream, std::span<const std::byte> payload) {
    if (!makeStreamCurrent(stream)) return true; // logged once; the other streams continue
    counts_.bytes += payload.size();
    size_t at = 0;
    while (at < payload.size()) {
        const record::Header header = record::readHeader(payload.data() + at, payload.size() - at);
        if (!header || !record(payload.subspan(at, header.sizeBytes))) return false;
        at += header.sizeBytes;
    }
    sendDriverMessages();
    return true;
}

bool Replay::record(std::span<const std::byte> bytes) {
    uint32_t header = 0;
    std::memcpy(&header, bytes.data(), 4);
    const auto opcode = static_cast<uint16_t>(header & 0xffff);
    const auto arguments = bytes.subspan(record::headerBytesOf(header));
    ++counts_.commands;
    bool ok = true;
    if (c_->compiling && culling_) onListed(opcode, arguments);
    if (c_->compiling) onPrimitive(opcode, arguments);
    if (c_->compiling && splitsLists(opcode, arguments)) {
        ok = compileSplitting(opcode, bytes, arguments);
    } else {
        if (takesRanges() && c_->compiling) onCompiled(opcode, arguments);
        ok = execute(opcode, arguments, *this);
    }
    taken_.clear();
    scratchUsed_ = 0;
    if (!ok) {
        ++counts_.malformed;
        const char* text = opcode >= wire::kFirstGlOpcode ? glOpcodeName(opcode) : nullptr;
        log::warning(log::Topic::Replay, "malformed record: opcode " + std::to_string(opcode) +
                                             (text ? std::string(" (") + text + ")" : "") + ", " +
                                             std::to_string(bytes.size()) + " bytes");
    }
    return ok;
}

bool Replay::execute(uint16_t opcode, std::span<const std::byte> arguments, BlobQueue& blobs) {
    Args in(arguments, blobs);
    const bool drawing =
        opcode == wire::kOpRequestPixels || opcode == wire::kOpFillWindow || opcode == wire::kOpDrawAll;
    // A read is never part of a list. A native list cannot be ended between glBegin and glEnd, because that would split
    // the primitive.
    const bool readsInPrimitive = opcode == wire::kOpRequestPixels && c_->compilesPrimitive;
    if (drawing && c_->compiling && !readsInPrimitive) {
        bool ok = true;
        nextNativeList([&] { ok = own(opcode, in); });
        return ok;
    }
    if (takesRanges() && (opcode == wire::kOpRequestPixels || opcode == wire::kOpFillWindow)) composeBound();
    if (opcode < wire::kFirstGlOpcode) {
        if (culling_) onCullingRecord(opcode, arguments);
        return own(opcode, in);
    }
    const ReplayFunction function = replayFunction(opcode);
    if (!function) return false;
    if (c_ == none_.get()) return true; // GL without a context does nothing
    if (!config_.plant.empty() && planted(opcode)) return true;
    onBitmaps(opcode);
    if (takesTurns()) onTurn(opcode, arguments);
    if (hasSkipped_) onSkipped(opcode, arguments);
    if (movesView() || config_.pass.samples > 1) onEye(opcode, arguments);
    if (tracksCopies()) onWholeWindow(opcode, arguments);
    if (takesRanges()) in = Args(onRange(opcode, arguments), blobs); // reduced to this node's piece, or empty
    // after onRange(), which decides whether this node draws the command
    const bool skips = (takesTurns() || (hasSkipped_ && c_->draw && c_->draw->skipped)) && shouldSkipDraw(opcode);
    if (moves()) onArea(opcode, arguments);
    if (culling_ && bound_) {
        onCulling(opcode, arguments);
        if (!skips && !c_->compiling && hasTrait(opcode, Trait::SkippableDraw) && cullDraw(opcode, arguments, blobs))
            return true;
    }
    if (skips) swapDrawEntryPoints();
    const bool done = hasTrait(opcode, Trait::Allocates) ? executeAllocating(function, in) : function(*this, in);
    if (skips) swapDrawEntryPoints();
    if (movesView()) onEyeAfter(opcode);
    return done;
}

#ifdef __SANITIZE_ADDRESS__
namespace {
// Reads the first byte after a block of memory, which the sanitizer build must report.
void readPastEnd(size_t sizeBytes) {
    const std::vector<char> block(sizeBytes);
    [[maybe_unused]] const char beyond = *static_cast<const volatile char*>(block.data() + sizeBytes);
}
} // namespace
#endif

// Makes faults visible (MURAL_PLANT=names): this node's names differ from the program's. Otherwise they are often
// equal, because drivers number objects alike. Called once per context.
void Replay::offsetObjectNames() {
    constexpr GLsizei kNames = 40;
    GLuint names[kNames];
    for (const auto generate : {gl.glGenTextures, gl.glGenBuffers, gl.glGenRenderbuffers, gl.glGenSamplers,
                                gl.glGenFramebuffers, gl.glGenVertexArrays, gl.glGenQueries, gl.glGenProgramPipelines,
                                gl.glGenTransformFeedbacks, gl.glGenProgramsARB})
        if (generate) generate(kNames, names);
    for (GLsizei i = 0; i < kNames && gl.glCreateProgram; ++i) gl.glCreateProgram();
    while (gl.glGetError() != GL_NO_ERROR) {} // some contexts lack some of these objects
}

// Plants a fault (MURAL_PLANT), which tests must detect. Returns true if the command must be skipped.
bool Replay::planted(uint16_t opcode) {
    const bool draws = hasTrait(opcode, Trait::Begin, Trait::Draw, Trait::CallList);
#ifdef __SANITIZE_ADDRESS__
    if (config_.plant == "overflow") readPastEnd(counts_.frames + 8);
#endif
    if (config_.plant == "leak") return opcode == op::glDeleteTextures;
    if (config_.plant == "drop") return draws && counts_.frames == 1;
    if (config_.plant != "opcode" || !draws || counts_.frames == 0) return false;
    if (gl.glDepthFunc) gl.glDepthFunc(GL_NEVER); // as if the program had passed another argument
    if (gl.glEnable) gl.glEnable(GL_DEPTH_TEST);
    return false;
}

bool Replay::makeStreamCurrent(uint32_t stream) {
    if (!none_) none_ = std::make_unique<ContextState>();
    Stream& s = clients_[wire::clientOf(stream)].streams[stream];
    stream_ = stream;
    s_ = &s;
    return bindStream(s);
}

bool Replay::bindStream(Stream& s) {
    c_ = s.context ? s.context : none_.get();
    if (!s.context) return true;
    if (bound_ == s.context && boundDraw_ == s.draw && boundRead_ == s.read) return true;
    if (takesRanges()) composeBound(); // while its window is bound
    bound_ = s.context;
    boundDraw_ = s.draw;
    boundRead_ = s.read;
    s.context->draw = s.draw;
    s.context->read = s.read;
    if (s.draw) s.draw->drawer = s.context;
    // The context belongs to another thread of the program. It stays current there, as the previous context stays
    // current in its own thread.
    if (!bindSurfaces(gl::PendingCommands::Pending)) {
        c_ = none_.get();
        return true;
    }
    restoreWindowState();
    return true;
}

void Replay::loadFunctions() {
    if (loaded_) return;
    loaded_ = true;
    loadGlFunctions(
        gl, [](void* self, const char* text) { return static_cast<gl::Platform*>(self)->getProcAddress(text); },
        platform_.get());
}

void Replay::clientGone(uint32_t client) {
    const auto it = clients_.find(client);
    if (it == clients_.end()) return;
    for (auto& [id, context] : it->second.contexts) {
        if (bound_ != context.get()) continue;
        (void)platform_->makeCurrent(nullptr, nullptr, nullptr);
        bound_ = nullptr;
    }
    boundDraw_ = boundRead_ = nullptr;
    s_ = nullptr;
    c_ = none_.get();
    it->second.contexts.clear();
    clients_.erase(it);
}

std::span<const std::byte> Replay::takeBlob(bool& found) {
    found = s_ && !s_->blobs.empty() && (s_->blobs.size() > 1 || s_->blobMissing == 0);
    if (!found) return {};
    s_->blobBytes -= s_->blobs.front().size();
    taken_.push_back(std::move(s_->blobs.front()));
    s_->blobs.pop_front();
    return taken_.back();
}

NameTable& Replay::table(Kind kind) {
    return isShared(kind) && c_->shared ? c_->shared->tables[static_cast<int>(kind)] : c_->own[static_cast<int>(kind)];
}

// Compatibility contexts let programs bind names that no glGen… call created.
GLuint Replay::generate(Kind kind) {
    GLuint made = 0;
    const auto call = [&](void (*function)(GLsizei, GLuint*)) {
        if (function) function(1, &made);
    };
    switch (kind) {
    case Kind::Texture: call(gl.glGenTextures); break;
    case Kind::Buffer: call(gl.glGenBuffers); break;
    case Kind::Renderbuffer: call(gl.glGenRenderbuffers); break;
    case Kind::Framebuffer: call(gl.glGenFramebuffers); break;
    case Kind::VertexArray: call(gl.glGenVertexArrays); break;
    case Kind::Query: call(gl.glGenQueries); break;
    case Kind::Sampler: call(gl.glGenSamplers); break;
    case Kind::ArbProgram: call(gl.glGenProgramsARB); break;
    case Kind::Pipeline: call(gl.glGenProgramPipelines); break;
    case Kind::TransformFeedback: call(gl.glGenTransformFeedbacks); break;
    default: break;
    }
    return made;
}

namespace {
constexpr GLuint kNoObject = UINT32_MAX; // a name that no GL object has
} // namespace

GLuint Replay::name(Kind kind, GLuint app) {
    if (app == 0) return 0;
    GLuint nodeName = table(kind).find(app);
    if (nodeName) return nodeName;
    if (kind == Kind::Framebuffer && c_->shared) nodeName = c_->shared->framebuffersOfAll.find(app); // Mesa shares them
    if (nodeName) return nodeName;
    if (c_->core) return kNoObject; // only created names are valid
    nodeName = generate(kind);
    if (!nodeName) return app; // if GL rejects the name here, it rejects the program's name as well
    bindName(kind, app, nodeName);
    return nodeName;
}

const GLuint* Replay::names(Kind kind, const GLuint* app, int64_t count) {
    if (!app || count <= 0) return app;
    if (scratchUsed_ == scratch_.size()) scratch_.emplace_back();
    std::vector<GLuint>& out = scratch_[scratchUsed_++];
    out.resize(static_cast<size_t>(count));
    for (size_t i = 0; i < out.size(); ++i) {
        GLuint value = 0;
        std::memcpy(&value, app + i, sizeof value);
        out[i] = name(kind, value);
    }
    return out.data();
}

void Replay::make(Kind kind, int64_t count, const GLuint* app, const std::function<void(GLuint*)>& call) {
    if (count <= 0 || !app) return;
    std::vector<GLuint> made(static_cast<size_t>(count), 0);
    call(made.data());
    for (size_t i = 0; i < made.size(); ++i) {
        GLuint value = 0;
        std::memcpy(&value, app + i, sizeof value);
        bindName(kind, value, made[i]);
    }
}

void Replay::bindName(Kind kind, GLuint app, GLuint nodeName) {
    if (app == 0) return;
    table(kind).set(app, nodeName);
    if (kind == Kind::Framebuffer && c_->shared) c_->shared->framebuffersOfAll.set(app, nodeName);
    if (kind == Kind::Program && c_->shared) c_->shared->programs.erase(app);
}

void Replay::forget(Kind kind, const GLuint* app, int64_t count) {
    for (int64_t i = 0; app && i < count; ++i) {
        GLuint value = 0;
        std::memcpy(&value, app + i, sizeof value);
        if (kind == Kind::Texture || kind == Kind::Sampler) handlesGone(kind, table(kind).find(value));
        table(kind).erase(value);
        if (kind == Kind::Framebuffer && c_->shared) c_->shared->framebuffersOfAll.erase(value);
    }
}

GLint Replay::uniformLocation(GLuint program, GLint location) {
    if (!c_->shared || location < 0) return location;
    const auto it = c_->shared->programs.find(program);
    if (it == c_->shared->programs.end()) return location;
    const auto to = it->second.locations.find(location);
    return to == it->second.locations.end() ? location : to->second;
}

GLint Replay::uniformLocation(GLint location) { return uniformLocation(c_->program, location); }

bool Replay::lacking(uint16_t opcode) {
    ++counts_.lacking;
    if (!lackingReported_[opcode]) {
        lackingReported_[opcode] = true;
        const char* text = glOpcodeName(opcode);
        log::warning(log::Topic::Replay, std::string("this node's driver has no ") + (text ? text : "such command") +
                                             "; its effect is missing on this node's tiles");
    }
    return true;
}

} // namespace mural
