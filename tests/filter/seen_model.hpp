// A small model of GL: the state that each draw, copy and query of a stream sees. Two streams are equivalent if they
// see the same in the same order.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>
#include <array>
#include <cstring>
#include <deque>
#include <map>
#include <vector>

#include "gl_opcodes.hpp"
#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {

class SeenModel {
public:
    void packet(uint32_t stream, std::span<const std::byte> payload) {
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) record(stream, r);
        sizeBytes_ += payload.size();
    }
    [[nodiscard]] const std::vector<uint64_t>& seen() const { return seen_; }
    [[nodiscard]] size_t sizeBytes() const { return sizeBytes_; }
    [[nodiscard]] size_t uploads() const { return uploads_; }
    // A hash of the complete state.
    uint64_t all() {
        uint64_t h = 1;
        for (const auto& [name, levels] : textures_) h = mix(mix(h, name), content(levels));
        for (const auto& [name, bytes] : buffers_) h = mix(mix(h, name), bytes.empty() ? 0 : hash(bytes));
        for (const auto& [id, value] : uniforms_) h = mix(mix(mix(h, id.first), id.second), value);
        for (const auto& [id, c] : contexts_) h = mix(h, bindings(c));
        return h;
    }

private:
    using Bytes = std::vector<std::byte>;
    static constexpr uint32_t kColumns = 24;             // of an image
    static constexpr uint32_t kSampler = 6, kUnits = 16; // location of a sampler uniform, and the number of units
    using Levels = std::map<uint32_t, uint64_t>;         // content, by level and column; parameters above
    struct Array {
        std::map<uint32_t, uint32_t> pointers;
        uint32_t indices = 0;
    };
    struct Context {
        uint32_t unit = 0, arrayBuffer = 0, unpackBuffer = 0, program = 0, array = 0, framebuffer = 0;
        std::map<uint32_t, uint32_t> textures; // by unit
        std::map<uint32_t, Array> arrays;
        std::map<uint32_t, uint32_t> attached;
        std::map<uint32_t, std::array<uint32_t, 4>> state; // by kind of state
        std::map<uint32_t, uint32_t> matrices;             // by mode
        struct Saved {
            uint32_t mask, unit;
            std::map<uint32_t, uint32_t> textures;
            std::map<uint32_t, std::array<uint32_t, 4>> state;
        };
        std::vector<Saved> saved;
        bool inPrimitive = false;
        uint32_t list = 0;
        uint64_t window = 0;
    };
    struct Stream {
        uint32_t context = 0;
        std::deque<Bytes> blobs;
    };

    static uint64_t mix(uint64_t a, uint64_t b) {
        a = (a ^ b) * 0x9e3779b97f4a7c15u;
        return a ^ a >> 29;
    }
    static uint64_t hash(std::span<const std::byte> bytes) {
        uint64_t h = bytes.size();
        for (const std::byte b : bytes) h = mix(h, static_cast<uint64_t>(b) + 1);
        return h;
    }
    static uint64_t content(const Levels& levels) {
        uint64_t h = 7;
        for (const auto& [level, value] : levels) h = mix(mix(h, level), value);
        return h;
    }
    static uint64_t bindings(const Context& c) {
        uint64_t h = mix(c.unit, c.arrayBuffer);
        for (const uint32_t v : {c.unpackBuffer, c.program, c.array, c.framebuffer}) h = mix(h, v);
        for (const auto& [unit, name] : c.textures)
            if (name != 0) h = mix(mix(h, unit), name);
        for (const auto& [key, value] : c.state)
            for (const uint32_t word : value) h = mix(mix(h, key), word);
        for (const auto& [mode, value] : c.matrices) h = mix(mix(h, mode), value);
        for (const auto& [name, array] : c.arrays) {
            h = mix(mix(h, name), array.indices);
            for (const auto& [index, buffer] : array.pointers) h = mix(mix(h, index), buffer);
        }
        return h;
    }
    uint64_t sees(Context& c) {
        uint64_t h = mix(bindings(c), c.window);
        for (const auto& [unit, name] : c.textures)
            if (name != 0) h = mix(h, content(textures_[name]));
        const Array& array = c.arrays[c.array];
        for (const auto& [index, buffer] : array.pointers)
            if (buffer != 0) h = mix(h, hash(buffers_[buffer]));
        if (array.indices != 0) h = mix(h, hash(buffers_[array.indices]));
        for (const auto& [id, value] : uniforms_)
            if (id.first == c.program) h = mix(mix(h, id.second), value);
        return h;
    }
    void draw(Context& c) {
        const uint64_t h = sees(c);
        seen_.push_back(h);
        if (c.framebuffer == 0)
            c.window = h;
        else if (const uint32_t name = c.attached[c.framebuffer])
            textures_[name][0] = h;
    }
    // The value of the record and its blob.
    Bytes valueOf(Stream& s, const wire::RecordView& r, size_t word) {
        const uint32_t tag = wire::argumentWord(r, word);
        if (tag == record::kTagBlob) {
            if (s.blobs.empty()) return {};
            Bytes value = std::move(s.blobs.front());
            s.blobs.pop_front();
            return value;
        }
        if (tag > record::kInlineBytes) return {};
        const auto bytes = r.arguments.subspan((word + 1) * 4, tag);
        return {bytes.begin(), bytes.end()};
    }
    uint32_t* boundBuffer(Context& c, uint32_t target) {
        if (target == GL_ARRAY_BUFFER) return &c.arrayBuffer;
        if (target == GL_PIXEL_UNPACK_BUFFER) return &c.unpackBuffer;
        return &c.arrays[c.array].indices;
    }
    void write(uint32_t name, uint64_t offset, const Bytes& value) {
        Bytes& bytes = buffers_[name];
        if (name == 0 || offset + value.size() > bytes.size()) return; // an error
        std::copy(value.begin(), value.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
    }

    void record(uint32_t stream, const wire::RecordView& r) {
        Stream& s = streams_[stream];
        const auto arg = [&](size_t word) { return wire::argumentWord(r, word); };
        switch (r.opcode) {
        case wire::kOpBlobBegin: s.blobs.emplace_back(); return;
        case wire::kOpBlobData:
            s.blobs.back().insert(s.blobs.back().end(), r.arguments.begin() + 4, r.arguments.begin() + 4 + arg(0));
            return;
        case wire::kOpCreateContext: contexts_[arg(0)]; return;
        case wire::kOpMakeCurrent: s.context = arg(0); return;
        default: break;
        }
        if (s.context == 0) return;
        Context& c = contexts_[s.context];
        if (c.list != 0 && r.opcode != op::glEndList) {
            const auto* const begin = reinterpret_cast<const uint32_t*>(r.arguments.data());
            std::vector<uint32_t> words(begin, begin + r.arguments.size() / 4);
            lists_[c.list].push_back({r.opcode, words});
            return;
        }
        if (c.inPrimitive && r.opcode != op::glEnd && r.opcode != op::glCallList) return;
        execute(c, s, r);
    }
    void execute(Context& c, Stream& s, const wire::RecordView& r) {
        const auto arg = [&](size_t word) { return wire::argumentWord(r, word); };
        uint32_t& texture = c.textures[c.unit];
        switch (r.opcode) {
        case op::glActiveTexture: c.unit = arg(0) - GL_TEXTURE0; return;
        case op::glBindTexture: texture = arg(1); return;
        case op::glTexImage2D:
        case op::glTexSubImage2D: {
            const bool whole = r.opcode == op::glTexImage2D;
            const Bytes value = valueOf(s, r, 8);
            ++uploads_;
            const uint64_t h = mix(mix(hash(value), c.unpackBuffer), arg(4));
            const uint32_t begin = whole ? 0 : arg(2), end = whole ? kColumns : begin + arg(4);
            for (uint32_t x = begin; x < end; ++x) textures_[texture][arg(1) * kColumns + x] = mix(h, x - begin);
            return;
        }
        case op::glCopyTexSubImage2D:
            textures_[texture][arg(1) * kColumns] = mix(textures_[texture][arg(1) * kColumns], c.window);
            return;
        case op::glGenerateMipmap:
            for (uint32_t x = 0; x < kColumns; ++x) textures_[texture][kColumns + x] = mix(textures_[texture][x], 99);
            return;
        case op::glTexParameteri: textures_[texture][1000 + arg(1)] = arg(2); return;
        case op::glDeleteTextures:
            for (auto& [unit, name] : c.textures)
                if (name == arg(2)) name = 0;
            textures_.erase(arg(2));
            for (auto& [id, other] : contexts_) // draws then go to an object without a name
                for (auto& [framebuffer, name] : other.attached)
                    if (name == arg(2)) name = 0;
            return;
        case op::glBindBuffer: *boundBuffer(c, arg(0)) = arg(1); return;
        case op::glBufferData: {
            Bytes value = valueOf(s, r, 3);
            ++uploads_;
            value.resize(arg(1));
            buffers_[*boundBuffer(c, arg(0))] = value;
            return;
        }
        case op::glBufferSubData: ++uploads_; return write(*boundBuffer(c, arg(0)), arg(1), valueOf(s, r, 5));
        case wire::kOpBufferBytes: ++uploads_; return write(arg(0), arg(1), valueOf(s, r, 3));
        case op::glDeleteBuffers:
            if (c.arrayBuffer == arg(2)) c.arrayBuffer = 0;
            if (c.unpackBuffer == arg(2)) c.unpackBuffer = 0;
            for (auto& [index, buffer] : c.arrays[c.array].pointers)
                if (buffer == arg(2)) buffer = 0;
            if (c.arrays[c.array].indices == arg(2)) c.arrays[c.array].indices = 0;
            // Unbound vertex arrays keep it without its name.
            ++ghosts_;
            for (auto& [name, array] : c.arrays) {
                if (array.indices == arg(2)) array.indices = ghosts_, buffers_[ghosts_] = buffers_[arg(2)];
                for (auto& [index, buffer] : array.pointers)
                    if (buffer == arg(2)) buffer = ghosts_, buffers_[ghosts_] = buffers_[arg(2)];
            }
            buffers_.erase(arg(2));
            return;
        case op::glBindVertexArray: c.array = arg(0); return;
        case op::glVertexAttribPointer: c.arrays[c.array].pointers[arg(0)] = c.arrayBuffer; return;
        case op::glUseProgram: c.program = arg(0); return;
        case op::glUniformMatrix4fv: uniforms_[{c.program, arg(0)}] = hash(valueOf(s, r, 3)); return;
        case op::glUniform1f:
            if (arg(0) != kSampler) uniforms_[{c.program, arg(0)}] = mix(1, arg(1));
            return;
        case op::glUniform1i:
            if (arg(0) == kSampler && arg(1) < kUnits) uniforms_[{c.program, arg(0)}] = mix(2, arg(1));
            return;
        case op::glUniform1fv: {
            const Bytes value = valueOf(s, r, 2);
            for (uint32_t i = 0; i < arg(1) && i * 4 + 4 <= value.size(); ++i) {
                uint32_t word = 0;
                std::memcpy(&word, value.data() + i * size_t{4}, 4);
                uniforms_[{c.program, arg(0) + i}] = mix(1, word);
            }
            return;
        }
        case op::glProgramUniform1f: uniforms_[{arg(0), arg(1)}] = mix(1, arg(2)); return;
        case op::glEnable:
        case op::glDisable: c.state[arg(0) == GL_TEXTURE_2D ? arg(0) + 0x10000 * c.unit : arg(0)] = {r.opcode}; return;
        case op::glDepthFunc:
            if (arg(0) >= GL_NEVER && arg(0) <= GL_ALWAYS) c.state[1] = {arg(0)};
            return;
        case op::glStencilFunc: c.state[2] = c.state[3] = {arg(0), arg(1), arg(2)}; return;
        case op::glStencilFuncSeparate: c.state[arg(0) == GL_FRONT ? 2 : 3] = {arg(1), arg(2), arg(3)}; return;
        case op::glViewport: c.state[4] = {arg(0), arg(1), arg(2), arg(3)}; return;
        case op::glClearColor: c.state[5] = {arg(0), arg(1), arg(2), arg(3)}; return;
        case op::glMatrixMode: c.state[6] = {arg(0)}; return;
        case op::glLoadMatrixf: c.matrices[c.state[6][0]] = arg(0); return;
        case op::glClear: c.window = mix(c.window, bindings(c)); return;
        case op::glBindFramebuffer: c.framebuffer = arg(1); return;
        case op::glFramebufferTexture2D: c.attached[c.framebuffer] = arg(3); return;
        case op::glPushAttrib: c.saved.push_back({arg(0), c.unit, c.textures, c.state}); return;
        case op::glPopAttrib: {
            if (c.saved.empty()) return;
            const auto saved = std::move(c.saved.back());
            c.saved.pop_back();
            if (saved.mask & GL_TEXTURE_BIT) c.unit = saved.unit, c.textures = saved.textures;
            if (saved.mask & GL_ENABLE_BIT) c.state = saved.state; // a simplification
            return;
        }
        case op::glBegin:
            draw(c);
            c.inPrimitive = true;
            return;
        case op::glEnd: c.inPrimitive = false; return;
        case op::glDrawArrays: return draw(c);
        case op::glNewList:
            c.list = arg(0);
            lists_[c.list].clear();
            return;
        case op::glEndList: c.list = 0; return;
        case op::glCallList:
            for (const auto& [opcode, words] : lists_[arg(0)]) {
                wire::RecordView listed;
                listed.opcode = opcode;
                listed.arguments = std::as_bytes(std::span(words));
                execute(c, s, listed);
            }
            return;
        case wire::kOpRequestTexImage: seen_.push_back(content(textures_[arg(2)])); return;
        default: return;
        }
    }

    std::map<uint32_t, Levels> textures_;
    std::map<uint32_t, Bytes> buffers_;
    std::map<std::pair<uint32_t, uint32_t>, uint64_t> uniforms_;
    std::map<uint32_t, Context> contexts_;
    std::map<uint32_t, Stream> streams_;
    std::map<uint32_t, std::vector<std::pair<uint16_t, std::vector<uint32_t>>>> lists_;
    std::vector<uint64_t> seen_;
    size_t sizeBytes_ = 0, uploads_ = 0;
    uint32_t ghosts_ = 1'000'000;
};

} // namespace mural::filter
