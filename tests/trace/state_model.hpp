// A small model of GL: the state that a stream leaves behind. Draws store a hash of everything that they may depend on
// in their target, so streams with equal results have drawn the same remaining content.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural::trace {

class StateModel {
public:
    void packet(std::span<const std::byte> payload) {
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) record(r);
    }
    // The complete state as text, for comparison.
    [[nodiscard]] std::string text() const {
        std::string s = state() + " colour " + std::to_string(window_);
        for (const auto& [name, t] : textures_)
            if (name < kGone)
                s += " texture " + std::to_string(name) + " " + std::to_string(t.content) + numbers(t.parameters);
        for (const auto& [name, b] : buffers_) s += " buffer " + std::to_string(name) + bytes(b);
        for (const auto& [name, result] : queries_)
            s += " query " + std::to_string(name) + " " + std::to_string(result);
        for (const auto& [name, texture] : framebuffers_) {
            const auto t = textures_.find(texture);
            s += " framebuffer " + std::to_string(name) + " " +
                 (t == textures_.end() ? "none" : std::to_string(t->second.content));
        }
        for (const auto& [name, list] : lists_)
            s += " list " + std::to_string(name) + " " + std::to_string(list.size());
        for (const auto& saved : attribs_) s += " saved" + numbers(saved.caps);
        return s;
    }

