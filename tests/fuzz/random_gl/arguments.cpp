// Calls any command of the registry with arguments that its groups permit, and sometimes with invalid ones.
#include "tests/programs/support/gl.hpp"

#include <GL/glx.h>
#include <algorithm>
#include <cstring>

#include "tests/fuzz/random_gl/image_formats.hpp"
#include "tests/fuzz/random_gl/recipes.hpp"

namespace fuzz {
namespace {

constexpr std::size_t kMaxParams = 24;
constexpr std::size_t kOutputStep = 1 << 14; // bytes for each pointer that is written to

bool bound(const World& w, GLenum query) {
    GLint name = 0;
    if (w.profile != Profile::Es1) {
        glGetIntegerv(query, &name);
    }
    return name != 0;
}

void* offset(World& w, std::uint32_t step) {
    return reinterpret_cast<void*>(std::uintptr_t{w.random.below(16)} * step); // NOLINT: an offset
}

// Returns the number of components that the command gives an attribute; 0: none.
int attributeSize(std::string_view name) {
    for (const std::string_view attribute : {"glTexCoord", "glMultiTexCoord", "glVertexAttrib", "glColor"}) {
        const std::size_t digit = name.find_first_of("1234", attribute.size());
        if (name.starts_with(attribute) && digit != std::string_view::npos && digit <= attribute.size() + 2) {
            return name[digit] - '0';
        }
    }
    return 0;
}

class Call {
public:
    Call(World& w, const Command& command) : w_(w), command_(command) {
        for (std::size_t i = 0; i < command.paramCount; ++i) {
            draw(i);
        }
        adjust();
        for (std::size_t i = 0; i < command.paramCount; ++i) {
            point(i);
        }
    }

    // Returns false for vertices outside glBegin and glEnd, and for attributes whose result is undefined in Mesa 22.3.6
    // (docs/measurements/exactness.md).
    bool isDefined() {
        const std::string_view name = command_.name;
        const bool vertex = name.starts_with("glVertex2") || name.starts_with("glVertex3") ||
                            name.starts_with("glVertex4") || name.starts_with("glEvalCoord") ||
                            name.starts_with("glEvalPoint");
        if (vertex && !w_.insideBegin) {
            return false;
        }
        constexpr std::string_view others[] = {"glNormal3", "glFogCoord", "glSecondaryColor3",
                                               "glIndex",   "glEdgeFlag", "glMaterial"};
        const int size = w_.profile == Profile::Es1 ? 0 : attributeSize(name);
        const bool other = std::any_of(std::begin(others), std::end(others),
                                       [&](std::string_view start) { return name.starts_with(start); });
        if (w_.compilesList &&
            ((w_.behindVertex && (size != 0 || other)) || (w_.insideBegin && name.starts_with("glEval")))) {
            return false;
        }
        const bool attribute0 =
            name.starts_with("glVertexAttrib") && find("index") != nullptr && find("index")->whole == 0;
        if (w_.insideBegin && attribute0 && name.starts_with("glVertexAttribI")) {
            return false; // an integer position
        }
        w_.behindVertex = w_.behindVertex || (w_.insideBegin && (attribute0 || vertex || name.starts_with("glEval")));
        // These attributes of NV_vertex_program also set colours and texture coordinates.
        const bool aliases = name.starts_with("glVertexAttrib") && name.ends_with("NV");
        return size == 0 || (name.starts_with("glColor") ? (size == 4) == (w_.attributeSize == 4)
                                                         : size == w_.attributeSize && (!aliases || size == 4));
    }

    void make() {
        void* const function =
            reinterpret_cast<void*>(glXGetProcAddress(reinterpret_cast<const GLubyte*>(command_.name)));
        if (w_.trace) {
            show();
        }
        const std::uint64_t result = command_.invoke(function, values_);
        if (command_.returns && command_.made == Kind::Nothing) {
            w_.observe(result);
        }
        w_.keep(command_.made, static_cast<GLuint>(result));
        keepMade();
        // The output memory of a failed call is undefined.
        const std::size_t errors = w_.errors.size();
        w_.traceError();
        if (outputBytes_ > 0 && !w_.insideBegin && !w_.failed() && w_.errors.size() == errors) {
            w_.observe(output_, outputBytes_);
        }
    }

private:
    [[nodiscard]] const Param& param(std::size_t i) const { return command_.params[i]; }

    Value* find(const char* name) {
        for (std::size_t i = 0; i < command_.paramCount; ++i) {
            if (std::strcmp(param(i).name, name) == 0) {
                return &values_[i];
            }
        }
        return nullptr;
    }

    std::uint32_t enumOf(std::uint16_t group) {
        const auto& values = kGroups[w_.random.chance(3) ? 0 : group];
        return values[w_.random.below(static_cast<std::uint32_t>(values.size()))];
    }

