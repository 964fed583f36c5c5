// Maps the program's object names to this node's. Small names use a vector, others a map.
#pragma once

#include <GL/gl.h>
#include <unordered_map>
#include <vector>

namespace mural {

class NameTable {
public:
    // 0: unknown name.
    [[nodiscard]] GLuint find(GLuint name) const {
        if (name < dense_.size()) return dense_[name];
        const auto it = sparse_.find(name);
        return it == sparse_.end() ? 0 : it->second;
    }
    void set(GLuint name, GLuint nodeName) {
        if (name < kDense) {
            if (name >= dense_.size()) dense_.resize(name + name / 2 + 64, 0);
            dense_[name] = nodeName;
        } else {
            sparse_[name] = nodeName;
        }
    }
    void erase(GLuint name) {
        if (name < dense_.size())
            dense_[name] = 0;
        else
            sparse_.erase(name);
    }

private:
    static constexpr GLuint kDense = 1u << 16;
    std::vector<GLuint> dense_;
    std::unordered_map<GLuint, GLuint> sparse_;
};

enum class Kind : uint8_t {
    Texture,
    Buffer,
    Renderbuffer,
    Sampler,
    Program,
    ArbProgram, // shared by contexts
    Framebuffer,
    VertexArray,
    Query,
    Pipeline,
    TransformFeedback, // per context
    Count
};
constexpr bool isShared(Kind k) { return k <= Kind::ArbProgram; }

} // namespace mural
