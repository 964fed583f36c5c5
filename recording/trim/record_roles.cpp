#include "recording/trim/record_roles.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "gl_opcodes.hpp"
#include "streamcodec/opcode_names.hpp"

namespace mural::recording {
namespace {

using Names = std::initializer_list<std::string_view>;

bool beginsWithOne(std::string_view name, Names beginnings) {
    return std::ranges::any_of(beginnings, [&](std::string_view b) { return name.starts_with(b); });
}

Role roleOfName(std::string_view name) {
    if (name == "glBegin") return Role::Begin;
    if (name == "glEnd") return Role::End;
    if (name == "glClear") return Role::Clear;
    if (beginsWithOne(name, {"glCallList"})) return Role::CallsLists;
    if (beginsWithOne(name, {"glVertex2", "glVertex3", "glVertex4", "glVertexP"}) && name != "glVertexPointer") return Role::Vertex;
    if (beginsWithOne(name, {"glDrawArrays", "glDrawElements", "glDrawRangeElements", "glMultiDrawArrays", "glMultiDrawElements", "glRect"})) return Role::Draw;
    if (beginsWithOne(name, {"glCopyTex", "glCopyMultiTex", "glCopyPixels", "glCopyColor", "glCopyConvolution", "glBlit"})) return Role::Reads;
    const bool current = beginsWithOne(name, {"glNormal3", "glNormalP", "glColor3", "glColor4", "glColorP", "glSecondaryColor3", "glSecondaryColorP", "glTexCoord1", "glTexCoord2", "glTexCoord3",
                                              "glTexCoord4", "glTexCoordP", "glMultiTexCoord", "glFogCoordf", "glFogCoordd", "glEdgeFlag", "glMaterial", "glIndexf", "glIndexd", "glIndexi", "glIndexs", "glIndexub"});
    return current && !name.ends_with("Pointer") && !name.ends_with("PointerEXT") ? Role::Attribute : Role::Other;
}

} // namespace

Role roleOf(uint16_t opcode) {
    static const auto kRoles = [] {
        std::array<Role, op::kLimit> roles{};
        for (uint16_t i = 0; i < roles.size(); ++i)
            if (const char* name = glOpcodeName(i)) roles[i] = roleOfName(name);
        return roles;
    }();
    return opcode < kRoles.size() ? kRoles[opcode] : Role::Other;
}

} // namespace mural::recording
