#include "nodes/shaders/texture_gradients.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace mural::shaders {

namespace {

// A sampler type that `texture` accepts; `of`: the components of the coordinates that have gradients.
struct Sampler {
    std::string_view name, coordinates, of, result;
    bool biased = true;
};
constexpr std::array kSamplers = {
    Sampler{"sampler1D", "float", "", "vec4"},
    Sampler{"isampler1D", "float", "", "ivec4"},
    Sampler{"usampler1D", "float", "", "uvec4"},
    Sampler{"sampler2D", "vec2", "", "vec4"},
    Sampler{"isampler2D", "vec2", "", "ivec4"},
    Sampler{"usampler2D", "vec2", "", "uvec4"},
    Sampler{"sampler3D", "vec3", "", "vec4"},
    Sampler{"isampler3D", "vec3", "", "ivec4"},
    Sampler{"usampler3D", "vec3", "", "uvec4"},
    Sampler{"samplerCube", "vec3", "", "vec4"},
    Sampler{"isamplerCube", "vec3", "", "ivec4"},
    Sampler{"usamplerCube", "vec3", "", "uvec4"},
    Sampler{"sampler1DArray", "vec2", ".x", "vec4"},
    Sampler{"isampler1DArray", "vec2", ".x", "ivec4"},
    Sampler{"usampler1DArray", "vec2", ".x", "uvec4"},
    Sampler{"sampler2DArray", "vec3", ".xy", "vec4"},
    Sampler{"isampler2DArray", "vec3", ".xy", "ivec4"},
    Sampler{"usampler2DArray", "vec3", ".xy", "uvec4"},
    Sampler{"samplerCubeArray", "vec4", ".xyz", "vec4"},
    Sampler{"isamplerCubeArray", "vec4", ".xyz", "ivec4"},
    Sampler{"usamplerCubeArray", "vec4", ".xyz", "uvec4"},
    Sampler{"sampler1DShadow", "vec3", ".x", "float"},
    Sampler{"sampler2DShadow", "vec3", ".xy", "float"},
    Sampler{"samplerCubeShadow", "vec4", ".xyz", "float"},
    Sampler{"sampler1DArrayShadow", "vec3", ".x", "float"},
    Sampler{"sampler2DArrayShadow", "vec4", ".xy", "float", false},
};

// Lookup functions of early versions, each for one sampler type. before130: their variants with gradients, from the
// extension.
struct Lookup {
    std::string_view name, sampler, coordinates, before130;
};
constexpr std::array kLookups = {
    Lookup{"texture1D", "sampler1D", "float", "texture1DGradARB"},
    Lookup{"texture2D", "sampler2D", "vec2", "texture2DGradARB"},
    Lookup{"texture3D", "sampler3D", "vec3", "texture3DGradARB"},
    Lookup{"textureCube", "samplerCube", "vec3", "textureCubeGradARB"},
};
constexpr int kFirstWithTexture = 130;

// Returns the text of a lookup function. If all pixels are drawn, it performs the original lookup, bit for bit.
std::string function(std::string_view result, const std::string& name, std::string_view sampler,
                     std::string_view coordinates, std::string_view of, std::string_view own,
                     std::string_view withGradients, bool biased) {
    const std::string p = "p" + std::string(of), head = " " + std::string(result) + " " + name + "(" +
                                                        std::string(sampler) + " s, " + std::string(coordinates) + " p";
    const auto body = [&](const std::string& arguments, const std::string& scale) {
        return ") { if (muralPlace[1].z == 0.0 && muralPlace[1].w == 0.0) return " + std::string(own) + "(" +
               arguments + "); return " + std::string(withGradients) + "(s, p, dFdx(" + p +
               ") * (1.0 + muralPlace[1].z)" + scale + ", dFdy(" + p + ") * (1.0 + muralPlace[1].w)" + scale + "); }";
    };
    return head + body("s, p", "") + (biased ? head + ", float b" + body("s, p, b", " * exp2(b)") : "");
}

bool isType(std::string_view word) {
    return word == "float" || word == "vec2" || word == "vec3" || word == "vec4" || word == "ivec4" || word == "uvec4";
}

// Returns the tokens that call the function; none if the text defines a function of that name.
std::set<size_t> callsOf(const GlslText& text, std::string_view name) {
    std::set<size_t> calls;
    for (size_t i = 0; i < text.tokens.size(); ++i) {
        if (text.tokens[i].text != name || i + 1 >= text.tokens.size() || text.tokens[i + 1].text != "(") continue;
        if (i > 0 && isType(text.tokens[i - 1].text)) return {};
        calls.insert(i);
    }
    return calls;
}

void rename(const GlslText& text, const std::set<size_t>& calls, const std::string& name, TextEdits& edits) {
    for (const size_t i : calls) edits.replace(text.tokens[i].at, text.tokens[i].text.size(), name);
}

} // namespace

TextureLookups withWindowGradients(const GlslText& text, const std::string& ending, TextEdits& edits) {
    TextureLookups done;
    if (text.es) return done;
    const bool hasTexture = text.version >= kFirstWithTexture;
    if (const auto calls = hasTexture ? callsOf(text, "texture") : std::set<size_t>{}; !calls.empty()) {
        const std::string name = "muralTexture" + ending;
        for (const Sampler& s : kSamplers)
            if (text.uses(s.name))
                done.declarations +=
                    function(s.result, name, s.name, s.coordinates, s.of, "texture", "textureGrad", s.biased);
        // Other samplers (rectangles and buffers have no levels) use the original function. In texts with these, no
        // call is rewritten.
        const bool others = std::ranges::any_of(text.tokens, [](const GlslToken& t) {
            return t.text.find("sampler") != std::string_view::npos && t.text.find("sampler") < 2 &&
                   std::ranges::none_of(kSamplers, [&](const Sampler& s) { return s.name == t.text; });
        });
        if (others)
            done.declarations.clear();
        else if (!done.declarations.empty())
            rename(text, calls, name, edits);
    }
    for (const Lookup& l : kLookups) {
        const auto calls = callsOf(text, l.name);
        if (calls.empty() || !text.uses(l.sampler)) continue;
        const std::string name = "mural" + std::string(l.name) + ending;
        done.declarations += function("vec4", name, l.sampler, l.coordinates, "", l.name,
                                      hasTexture ? "textureGrad" : l.before130, true);
        rename(text, calls, name, edits);
        if (!hasTexture) done.extension = "GL_ARB_shader_texture_lod";
    }
    return done;
}

} // namespace mural::shaders