private:
    using Numbers = std::map<uint64_t, uint64_t>;
    struct Texture {
        uint64_t content = 0;
        Numbers parameters;
    };
    struct Attribs {
        uint32_t mask = 0;
        Numbers caps;
        std::map<uint32_t, uint32_t> bound;
        uint32_t unit = 0, mode = 0;
        uint64_t colour = 0, clearColor = 0;
    };

    static uint64_t mix(uint64_t a, uint64_t b) {
        a = (a ^ b) * 0x9e3779b97f4a7c15u;
        return a ^ a >> 29;
    }
    static uint64_t hash(const std::string& s) {
        uint64_t h = 1;
        for (const char c : s) h = mix(h, static_cast<unsigned char>(c));
        return h;
    }
    static std::string numbers(const Numbers& n) {
        std::string s;
        for (const auto& [k, v] : n) s += " " + std::to_string(k) + ":" + std::to_string(v);
        return s;
    }
    static std::string bytes(const std::vector<uint8_t>& b) {
        std::string s = " ";
        for (const uint8_t v : b) s += static_cast<char>('a' + v % 26);
        return s;
    }

    // The state of the context itself.
    [[nodiscard]] std::string state() const {
        std::string s = "unit " + std::to_string(unit_) + " mode " + std::to_string(mode_) + " program " +
                        std::to_string(program_) + " target " + std::to_string(framebuffer_) + " array " +
                        std::to_string(array_) + " colour " + std::to_string(colour_) + " caps" + numbers(caps_);
        for (const auto& [unit, t] : bound_) s += " bound " + std::to_string(unit) + " " + std::to_string(t);
        for (const auto& [mode, stack] : matrices_)
            for (const uint64_t m : stack) s += " matrix " + std::to_string(mode) + " " + std::to_string(m);
        for (const auto& [p, u] : uniforms_) s += " uniforms " + std::to_string(p) + numbers(u);
        return s;
    }
    void draw() {
        uint64_t h = hash(state());
        // Programs without sampler values use the first unit.
        for (const auto& [unit, name] : bound_)
            if (const auto t = textures_.find(name);
                t != textures_.end() && framebuffer_ == 0 && (program_ == 0 || unit == GL_TEXTURE0))
                h = mix(mix(h, t->second.content), hash(numbers(t->second.parameters)));
        for (const auto& [name, b] : buffers_) h = mix(h, hash(bytes(b)));
        uint64_t* const target = targetContent();
        if (target != nullptr) *target = mix(*target, h);
        if (query_ != 0) queries_[query_] = mix(queries_[query_], h);
    }
    uint64_t* targetContent() {
        if (framebuffer_ == 0) return &window_;
        const auto t = textures_.find(framebuffers_[framebuffer_]);
        return t == textures_.end() ? nullptr : &t->second.content;
    }
    std::vector<uint64_t>& stack() { return matrices_[mode_]; }
    void clear() {
        uint64_t* const target = targetContent();
        if (target != nullptr) *target = caps_[GL_SCISSOR_TEST] ? mix(*target, 77 + clearColor_) : 1000 + clearColor_;
    }
    void record(const wire::RecordView& r) {
        if (list_ != 0 && r.opcode != op::glEndList) {
            lists_[list_].push_back({r.opcode,
                                     {wire::argumentWord(r, 0), wire::argumentWord(r, 1), wire::argumentWord(r, 2),
                                      wire::argumentWord(r, 3)}});
            return;
        }
        call(r.opcode,
             {wire::argumentWord(r, 0), wire::argumentWord(r, 1), wire::argumentWord(r, 2), wire::argumentWord(r, 3),
              wire::argumentWord(r, 4), wire::argumentWord(r, 5), wire::argumentWord(r, 6)});
    }
    void call(uint16_t opcode, const std::array<uint32_t, 7>& a) {
        const auto boundTexture = [&]() -> Texture* {
            const auto t = textures_.find(bound_[unit_]);
            return t == textures_.end() ? nullptr : &t->second;
        };
        switch (opcode) {
        case op::glEnable: caps_[a[0]] = 1; return;
        case op::glDisable: caps_[a[0]] = 0; return;
        case op::glClearColor: clearColor_ = a[0]; return;
        case op::glActiveTexture: unit_ = a[0]; return;
        case op::glGenTextures: textures_[a[2]] = {}; return;
        case op::glDeleteTextures:
            ++gone_; // other references keep it
            textures_[kGone + gone_] = textures_[a[2]];
            textures_.erase(a[2]);
            for (auto& [unit, t] : bound_)
                if (t == a[2]) t = 0;
            for (auto& [name, texture] : framebuffers_)
                if (texture == a[2]) texture = name == framebuffer_ ? 0 : kGone + gone_;
            return;
        case op::glBindTexture: bound_[unit_] = a[1]; return;
        case op::glTexParameteri:
            if (Texture* t = boundTexture()) t->parameters[a[1]] = a[2];
            return;
        case op::glTexImage2D:
            if (Texture* t = boundTexture()) t->content = 5000 + a[3];
            return;
        case op::glGenBuffers: buffers_[a[2]] = {}; return;
        case op::glBindBuffer: array_ = a[1]; return;
        case op::glBufferData:
            if (array_ != 0) buffers_[array_].assign(a[1], static_cast<uint8_t>(a[4]));
            return;
        case op::glBufferSubData:
            for (uint32_t i = 0; array_ != 0 && i < a[3] && a[1] + i < buffers_[array_].size(); ++i)
                buffers_[array_][a[1] + i] = static_cast<uint8_t>(a[5] >> 2);
            return;
        case op::glCreateProgram: uniforms_[a[0]]; return;
        case op::glUseProgram: program_ = a[0]; return;
        case op::glUniform1f:
            if (program_ != 0) uniforms_[program_][a[0]] = a[1];
            return;
        case op::glMatrixMode: mode_ = a[0]; return;
        case op::glLoadIdentity: stack().back() = 0; return;
        case op::glTranslatef: stack().back() = mix(stack().back(), a[0] + 3); return;
        case op::glPushMatrix: stack().push_back(stack().back()); return;
        case op::glPopMatrix:
            if (stack().size() > 1) stack().pop_back();
            return;
        case op::glPushAttrib: attribs_.push_back({a[0], caps_, bound_, unit_, mode_, colour_, clearColor_}); return;
        case op::glPopAttrib: {
            if (attribs_.empty()) return;
            const Attribs saved = attribs_.back();
            attribs_.pop_back();
            if (saved.mask & GL_ENABLE_BIT) caps_ = saved.caps;
            if (saved.mask & GL_TEXTURE_BIT) bound_ = saved.bound, unit_ = saved.unit;
            if (saved.mask & GL_TRANSFORM_BIT) mode_ = saved.mode;
            if (saved.mask & GL_CURRENT_BIT) colour_ = saved.colour;
            if (saved.mask & GL_COLOR_BUFFER_BIT) clearColor_ = saved.clearColor;
            return;
        }
        case op::glColor3f: colour_ = a[0]; return;
        case op::glBegin:
        case op::glVertex2f:
        case op::glDrawArrays: return draw();
        case op::glClear: return clear();
        case op::glGenFramebuffers: framebuffers_[a[2]] = 0; return;
        case op::glBindFramebuffer: framebuffer_ = a[1]; return;
        case op::glFramebufferTexture2D: framebuffers_[framebuffer_] = a[3]; return;
        case op::glGenQueries: queries_[a[2]] = 0; return;
        case op::glBeginQuery:
            query_ = a[1];
            queries_[query_] = 0;
            return;
        case op::glEndQuery: query_ = 0; return;
        case op::glNewList:
            list_ = a[0];
            lists_[list_].clear();
            return;
        case op::glEndList: list_ = 0; return;
        case op::glCallList:
            if (const auto list = lists_.find(a[0]); list != lists_.end())
                for (const auto& [listed, words] : list->second) call(listed, {words[0], words[1], words[2], words[3]});
            return;
        default: return;
        }
    }

    static constexpr uint32_t kGone = 1000; // stands for deleted textures
    uint32_t gone_ = 0;
    uint32_t unit_ = GL_TEXTURE0, mode_ = GL_MODELVIEW, program_ = 0, framebuffer_ = 0, array_ = 0, query_ = 0,
             list_ = 0;
    uint64_t colour_ = 0, window_ = 0, clearColor_ = 0;
    Numbers caps_{{GL_BLEND, 0}, {GL_CULL_FACE, 0}, {GL_FOG, 0}, {GL_SCISSOR_TEST, 0}};
    std::map<uint32_t, uint32_t> bound_{{GL_TEXTURE0, 0}, {GL_TEXTURE1, 0}};
    std::map<uint32_t, Texture> textures_;
    std::map<uint32_t, std::vector<uint8_t>> buffers_;
    std::map<uint32_t, Numbers> uniforms_;
    std::map<uint32_t, std::vector<uint64_t>> matrices_{{GL_MODELVIEW, {0}}, {GL_PROJECTION, {0}}};
    std::map<uint32_t, uint32_t> framebuffers_; // attached textures
    std::map<uint32_t, uint64_t> queries_;
    std::map<uint32_t, std::vector<std::pair<uint16_t, std::array<uint32_t, 4>>>> lists_;
    std::vector<Attribs> attribs_;
};

} // namespace mural::trace
