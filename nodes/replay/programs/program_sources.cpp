#include "nodes/replay/programs/program_sources.hpp"

#include <cstring>

#include "nodes/replay/programs/attached_shaders.hpp"

namespace mural {

namespace {

constexpr uint32_t kMaxEntries = 4096; // of one kind in a recipe

void put(std::vector<std::byte>& out, uint32_t value) {
    const auto* p = reinterpret_cast<const std::byte*>(&value);
    out.insert(out.end(), p, p + sizeof value);
}
void put(std::vector<std::byte>& out, const std::string& text) {
    put(out, static_cast<uint32_t>(text.size()));
    const auto* p = reinterpret_cast<const std::byte*>(text.data());
    out.insert(out.end(), p, p + text.size());
}

// Inverse of put(). After a read past the end all further values are empty.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
    [[nodiscard]] bool done() const { return ok_ && left_.empty(); }
    [[nodiscard]] bool ok() const { return ok_; }
    uint32_t number() {
        uint32_t value = 0;
        if (const std::byte* p = take(sizeof value)) std::memcpy(&value, p, sizeof value);
        return value;
    }
    uint32_t count() {
        const uint32_t n = number();
        ok_ = ok_ && n <= kMaxEntries;
        return ok_ ? n : 0;
    }
    std::string text() {
        const uint32_t length = number();
        const std::byte* p = take(length);
        return p ? std::string(reinterpret_cast<const char*>(p), length) : std::string();
    }

private:
    const std::byte* take(size_t bytes) {
        ok_ = ok_ && bytes <= left_.size();
        if (!ok_) return nullptr;
        const std::byte* p = left_.data();
        left_ = left_.subspan(bytes);
        return p;
    }
    std::span<const std::byte> left_;
    bool ok_ = true;
};

} // namespace

std::vector<std::byte> ProgramSources::toBytes() const {
    std::vector<std::byte> out;
    put(out, uint32_t{separable});
    put(out, static_cast<uint32_t>(shaders.size()));
    for (const Shader& s : shaders) {
        put(out, s.type);
        put(out, s.text);
    }
    put(out, static_cast<uint32_t>(outputs.size()));
    for (const auto& [name, output] : outputs) {
        put(out, name);
        put(out, output.color);
        put(out, output.index);
    }
    put(out, varyingMode);
    put(out, static_cast<uint32_t>(varyings.size()));
    for (const std::string& name : varyings) put(out, name);
    return out;
}

std::optional<ProgramSources> ProgramSources::fromBytes(std::span<const std::byte> bytes) {
    Reader in(bytes);
    ProgramSources r;
    r.separable = in.number() != 0;
    for (uint32_t n = in.count(); n > 0 && in.ok(); --n) {
        Shader& s = r.shaders.emplace_back();
        s.type = in.number();
        s.text = in.text();
    }
    for (uint32_t n = in.count(); n > 0 && in.ok(); --n) {
        const std::string name = in.text();
        Output& o = r.outputs[name];
        o.color = in.number();
        o.index = in.number();
    }
    r.varyingMode = in.number();
    for (uint32_t n = in.count(); n > 0 && in.ok(); --n) r.varyings.push_back(in.text());
    if (!in.done() || r.shaders.empty()) return std::nullopt;
    return r;
}

void ProgramSourcesStore::compiled(const GlFunctions& gl, GLuint shader, bool withIncludes) {
    GLint type = 0;
    gl.glGetShaderiv(shader, GL_SHADER_TYPE, &type);
    Shader& s = shaders_[shader];
    s.type = static_cast<GLenum>(type);
    s.compiled = s.given;
    s.withIncludes = withIncludes || s.given.find("#include") != std::string::npos;
}

void ProgramSourcesStore::varyings(GLuint program, GLenum mode, std::vector<std::string> names) {
    ProgramSources& next = programs_[program].next;
    next.varyingMode = mode;
    next.varyings = std::move(names);
}

void ProgramSourcesStore::linked(const GlFunctions& gl, GLuint program) {
    Program& p = programs_[program];
    p.last.reset();
    GLint status = 0;
    gl.glGetProgramiv(program, GL_LINK_STATUS, &status);
    if (!status) return;
    ProgramSources recipe = p.next;
    for (const GLuint shader : attachedShaders(gl, program)) {
        const auto it = shaders_.find(shader);
        if (it == shaders_.end() || it->second.withIncludes) return;
        recipe.shaders.push_back({it->second.type, it->second.compiled});
    }
    if (!recipe.shaders.empty()) p.last = std::move(recipe);
}

void ProgramSourcesStore::linkedFrom(GLuint program, ProgramSources recipe) {
    Program& p = programs_[program];
    p.next.separable = recipe.separable;
    p.last = std::move(recipe);
}

void ProgramSourcesStore::deleted(const GlFunctions& gl, GLuint shaderOrProgram) {
    ending_.insert(shaderOrProgram);
    std::erase_if(ending_, [&](GLuint name) {
        if (gl.glIsShader(name) || gl.glIsProgram(name)) return false; // attached, or in use
        shaders_.erase(name);
        programs_.erase(name);
        return true;
    });
}

std::vector<std::byte> ProgramSourcesStore::of(GLuint program) const {
    const auto it = programs_.find(program);
    return it == programs_.end() || !it->second.last ? std::vector<std::byte>{} : it->second.last->toBytes();
}

} // namespace mural
