// Program binaries: the driver's own for the program's context, followed by the recipe from which the nodes link the
// program (docs/reference/wire-format.md). A binary without a recipe, such as one from a run without Mural, fails to
// load. The program then links from source, as it must after a driver update.
#include <cstring>

#include "custom_wrappers.hpp"
#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/memory/shader_writes.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "interposer/encode/program_layout.hpp"
#include "interposer/encode/real_gl.hpp"
#include "interposer/encode/session.hpp"

using namespace mural;

namespace {

struct Footer {
    char magic[8] = {'M', 'u', 'r', 'a', 'l', 'P', 'r', 'g'};
    uint32_t version = 1;
    uint32_t recipeBytes = 0, driverBytes = 0;
    uint32_t checksum = 0;
};
static_assert(sizeof(Footer) == 24);

uint32_t checksumOf(const std::byte* bytes, size_t count) {
    uint32_t hash = 2166136261U;
    for (size_t i = 0; i < count; ++i) hash = (hash ^ static_cast<uint32_t>(bytes[i])) * 16777619U;
    return hash;
}

// Reads the footer of a binary with a recipe. Returns false for others.
bool readFooter(const void* binary, GLsizei length, Footer& footer) {
    if (!binary || length < static_cast<GLsizei>(sizeof(Footer))) return false;
    const auto* bytes = static_cast<const std::byte*>(binary);
    std::memcpy(&footer, bytes + length - sizeof(Footer), sizeof(Footer));
    const Footer wanted;
    return !std::memcmp(footer.magic, wanted.magic, sizeof wanted.magic) && footer.version == wanted.version &&
           uint64_t{footer.recipeBytes} + footer.driverBytes + sizeof(Footer) == static_cast<uint64_t>(length) &&
           checksumOf(bytes + footer.driverBytes, footer.recipeBytes) == footer.checksum;
}

void append(std::byte* binary, uint32_t driverBytes, const void* recipe, uint32_t recipeBytes) {
    Footer footer;
    footer.driverBytes = driverBytes;
    footer.recipeBytes = recipeBytes;
    footer.checksum = checksumOf(static_cast<const std::byte*>(recipe), recipeBytes);
    if (recipeBytes > 0) std::memcpy(binary + driverBytes, recipe, recipeBytes);
    std::memcpy(binary + driverBytes + recipeBytes, &footer, sizeof footer);
}

} // namespace

extern "C" {

void mural_glGetProgramiv(GLuint program, GLenum pname, GLint* params) {
    ThreadState& t = *tThread;
    const auto local = [&] { gReal.glGetProgramiv(program, pname, params); };
    if (pname != GL_PROGRAM_BINARY_LENGTH || !capturing(t)) return local();
    if (!raisesNothing(*t.context, local) || *params <= 0) return;
    uint64_t recipeBytes = 0;
    (void)requestProgram(t, program, recipeBytes);
    *params += static_cast<GLint>(recipeBytes + sizeof(Footer));
}

void mural_glGetProgramBinary(GLuint program, GLsizei bufSize, GLsizei* length, GLenum* binaryFormat, void* binary) {
    ThreadState& t = *tThread;
    const auto local = [&](GLsizei room, GLsizei* written) {
        gReal.glGetProgramBinary(program, room, written, binaryFormat, binary);
    };
    if (!capturing(t) || bufSize < 0) return local(bufSize, length);
    uint64_t recipeBytes = 0;
    const void* recipe = requestProgram(t, program, recipeBytes);
    if (!recipe) recipeBytes = 0;
    const auto more = static_cast<GLsizei>(recipeBytes + sizeof(Footer));
    GLsizei own = 0;
    // The driver reports insufficient space: it receives the space that remains for its part.
    const GLsizei room = bufSize > more ? bufSize - more : 0;
    if (!raisesNothing(*t.context, [&] { local(room, &own); })) {
        if (length) *length = own;
        return;
    }
    if (own > 0)
        append(static_cast<std::byte*>(binary), static_cast<uint32_t>(own), recipe, static_cast<uint32_t>(recipeBytes));
    if (length) *length = own > 0 ? own + more : own;
}

void mural_glProgramBinary(GLuint program, GLenum binaryFormat, const void* binary, GLsizei length) {
    ThreadState& t = *tThread;
    Footer footer;
    const bool isMuralBinary = readFooter(binary, length, footer);
    if (!capturing(t))
        return gReal.glProgramBinary(program, binaryFormat, binary,
                                     isMuralBinary ? static_cast<GLsizei>(footer.driverBytes) : length);
    const bool loads = isMuralBinary && footer.recipeBytes > 0;
    const GLsizei driverBytes = length < 0 ? length : loads ? static_cast<GLsizei>(footer.driverBytes) : 0;
    if (!raisesNothing(*t.context, [&] { gReal.glProgramBinary(program, binaryFormat, binary, driverBytes); })) return;
    if (!loads || !isLinked(*t.context, program)) return records::programRecipe(t, program, {});
    bindAttributes(t, program);
    const auto* const recipe = static_cast<const std::byte*>(binary) + footer.driverBytes;
    recordMemoryWriter(t, program, recipe, footer.recipeBytes);
    records::programRecipe(t, program, DataArg::of(recipe, footer.recipeBytes));
    sendLayout(t, program);
}

} // extern "C"
