// Measures the cost of small OpenGL calls to the calling thread: its CPU time per call in nanoseconds. Independent of
// Mural; first_light runs it natively and through Mural. Each call is accompanied by the time to copy its arguments, a
// lower bound for any capture.
#include <GL/glx.h>
#include <X11/Xlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "tools/bench/gl_window.hpp"

namespace {

using mural::bench::GlWindow;

struct Options {
    int steps = 4000; // per frame
    int frames = 100; // measured, after as many warm-up frames
    std::string jsonFile;
};

int64_t nowNs(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

// Arguments change from call to call, because drivers skip redundant calls.
float valueOf(int step) { return static_cast<float>(step & 1023) * (1.0F / 1024.0F); }

GLint colourLocation = -1;
GLuint textures[2] = {};
PFNGLUNIFORM4FPROC uniform4f = nullptr;
PFNGLUSEPROGRAMPROC useProgram = nullptr;

void callUniform(int steps) {
    for (int i = 0; i < steps; ++i) uniform4f(colourLocation, valueOf(i), 0.25F, 0.5F, 1.0F);
}

// All vertices coincide, so nothing is rasterized.
void callVertices(int steps) {
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < steps; ++i) {
        glColor4f(valueOf(i), 0.25F, 0.5F, 1.0F);
        glVertex3f(0.5F, 0.5F, 0.0F);
    }
    glEnd();
}

void callMatrices(int steps) {
    GLfloat matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (int i = 0; i < steps; ++i) {
        matrix[12] = valueOf(i);
        glLoadMatrixf(matrix);
        glTranslatef(valueOf(i), 0.0F, 0.0F);
    }
    glLoadIdentity();
}

void callSwitches(int steps) {
    for (int i = 0; i < steps; ++i) {
        glEnable(GL_BLEND);
        glDisable(GL_BLEND);
    }
}

void callTextures(int steps) {
    for (int i = 0; i < steps; ++i) glBindTexture(GL_TEXTURE_2D, textures[i & 1]);
}

struct Case {
    const char* name;
    int calls;    // per step
    size_t bytes; // of a captured step: opcode and arguments
    void (*run)(int steps);
    bool shader; // with the GLSL program bound
};
constexpr Case kCases[] = {
    {"glUniform4f", 1, 24, callUniform, true},
    {"glColor4f, glVertex3f in Begin/End", 2, 20 + 16, callVertices, false},
    {"glLoadMatrixf, glTranslatef", 2, 68 + 16, callMatrices, false},
    {"glEnable, glDisable", 2, 8 + 8, callSwitches, false},
    {"glBindTexture", 1, 12, callTextures, false},
};

struct Cost {
    double cpuNs = 0; // of the thread, per call
    double wallNs = 0;
    double copyNs = 0;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Cost measureCase(const Case& c, const Options& options, GLuint program, GlWindow& window) {
    std::vector<double> cpu;
    std::vector<double> wall;
    const double calls = static_cast<double>(c.calls) * options.steps;
    useProgram(c.shader ? program : 0);
    for (int frame = 0; frame < options.frames; ++frame) {
        const int64_t wallNs = nowNs(CLOCK_MONOTONIC);
        const int64_t cpuNs = nowNs(CLOCK_THREAD_CPUTIME_ID);
        c.run(options.steps);
        cpu.push_back(static_cast<double>(nowNs(CLOCK_THREAD_CPUTIME_ID) - cpuNs) / calls);
        wall.push_back(static_cast<double>(nowNs(CLOCK_MONOTONIC) - wallNs) / calls);
        window.show();
    }
    return {median(cpu), median(wall), 0};
}

// Copies into memory larger than the caches, as in a ring between processes.
double measureCopy(const Case& c, const Options& options) {
    constexpr size_t kRingBytes = size_t{64} << 20;
    static std::vector<std::byte> ring(kRingBytes, std::byte{1});
    static size_t at = 0;
    std::byte source[128] = {};
    volatile size_t sizeBytes = c.bytes; // prevents expansion into a few moves
    std::vector<double> cpu;
    for (int frame = 0; frame < options.frames; ++frame) {
        const int64_t cpuNs = nowNs(CLOCK_THREAD_CPUTIME_ID);
        for (int i = 0; i < options.steps; ++i) {
            if (at + sizeof source > kRingBytes) at = 0;
            source[0] = static_cast<std::byte>(i);
            std::memcpy(&ring[at], source, sizeBytes);
            at += c.bytes;
        }
        cpu.push_back(static_cast<double>(nowNs(CLOCK_THREAD_CPUTIME_ID) - cpuNs) /
                      (static_cast<double>(c.calls) * options.steps));
    }
    return median(cpu);
}

// Checks that the last uniform arrived: a quad drawn with it is green.
bool pictureIsRight(GLuint program, GlWindow& window) {
    useProgram(program);
    uniform4f(colourLocation, 0.0F, 1.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glRectf(-1.0F, -1.0F, 1.0F, 1.0F);
    uint8_t pixel[4] = {};
    glReadPixels(8, 8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    const GLenum error = glGetError();
    window.show();
    if (pixel[0] == 0 && pixel[1] == 255 && pixel[2] == 0 && error == GL_NO_ERROR) return true;
    std::fprintf(
        stderr,
        "call_cost: the quad should be 0 255 0 and is %d %d %d, GL error 0x%x; the calls were not all executed\n",
        pixel[0], pixel[1], pixel[2], error);
    return false;
}

void makeTextures() {
    glGenTextures(2, textures);
    const uint32_t texel = 0xffffffffu;
    for (const GLuint name : textures) {
        glBindTexture(GL_TEXTURE_2D, name);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, &texel);
    }
}

void printTable(const std::vector<Cost>& costs) {
    std::printf("%-36s %10s %10s %12s %12s\n", "call", "bytes", "CPU ns", "elapsed ns", "copy ns");
    for (size_t i = 0; i < costs.size(); ++i) {
        const Case& c = kCases[i];
        std::printf("%-36s %10.0f %10.1f %12.1f %12.1f\n", c.name, static_cast<double>(c.bytes) / c.calls,
                    costs[i].cpuNs, costs[i].wallNs, costs[i].copyNs);
    }
}

bool writeJson(const std::string& path, const std::vector<Cost>& costs) {
    FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) {
        std::perror(("call_cost: " + path).c_str());
        return false;
    }
    std::fputs("{\"calls\":[", file);
    for (size_t i = 0; i < costs.size(); ++i) {
        const Case& c = kCases[i];
        std::fprintf(file, "%s{\"name\":\"%s\",\"bytes\":%.1f,\"cpuNs\":%.3f,\"wallNs\":%.3f,\"copyNs\":%.3f}",
                     i == 0 ? "" : ",", c.name, static_cast<double>(c.bytes) / c.calls, costs[i].cpuNs, costs[i].wallNs,
                     costs[i].copyNs);
    }
    std::fputs("]}\n", file);
    return std::fclose(file) == 0;
}

int usage(FILE* to) {
    std::fputs("usage: call_cost [--steps N] [--frames N] [--json FILE]\n"
               "Nanoseconds per OpenGL call, of the calling thread's CPU time (medians over frames).\n"
               "  --steps N    calls (or pairs of calls) in each frame (4000)\n"
               "  --frames N   measured frames per kind of call (100)\n"
               "  --json FILE  the numbers as JSON too\n",
               to);
    return to == stdout ? 0 : 2;
}

bool readOptions(int count, char** words, Options& options) {
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string option = words[i];
        if (option == "--steps")
            options.steps = std::atoi(words[i + 1]);
        else if (option == "--frames")
            options.frames = std::atoi(words[i + 1]);
        else if (option == "--json")
            options.jsonFile = words[i + 1];
        else
            return false;
    }
    return count % 2 == 1 && options.steps > 0 && options.frames > 0;
}

} // namespace

int main(int count, char** words) {
    if (count == 2 && std::string(words[1]) == "--help") return usage(stdout);
    Options options;
    if (!readOptions(count, words, options)) return usage(stderr);
    const auto window = GlWindow::open(64, 64);
    if (!window) return 1;
    uniform4f = window->function<PFNGLUNIFORM4FPROC>("glUniform4f");
    useProgram = window->function<PFNGLUSEPROGRAMPROC>("glUseProgram");
    const GLuint program = window->colourProgram(colourLocation);
    if (program == 0) return 1;
    makeTextures();

    std::vector<Cost> costs;
    for (const bool warm : {false, true}) {
        costs.clear();
        for (const Case& c : kCases) costs.push_back(measureCase(c, options, program, *window));
        if (warm && !pictureIsRight(program, *window)) return 1;
    }
    for (size_t i = 0; i < costs.size(); ++i) costs[i].copyNs = measureCopy(kCases[i], options);
    printTable(costs);
    return options.jsonFile.empty() || writeJson(options.jsonFile, costs) ? 0 : 1;
}
