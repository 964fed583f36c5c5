// Writes the corpus of replay_fuzz: streams made by the encoder. Usage: replay_fuzz_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "encoders.hpp"
#include "interposer/encode/control_record_writer.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/interposer/encoder_harness.hpp"

namespace mural {
namespace {

class Seed {
public:
    explicit Seed(uint8_t options) : bytes_{static_cast<char>(options)} {}
    ThreadState& t() { return harness_.thread(); }

    // Appends the packets encoded since the last call, as stream `thread` of client 1.
    void cut(uint32_t thread = 1) {
        for (const auto& packet : harness_.takePackets()) add(wire::streamOf(1, thread), packet.data(), packet.size());
    }
    void clientGone(uint32_t client) {
        const uint32_t words[] = {static_cast<uint32_t>(wire::HeadCommand::ClientGone), client};
        add(0, words, sizeof words);
    }
    void begin(uint32_t api = 0, uint32_t major = 4, uint32_t profile = 0) {
        wire::WindowConfig c{};
        c.width = 200;
        c.height = 100;
        c.red = c.green = c.blue = 8;
        c.depth = 24;
        c.doubleBuffer = 1;
        records::window(t(), 1, c);
        records::createContext(t(), {1, 0, api, major, 0, profile, 0, c});
        records::makeCurrent(t(), 1, 1, 1);
    }
    void save(const std::filesystem::path& folder, const char* name) {
        cut();
        std::ofstream(folder / name, std::ios::binary)
            .write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    }

private:
    void add(uint32_t stream, const void* data, size_t size) {
        const wire::PacketHeader header{static_cast<uint32_t>(size), stream};
        bytes_.append(reinterpret_cast<const char*>(&header), sizeof header);
        bytes_.append(static_cast<const char*>(data), size);
    }
    testing::EncoderHarness harness_;
    std::string bytes_;
};

template <class T> DataArg array(const T& values) { return DataArg::of(&values, sizeof values); }

void immediate(Seed& s) {
    s.begin();
    encode_glScissor(s.t(), 10, 10, 50, 50);
    encode_glEnable(s.t(), GL_SCISSOR_TEST);
    encode_glViewport(s.t(), 0, 0, 200, 100);
    encode_glClear(s.t(), GL_COLOR_BUFFER_BIT);
    encode_glPushAttrib(s.t(), GL_ALL_ATTRIB_BITS);
    encode_glBegin(s.t(), GL_TRIANGLES);
    const GLfloat v[4] = {1, 2, 3, 4};
    encode_glVertex3fv(s.t(), v);
    encode_glColor4ub(s.t(), 1, 2, 3, 4);
    encode_glEnd(s.t());
    encode_glLightfv(s.t(), GL_LIGHT0, GL_AMBIENT, array(v));
    const GLdouble d[4] = {1, 2, 3, 4};
    encode_glWindowPos2fv(s.t(), v);
    encode_glWindowPos3dv(s.t(), d);
    encode_glPopAttrib(s.t());
    records::swap(s.t(), 1, 1);
}

void lists(Seed& s) {
    s.begin();
    encode_glNewList(s.t(), 1, GL_COMPILE);
    encode_glVertex3f(s.t(), 1, 2, 3);
    encode_glEnable(s.t(), GL_SCISSOR_TEST);
    encode_glCallList(s.t(), 2);
    static const uint8_t pixels[20000] = {1, 2, 3};
    encode_glDrawPixels(s.t(), 100, 50, GL_RGBA, GL_UNSIGNED_BYTE, DataArg::of(pixels, sizeof pixels));
    encode_glEndList(s.t());
    encode_glNewList(s.t(), 2, GL_COMPILE_AND_EXECUTE);
    encode_glCallList(s.t(), 1);
    encode_glCallList(s.t(), 1);
    encode_glEndList(s.t());
    const GLushort names[] = {1, 2, 3};
    encode_glListBase(s.t(), 0);
    encode_glCallLists(s.t(), 3, GL_UNSIGNED_SHORT, array(names));
    encode_glDeleteLists(s.t(), 1, 2);
    records::swap(s.t(), 1, 1);
}

void objects(Seed& s) {
    s.begin();
    const GLuint names[3] = {1, 2, 70000};
    encode_glGenTextures(s.t(), 3, array(names));
    encode_glBindTexture(s.t(), GL_TEXTURE_2D, 2);
    static const uint8_t pixels[64] = {1};
    encode_glPixelStorei(s.t(), GL_UNPACK_ALIGNMENT, 1);
    encode_glTexImage2D(s.t(), GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, array(pixels));
    encode_glGenBuffers(s.t(), 3, array(names));
    encode_glBindBuffer(s.t(), GL_ARRAY_BUFFER, 1);
    encode_glBufferData(s.t(), GL_ARRAY_BUFFER, 64, array(pixels), GL_STATIC_DRAW);
    records::bufferBytes(s.t(), 1, 8, DataArg::of(pixels, 16));
    encode_glVertexAttribPointer(s.t(), 0, 4, GL_FLOAT, 0, 16, nullptr);
    encode_glBindBuffer(s.t(), GL_ELEMENT_ARRAY_BUFFER, 2);
    encode_glDrawElements(s.t(), GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, DataArg::offset(nullptr));
    encode_glBindBuffer(s.t(), GL_ELEMENT_ARRAY_BUFFER, 0);
    encode_glDrawElements(s.t(), GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, DataArg::of(pixels, 6));
    encode_glGenFramebuffers(s.t(), 3, array(names));
    encode_glBindFramebuffer(s.t(), GL_FRAMEBUFFER, 2);
    const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_NONE};
    encode_glDrawBuffers(s.t(), 2, array(targets));
    encode_glInvalidateFramebuffer(s.t(), GL_FRAMEBUFFER, 2, array(targets));
    records::requestPixels(s.t(), 1, 0, 0, 10, 10, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    encode_glDeleteFramebuffers(s.t(), 3, array(names));
    encode_glDeleteBuffers(s.t(), 3, array(names));
    encode_glDeleteTextures(s.t(), 3, array(names));
    encode_glFenceSync(s.t(), GL_SYNC_GPU_COMMANDS_COMPLETE, 0, reinterpret_cast<GLsync>(uintptr_t{5}));
    encode_glWaitSync(s.t(), reinterpret_cast<GLsync>(uintptr_t{5}), 0, GL_TIMEOUT_IGNORED);
    encode_glDeleteSync(s.t(), reinterpret_cast<GLsync>(uintptr_t{5}));
}

void shaders(Seed& s) {
    s.begin(0, 4, GL_CONTEXT_CORE_PROFILE_BIT);
    encode_glCreateShader(s.t(), GL_VERTEX_SHADER, 1);
    const char* text[] = {"void ", "main() {}"};
    encode_glShaderSource(s.t(), 1, 2, packStrings(s.t(), 2, text, nullptr));
    encode_glCreateProgram(s.t(), 2);
    encode_glAttachShader(s.t(), 2, 1);
    encode_glBindAttribLocation(s.t(), 2, 0, DataArg::text("position"));
    encode_glLinkProgram(s.t(), 2);
    const struct {
        uint32_t count, location, length;
        char name[4];
    } layout = {1, 9, 4, {'m', 'v', 'p', 0}};
    records::programLayout(s.t(), 2, array(layout));
    encode_glUseProgram(s.t(), 2);
    const GLfloat matrix[16] = {1};
    encode_glUniform4fv(s.t(), 9, 4, array(matrix));
    encode_glUniformMatrix4fv(s.t(), 9, 1, 0, array(matrix));
    const GLint box[] = {0, 0, 10, 10, 5, 5, 10, 10};
    encode_glScissorArrayv(s.t(), 0, 2, array(box));
    const GLfloat view[] = {0, 0, 10, 10};
    encode_glViewportArrayv(s.t(), 1, 1, array(view));
    encode_glEnablei(s.t(), GL_SCISSOR_TEST, 1);
    records::swap(s.t(), 1, 1);
}

void clientMemory(Seed& s) {
    s.begin();
    static const GLfloat vertices[32] = {1};
    static const uint8_t large[17000] = {1};
    const client_arrays::ArrayRecord arrays[] = {
        {client_arrays::kVertex, 3, GL_FLOAT, 0, 12, 0, 0, 0, 3},
        {client_arrays::kTexCoord0, 2, GL_FLOAT, 0, 8, 1, 0, 2, 3},
        {client_arrays::kGeneric0 + 1, 4, GL_UNSIGNED_BYTE, client_arrays::kNormalized, 4, 0, 4, 0, 3}};
    const DataArg spans[] = {array(vertices), DataArg::of(large, sizeof large)};
    records::clientArrays(s.t(), arrays, 3, spans, 2);
    encode_glDrawArrays(s.t(), GL_TRIANGLES, 0, 3);
    const GLsizei counts[] = {3, 3};
    const struct {
        uint32_t kind, zero;
        uint16_t indices[8];
    } indices = {0, 0, {0, 1, 2, 0, 1, 2, 0, 0}};
    encode_glMultiDrawElements(s.t(), GL_TRIANGLES, array(counts), GL_UNSIGNED_SHORT, array(indices), 2);
    encode_glPolygonStipple(s.t(), DataArg::of(large, 128));
    encode_glBitmap(s.t(), 8, 8, 0, 0, 1, 1, DataArg::of(large, 8));
    encode_glMap2d(s.t(), GL_MAP2_VERTEX_3, 0, 1, 3, 2, 0, 1, 6, 2, DataArg::of(large, 96));
    records::fillWindow(s.t(), 2, 3, 4, 5, GL_COLOR_BUFFER_BIT, DataArg::of(large, 80));
    records::fillWindow(s.t(), 2, 3, 4, 5, GL_DEPTH_BUFFER_BIT, DataArg::of(large, 80));
    encode_glCopyTexImage2D(s.t(), GL_TEXTURE_2D, 0, GL_RGBA, 0, 0, 16, 16, 0);
    records::requestTexImage(s.t(), 1, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, 64);
    records::requestTexImage(s.t(), 2, 0, GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, 64);
    records::requestQuery(s.t(), 3, 1, GL_QUERY_RESULT);
    records::requestFinish(s.t(), 4);
}

// Encodes two threads and two contexts, with windows that are created, changed and destroyed under both.
void threads(Seed& s) {
    s.begin();
    s.cut(1);
    wire::WindowConfig c{};
    c.width = 64;
    c.height = 64;
    c.samples = 4;
    records::window(s.t(), 2, c);
    records::createContext(s.t(), {2, 1, 2, 3, 0, 0, 0, c});
    records::makeCurrent(s.t(), 2, 2, 1);
    records::swap(s.t(), 2, 1);
    s.cut(2);
    c.width = 128;
    records::window(s.t(), 1, c);
    records::destroyWindow(s.t(), 2);
    records::swap(s.t(), 2, 2);
    s.cut(3);
    encode_glClear(s.t(), GL_COLOR_BUFFER_BIT);
    records::swap(s.t(), 1, 1);
    s.cut(1);
    records::destroyContext(s.t(), 2);
    records::makeCurrent(s.t(), 0, 0, 0);
    s.cut(2);
    s.clientGone(1);
    s.begin(1, 1);
}

// Encodes all control records while no context is current any more.
void released(Seed& s) {
    s.begin();
    encode_glClear(s.t(), GL_COLOR_BUFFER_BIT);
    records::makeCurrent(s.t(), 0, 0, 0);
    records::destroyContext(s.t(), 1);
    static const uint32_t words[64] = {1};
    records::requestFinish(s.t(), 1);
    records::swap(s.t(), 1, 1);
    records::frontPicture(s.t(), 1, 2);
    records::requestPixels(s.t(), 2, 0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    records::requestTexImage(s.t(), 3, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, 64);
    records::requestQuery(s.t(), 4, 1, GL_QUERY_RESULT);
    records::requestBuffer(s.t(), 5, 1, 0, 64);
    records::beginConditional(s.t(), true);
    records::queryKnown(s.t(), 1, true);
    records::fillWindow(s.t(), 2, 3, 4, 4, GL_COLOR_BUFFER_BIT, array(words));
    records::fillWindow(s.t(), 2, 3, 4, 4, GL_DEPTH_BUFFER_BIT, array(words));
    records::bufferBytes(s.t(), 1, 0, array(words));
    records::programLayout(s.t(), 1, array(words));
    const client_arrays::ArrayRecord arrays[] = {{client_arrays::kVertex, 3, GL_FLOAT, 0, 12, 0, 0, 0, 3}};
    const DataArg spans[] = {array(words)};
    records::clientArrays(s.t(), arrays, 1, spans, 1);
    encode_glClear(s.t(), GL_COLOR_BUFFER_BIT);
    records::destroyWindow(s.t(), 1);
}

} // namespace
} // namespace mural

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "replay_fuzz_seeds FOLDER\n");
        return 1;
    }
    const struct {
        const char* name;
        void (*make)(mural::Seed&);
    } seeds[] = {{"immediate", mural::immediate},
                 {"lists", mural::lists},
                 {"objects", mural::objects},
                 {"shaders", mural::shaders},
                 {"client_memory", mural::clientMemory},
                 {"threads", mural::threads},
                 {"released", mural::released}};
    for (const auto& [name, make] : seeds) {
        for (const int options : {2, 7}) { // exact tiles; lean tiles with one colour buffer
            mural::Seed seed(static_cast<uint8_t>(options));
            make(seed);
            seed.save(argv[1], (std::string(name) + "_" + std::to_string(options)).c_str());
        }
    }
}