    std::uint32_t bitsOf(std::uint16_t group) {
        const auto& values = kGroups[group];
        if (group == 0 || values.empty() || w_.random.chance(2)) {
            return w_.random.below(256);
        }
        std::uint32_t bits = 0;
        for (std::uint32_t i = w_.random.below(4); i > 0; --i) {
            bits |= values[w_.random.below(static_cast<std::uint32_t>(values.size()))];
        }
        return bits;
    }

    // Draws a value for an argument that is not a pointer.
    void draw(std::size_t i) {
        const Param& p = param(i);
        Value& value = values_[i];
        value.whole = 0;
        Random& random = w_.random;
        switch (p.draw) {
        case Draw::Enum: value.whole = enumOf(p.group); break;
        case Draw::Bits: value.whole = bitsOf(p.group); break;
        case Draw::Boolean: value.whole = random.below(2); break;
        case Draw::Number:
            value.whole = static_cast<std::uint64_t>(std::int64_t{random.between(p.low, p.high)});
            if (random.chance(2)) {
                value.whole = random.chance(50) ? ~std::uint64_t{0} : random.below(5000);
            }
            break;
        case Draw::Real: {
            const float real = random.chance(10) ? static_cast<float>(random.between(-4, 60)) : random.around();
            if (p.type == Type::Single) {
                value.single = real;
            } else {
                value.real = static_cast<double>(real);
            }
            break;
        }
        case Draw::Object: value.whole = w_.name(p.kind); break;
        case Draw::Sync:
            if (!w_.syncs.empty()) {
                value.pointer = w_.syncs[random.below(static_cast<std::uint32_t>(w_.syncs.size()))];
            }
            break;
        default: break;
        }
    }

    // Replaces formats and types with matching pairs, most of the time.
    void adjust() {
        Value* const format = find("format");
        Value* const type = find("type");
        Value* const internal = find("internalformat");
        if ((format != nullptr && type != nullptr) || internal != nullptr) {
            const ImageFormat& image = anyFormat(w_);
            if (w_.random.chance(85)) {
                set(format, image.format);
                set(type, image.type);
                set(internal, image.internal);
            }
        }
        limit({"count",        "drawcount", "instancecount", "primcount", "samples",   "range",     "n",
               "bufSize",      "size",      "length",        "maxCount",  "propCount", "mapsize",   "uorder",
               "vorder",       "order",     "ustride",       "vstride",   "stride",    "imageSize", "basevertex",
               "baseinstance", "first",     "start",         "un",        "vn",        "i",         "numAttachments"},
              1000);
        limit({"width", "height", "depth", "levels", "num_groups_x", "num_groups_y", "num_groups_z"}, 40);
        // Mesa also writes pixels to buffers in OpenGL ES 1, which has no query for the binding.
        if (w_.profile == Profile::Es1 && std::strcmp(command_.name, "glBindBuffer") == 0) {
            set(find("target"), w_.random.chance(50) ? GL_ARRAY_BUFFER : GL_ELEMENT_ARRAY_BUFFER);
        }
        if (std::strncmp(command_.name, "glPixelStore", 12) == 0) {
            limit({"param"}, 48);
        }
        // Mesa 22.3.6 adds the count to -1, accepts the result and accesses memory before the first element.
        const bool overflows = std::strstr(command_.name, "ProgramLocalParameter") != nullptr ||
                               std::strcmp(command_.name, "glScissorArrayv") == 0;
        for (Value* const value : {find("index"), find("first")}) {
            if (overflows && value != nullptr && value->whole == ~0U) {
                value->whole = 1000;
            }
        }
        if (Value* const end = find("end"); end != nullptr && find("indices") != nullptr) {
            end->whole = 300;
        }
    }

    // Limits numbers, so that no call draws or allocates for minutes.
    void limit(std::initializer_list<const char*> names, std::int32_t highest) {
        for (const char* const name : names) {
            Value* const value = find(name);
            if (value != nullptr && static_cast<std::int32_t>(value->whole) > highest) {
                value->whole = 5;
            }
        }
    }

    static void set(Value* value, std::uint32_t to) {
        if (value != nullptr) {
            value->whole = to;
        }
    }

    void point(std::size_t i) {
        const Param& p = param(i);
        Value& value = values_[i];
        switch (p.draw) {
        case Draw::Input: value.pointer = const_cast<void*>(inputOf(p.type, w_.random)); break;
        case Draw::Text: value.pointer = const_cast<char*>(text(w_.random)); break;
        case Draw::Names:
            for (GLuint& name : array_) {
                name = w_.name(p.kind);
            }
            value.pointer = array_;
            break;
        case Draw::Enums:
            for (GLuint& one : array_) {
                one = enumOf(p.group);
            }
            value.pointer = array_;
            break;
        case Draw::Made: value.pointer = made_; break;
        case Draw::Unpack: value.pointer = unpacked(p); break;
        case Draw::Pack:
            value.pointer = bound(w_, GL_PIXEL_PACK_BUFFER_BINDING) ? offset(w_, 4) : output(kOutputBytes / 2);
            break;
        case Draw::Array: value.pointer = vertices(); break;
        case Draw::Indices: value.pointer = indices(); break;
        case Draw::Output: value.pointer = output(kOutputStep); break;
        default: break;
        }
    }

