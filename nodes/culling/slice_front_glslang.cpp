// Parses shader texts with glslang (shader_slice.hpp).
#include <array>
#include <cctype>
#include <mutex>
#include <string_view>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/MachineIndependent/localintermediate.h>

#include "nodes/culling/slice_interpreter.hpp"

namespace mural::culling {

namespace {

// Versions of texts without #version.
constexpr int kDefaultVersion = 110, kDefaultEsVersion = 100;

// Names that the driver and glslang define alike. A text that asks for others may take another branch there.
constexpr std::string_view kAgreedNames[] = {"GL_ES", "GL_FRAGMENT_PRECISION_HIGH", "GL_core_profile",
                                             "GL_compatibility_profile"};

bool isNameByte(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Whether the text mentions a name that drivers define, other than in a line with #extension.
bool asksDriver(std::string_view text) {
    for (size_t at = text.find("GL_"); at != std::string_view::npos; at = text.find("GL_", at + 1)) {
        if (at > 0 && isNameByte(text[at - 1])) continue;
        size_t end = at;
        while (end < text.size() && isNameByte(text[end])) ++end;
        const std::string_view word = text.substr(at, end - at);
        bool isAgreed = false;
        for (const std::string_view agreed : kAgreedNames) isAgreed = isAgreed || word == agreed;
        const size_t newline = text.rfind('\n', at);
        const size_t line = newline == std::string_view::npos ? 0 : newline + 1;
        const std::string_view before = text.substr(line, at - line);
        const bool isExtension =
            before.find('#') != std::string_view::npos && before.find("extension") != std::string_view::npos;
        if (!isAgreed && !isExtension) return true;
    }
    return false;
}

} // namespace

ShaderSlice sliceOf(const std::string& text, bool isEs) {
    static std::mutex mutex; // glslang's tables are of the process
    const std::lock_guard lock(mutex);
    static const bool isReady = glslang::InitializeProcess();
    const auto refuse = [](const char* reason) {
        ShaderSlice slice;
        slice.reason = reason;
        return slice;
    };
    if (!isReady) return refuse("glslang does not start");
    if (asksDriver(text) || text.find("#include") != std::string::npos)
        return refuse("it asks for features of the driver");
    if (text.find("gl_Layer") != std::string::npos || text.find("gl_ViewportIndex") != std::string::npos)
        return refuse("it chooses a layer or viewport");
    glslang::TShader shader(EShLangVertex);
    const char* const source = text.c_str();
    shader.setStrings(&source, 1);
    const int version = isEs ? kDefaultEsVersion : kDefaultVersion;
    const EProfile profile = isEs ? EEsProfile : ENoProfile;
    if (!shader.parse(GetDefaultResources(), version, profile, false, false, EShMsgRelaxedErrors) ||
        !shader.getIntermediate() || !shader.getIntermediate()->getTreeRoot())
        return refuse("glslang refuses it");
    return SliceInterpreter(shader.getIntermediate()->getTreeRoot()).slice();
}

} // namespace mural::culling
