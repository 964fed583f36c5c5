// Driver events: debug messages of this node's driver, out of memory, and context loss.
#include <string>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/replay/engine/replay.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

namespace {
constexpr size_t kMaxMessages = 64; // between two packets; later ones are dropped
} // namespace

void Replay::listenToDriver() {
    if (c_->listens || c_ == none_.get() || !gl.glDebugMessageCallback) return;
    c_->listens = true;
    gl.glDebugMessageCallback(reinterpret_cast<void*>(&Replay::onDriverMessage), &c_->debug);
}

// Messages that the program has inserted itself are not reported to it.
void APIENTRY Replay::onDriverMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar* text, const void* inbox) {
    if (source == GL_DEBUG_SOURCE_APPLICATION || source == GL_DEBUG_SOURCE_THIRD_PARTY || !text) return;
    auto& box = *static_cast<replay::DebugInbox*>(const_cast<void*>(inbox));
    const std::lock_guard lock(box.mutex);
    if (box.messages.size() >= kMaxMessages) return;
    box.messages.push_back(
        {source, type, id, severity, length < 0 ? std::string(text) : std::string(text, static_cast<size_t>(length))});
    box.any.store(true, std::memory_order_release);
}

void Replay::sendDriverEvent(wire::DriverEventKind kind, const replay::DebugInbox::Message& m) {
    if (!out_.driverEvent) return;
    out_.driverEvent({c_->client, c_->id, static_cast<uint32_t>(kind), m.source, m.type, m.id, m.severity,
                      static_cast<uint32_t>(m.text.size())},
                     m.text);
}

void Replay::sendDriverMessages() {
    if (!c_ || !c_->debug.any.load(std::memory_order_acquire)) return;
    std::vector<replay::DebugInbox::Message> messages;
    {
        const std::lock_guard lock(c_->debug.mutex);
        messages.swap(c_->debug.messages);
        c_->debug.any.store(false, std::memory_order_relaxed);
    }
    for (const auto& message : messages) sendDriverEvent(wire::DriverEventKind::DebugMessage, message);
}

// Clears GL errors. The program's own context reports all errors except out of memory on this machine. Returns true if
// one of the errors was out of memory.
bool Replay::takeErrors() {
    constexpr int kMaxErrors = 8; // a lost context reports errors forever
    bool noMemory = false;
    for (int i = 0; i < kMaxErrors && gl.glGetError; ++i) {
        const GLenum error = gl.glGetError();
        if (error == GL_NO_ERROR) break;
        ++counts_.glErrors;
        noMemory = noMemory || error == GL_OUT_OF_MEMORY;
    }
    return noMemory;
}

// The program has received an error. It includes allocation failures before it, which are therefore not reported again.
bool Replay::errorReported() {
    if (bound_ == c_ && takeErrors())
        sendDriverEvent(wire::DriverEventKind::OutOfMemory, {0, c_->errorsReported, 0, 0, {}});
    ++c_->errorsReported;
    return true;
}

// Clears earlier errors first, which would hide an allocation failure.
bool Replay::executeAllocating(ReplayFunction function, Args& in) {
    (void)takeErrors();
    const bool ok = function(*this, in);
    if (takeErrors()) {
        sendDriverEvent(wire::DriverEventKind::OutOfMemory, {0, c_->errorsReported, 0, 0, {}});
        log::warning(log::Topic::Replay, "no memory for a GL object of the program; it receives GL_OUT_OF_MEMORY");
    }
    return ok;
}

// ---- debug labels, groups and messages of the program

namespace {
std::string textOf(const Data& d, GLsizei length) {
    const auto bytes = d.span();
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return length < 0 ? text.substr(0, text.find('\0')) : text.substr(0, static_cast<size_t>(length));
}

Kind kindOf(GLenum identifier) {
    switch (identifier) {
    case GL_BUFFER: return Kind::Buffer;
    case GL_SHADER:
    case GL_PROGRAM: return Kind::Program;
    case GL_VERTEX_ARRAY: return Kind::VertexArray;
    case GL_QUERY: return Kind::Query;
    case GL_PROGRAM_PIPELINE: return Kind::Pipeline;
    case GL_TRANSFORM_FEEDBACK: return Kind::TransformFeedback;
    case GL_SAMPLER: return Kind::Sampler;
    case GL_TEXTURE: return Kind::Texture;
    case GL_RENDERBUFFER: return Kind::Renderbuffer;
    case GL_FRAMEBUFFER: return Kind::Framebuffer;
    default: return Kind::Count; // display lists: several lists here form one of the program's
    }
}
} // namespace

void Replay::glObjectLabel(GLenum identifier, GLuint object, GLsizei length, const Data& label) {
    const Kind kind = kindOf(identifier);
    const GLuint nodeName = kind == Kind::Count ? 0 : table(kind).find(object);
    if (!nodeName || !gl.glObjectLabel) return;
    const std::string text = textOf(label, length);
    gl.glObjectLabel(identifier, nodeName, static_cast<GLsizei>(text.size()), label.absent() ? nullptr : text.c_str());
}
void Replay::glObjectPtrLabel(uint64_t ptr, GLsizei length, const Data& label) {
    if (!c_->shared || !gl.glObjectPtrLabel) return;
    const auto it = c_->shared->syncs.find(ptr);
    if (it == c_->shared->syncs.end() || !it->second) return;
    const std::string text = textOf(label, length);
    gl.glObjectPtrLabel(it->second, static_cast<GLsizei>(text.size()), label.absent() ? nullptr : text.c_str());
}
void Replay::glPushDebugGroup(GLenum source, GLuint id, GLsizei length, const Data& message) {
    const std::string text = textOf(message, length);
    if (gl.glPushDebugGroup) gl.glPushDebugGroup(source, id, static_cast<GLsizei>(text.size()), text.c_str());
}
// Message ids differ between processes.
void Replay::glDebugMessageControl(GLenum source, GLenum type, GLenum severity, GLsizei count, const Data&,
                                   GLboolean enabled) {
    if (count == 0 && gl.glDebugMessageControl) gl.glDebugMessageControl(source, type, severity, 0, nullptr, enabled);
}

// Reports, at the end of a frame, problems that only drawing reveals.
void Replay::reportDriverProblems() {
    if (!bound_) return;
    ContextState* const own = std::exchange(c_, bound_);
    if (takeErrors()) sendDriverEvent(wire::DriverEventKind::OutOfMemory, {0, c_->errorsReported, 0, 0, {}});
    // ES 1 has no reset status: Mesa raises an error there.
    if (!c_->lost && c_->api != wire::Api::Es1 && c_->context->reportsReset() && gl.glGetGraphicsResetStatus) {
        const bool planted = config_.plant == "reset" && config_.node == 1 && counts_.frames == 5;
        const GLenum status = planted ? GL_INNOCENT_CONTEXT_RESET : gl.glGetGraphicsResetStatus();
        c_->lost = status != GL_NO_ERROR;
        if (c_->lost) {
            sendDriverEvent(wire::DriverEventKind::ContextLost, {0, status, 0, 0, {}});
            log::warning(
                log::Topic::Replay,
                "the graphics driver lost a context (GPU reset): its drawings are missing on this node's tiles; "
                "restart the program");
        }
    }
    sendDriverMessages();
    c_ = own;
}

} // namespace mural