    void* unpacked(const Param& p) {
        if (bound(w_, GL_PIXEL_UNPACK_BUFFER_BINDING)) {
            return offset(w_, 4);
        }
        const Value* const type = find("type");
        const bool floats = p.type == Type::Float || (type != nullptr && type->whole == GL_FLOAT);
        return const_cast<void*>(inputOf(floats                ? Type::Float
                                         : p.type == Type::Int ? Type::Int
                                                               : Type::Byte,
                                         w_.random));
    }

    void* vertices() {
        if (bound(w_, GL_ARRAY_BUFFER_BINDING) || !w_.clientArrays()) {
            return offset(w_, 4);
        }
        return const_cast<void*>(vertexMemory(w_.random));
    }

    // Returns indices. Buffers may contain any elements, so with vertices in client memory the buffer is filled first.
    void* indices() {
        const Value* const type = find("type");
        const auto typeEnum = static_cast<std::uint32_t>(type != nullptr ? type->whole : GL_UNSIGNED_BYTE);
        GLint buffer = 0;
        glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &buffer);
        if (buffer != 0 && w_.clientArrays()) {
            while (glGetError() != GL_NO_ERROR) {}
            glBufferData(GL_ELEMENT_ARRAY_BUFFER, 512, indexMemory(w_.random, typeEnum), GL_STATIC_DRAW);
            if (glGetError() != GL_NO_ERROR) {
                glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer = 0);
            }
        }
        if (!w_.clientArrays() && buffer == 0) { // Mesa uses the offset as a pointer
            GLuint made = 0;
            glGenBuffers(1, &made);
            w_.keep(Kind::Buffer, made);
            glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, made);
            glBufferData(GL_ELEMENT_ARRAY_BUFFER, 512, indexMemory(w_.random, typeEnum), GL_STATIC_DRAW);
            return offset(w_, 4);
        }
        if (buffer != 0) {
            return offset(w_, 4);
        }
        return const_cast<void*>(indexMemory(w_.random, typeEnum));
    }

    void* output(std::size_t bytes) {
        if (output_ == nullptr) {
            const std::size_t all = bytes > kOutputStep ? bytes + 4 * kOutputStep : 6 * kOutputStep;
            output_ = static_cast<std::byte*>(outputMemory(all));
        }
        std::byte* const here = output_ + outputBytes_;
        outputBytes_ += bytes;
        return here;
    }

    void keepMade() {
        for (std::size_t i = 0; i < command_.paramCount; ++i) {
            if (param(i).draw == Draw::Made) {
                for (const GLuint name : made_) {
                    w_.keep(param(i).kind, name);
                }
            }
        }
    }

    void show() {
        std::string shownArguments;
        for (std::size_t i = 0; i < command_.paramCount; ++i) {
            const Type type = param(i).type;
            shownArguments += std::string(param(i).name) + "=";
            if (param(i).draw == Draw::Real) {
                shownArguments +=
                    shown(type == Type::Single ? static_cast<double>(values_[i].single) : values_[i].real);
            } else if (param(i).draw == Draw::Text) {
                shownArguments += static_cast<const char*>(values_[i].pointer);
            } else {
                shownArguments += param(i).type == Type::Pointer || param(i).draw >= Draw::Input
                                      ? shown(values_[i].pointer)
                                      : shown(static_cast<std::int64_t>(values_[i].whole));
            }
            if (param(i).draw == Draw::Names || param(i).draw == Draw::Enums) {
                shownArguments += ":" + shown(array_[0]) + "," + shown(array_[1]);
            }
            shownArguments += " ";
        }
        traceText(command_.name, shownArguments);
    }

    World& w_;
    const Command& command_;
    Value values_[kMaxParams];
    GLuint array_[1024] = {};
    GLuint made_[1024] = {};
    std::byte* output_ = nullptr;
    std::size_t outputBytes_ = 0;
};

} // namespace

void callCommand(World& w, const Command& command) {
    Call call(w, command);
    if (call.isDefined()) {
        call.make();
    }
}

void callAny(World& w) {
    const auto& families = w.families();
    for (;;) {
        const auto& family = families[w.random.below(static_cast<std::uint32_t>(families.size()))];
        const Command& command = *family[w.random.below(static_cast<std::uint32_t>(family.size()))];
        const bool deletes = std::string_view(command.name).starts_with("glDelete");
        const bool gone = command.removed && w.profile == Profile::Core;
        if ((deletes && !w.random.chance(25)) || (gone && !w.random.chance(6))) {
            continue;
        }
        const std::string_view name = command.name;
        const bool draws = name.starts_with("glDrawArrays") || name.starts_with("glDrawElements") ||
                           name.starts_with("glDrawRange") || name.starts_with("glMultiDraw");
        if (draws && !drawsAnything(w)) {
            continue;
        }
        callCommand(w, command);
        return;
    }
}

} // namespace fuzz
