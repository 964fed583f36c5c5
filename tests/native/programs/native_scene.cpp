// A program with the native API for tests. Its picture depends on the state of the frame, on depth, and on objects that
// nodes request.
//
//   native_scene [--frames N] [--fault NAME] [--work NAME] [--chunk-bytes N]
//
// Work: queue (nodes take the parts of the scene from a queue of the frame, and ignore their ranges), barrier (nodes
// and application enter a barrier in every frame; the application prints how many entered), room (the scene surrounds
// the observer).
//
// Faults: throw (in draw), start (Renderer::start fails), gl (a GL error), range (ignores its range), layout (the state
// has another type than the renderer expects), still (draws one frame, and then waits).
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include <mural/mural.hpp>

namespace {

constexpr int kChunks = 24, kTrianglesOfChunk = 40;

struct Vertex {
    float x, y, z, red, green, blue;
};

// A part of the scene, requested by the nodes that draw it.
struct Chunk {
    mural::Blob vertices;
    template <class Visit> void fields(Visit& visit) { visit(vertices); }
};

struct Scene {
    double angle = 0;
    std::string fault, work;
    std::vector<mural::Ref<Chunk>> chunks;
    template <class Visit> void fields(Visit& visit) { visit(angle, fault, work, chunks); }
};

// The same name with another layout.
struct OtherScene {
    float angle = 0;
    template <class Visit> void fields(Visit& visit) { visit(angle); }
};

// A work item: the number of a part of the scene.
struct Item {
    uint32_t chunk = 0;
    template <class Visit> void fields(Visit& visit) { visit(chunk); }
};

std::string queueOf(uint64_t frame) { return "frame " + std::to_string(frame); }

// Triangles that intersect the triangles of all other chunks.
std::vector<Vertex> verticesOf(int chunk) {
    std::vector<Vertex> vertices;
    uint32_t random = 12345u + static_cast<uint32_t>(chunk) * 7919u;
    const auto next = [&] {
        random = random * 1664525u + 1013904223u;
        return static_cast<float>(random >> 8) / 16777216.0F;
    };
    for (int i = 0; i < 3 * kTrianglesOfChunk; ++i)
        vertices.push_back({next() * 2 - 1, next() * 2 - 1, next() * 2 - 1, next(), next(), next()});
    return vertices;
}

class Turning : public mural::Application {
    mural::Result<void> start(mural::Session& session, int argc, char** argv) override {
        for (int i = 1; i + 1 < argc; i += 2) {
            if (std::strcmp(argv[i], "--frames") == 0) frames_ = std::strtoull(argv[i + 1], nullptr, 10);
            if (std::strcmp(argv[i], "--fault") == 0) fault_ = argv[i + 1];
            if (std::strcmp(argv[i], "--work") == 0) work_ = argv[i + 1];
            if (std::strcmp(argv[i], "--chunk-bytes") == 0) chunkBytes_ = std::strtoull(argv[i + 1], nullptr, 10);
        }
        if (work_ == "barrier") barrier_.emplace(session.barrier("draw"));
        mural::ShareOptions options;
        options.delivery = mural::Delivery::OnDemand;
        for (int i = 0; i < kChunks; ++i) {
            auto vertices = verticesOf(i);
            // More bytes of triangles beyond the wall, random so that compression gains nothing.
            std::mt19937 random(static_cast<uint32_t>(i));
            const auto beyond = [&random] { return 1e6f + static_cast<float>(random() % 1'000'000); };
            while (vertices.size() < chunkBytes_ / sizeof(Vertex) / 3 * 3)
                vertices.push_back({beyond(), beyond(), beyond(), beyond(), beyond(), beyond()});
            auto blob = mural::Blob::copyOf(std::as_bytes(std::span(vertices)));
            if (!blob) return blob.error();
            auto chunk = session.share(Chunk{*blob}, options);
            if (!chunk) return chunk.error();
            if (auto version = chunk->commit(); !version) return version.error();
            chunks_.push_back(std::move(*chunk));
        }
        return {};
    }
    mural::Next update(mural::Session& session, const mural::FrameClock& clock) override {
        if (barrier_ && clock.frame > 1) enterBarrier();
        if (frames_ > 0 && clock.frame > frames_) return mural::Next::End;
        if (fault_ == "still" && clock.frame > 1) return mural::Next::Wait;
        if (fault_ == "layout") {
            session.state<OtherScene>().angle = static_cast<float>(clock.frame);
            return mural::Next::Frame;
        }
        Scene& scene = session.state<Scene>();
        scene.angle = 0.05 * static_cast<double>(clock.frame);
        scene.fault = fault_;
        scene.work = work_;
        if (scene.chunks.empty())
            for (const auto& chunk : chunks_) scene.chunks.push_back(chunk.ref());
        if (work_ == "queue") addWork(session, clock.frame);
        return mural::Next::Frame;
    }
    void addWork(mural::Session& session, uint64_t frame) {
        if (frame == workFrame_) return; // the frame was not sent yet
        workFrame_ = frame;
        auto queue = session.queue<Item>(queueOf(frame));
        for (uint32_t i = 0; i < kChunks; ++i)
            if (auto added = queue.push({i}, frame); !added) throw std::runtime_error(added.error().message);
        queue.close();
    }
    void enterBarrier() {
        auto entered = barrier_->enter(mural::Deadline::inMs(20'000));
        if (!entered) throw std::runtime_error(entered.error().message);
        std::printf("entered %u\n", *entered);
        std::fflush(stdout);
    }
    void end(mural::Session&) override { chunks_.clear(); }

    uint64_t frames_ = 0, workFrame_ = 0;
    size_t chunkBytes_ = 0;
    std::string fault_, work_;
    std::optional<mural::Barrier> barrier_;
    std::vector<mural::Shared<Chunk>> chunks_;
};

constexpr const char* kVertexText = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
uniform mat4 clip;
flat out vec3 colour;
void main() {
    colour = tint;
    gl_Position = clip * vec4(position, 1);
})";
constexpr const char* kFragmentText = R"(#version 330 core
flat in vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1); })";

class Triangles : public mural::Renderer {
    mural::Result<void> start(mural::Pipe&) override {
        if (const char* const fault = std::getenv("NATIVE_SCENE_START"); fault != nullptr)
            return mural::Error{"the renderer fails on purpose"};
        auto program = mural::linkProgram(kVertexText, kFragmentText);
        if (!program) return program.error();
        program_ = *program;
        glGenVertexArrays(1, &array_);
        glGenBuffers(1, &buffer_);
        return {};
    }
    void draw(mural::RenderTask& task) override {
        const Scene& scene = task.state<Scene>();
        if (scene.fault == "throw" && task.frame().number == 2) throw std::runtime_error("thrown on purpose");
        task.setNearFar(scene.work == "room" ? .05 : .5, 20);
        task.apply();
        if (scene.fault == "gl") glEnable(0xffff);
        const double s = std::sin(scene.angle), c = std::cos(scene.angle);
        mural::Matrix4 model = mural::Matrix4::translation({0, 0, scene.work == "room" ? 0. : -5.});
        model = model * mural::Matrix4::rows({c, 0, s}, {0, 1, 0}, {-s, 0, c});
        const auto clip = mural::glMatrix(task.projection() * task.toEye() * model);
        glEnable(GL_DEPTH_TEST);
        glUseProgram(program_);
        glUniformMatrix4fv(glGetUniformLocation(program_, "clip"), 1, GL_FALSE, clip.data());
        glBindVertexArray(array_);
        glBindBuffer(GL_ARRAY_BUFFER, buffer_);
        if (scene.work == "barrier") {
            auto entered = task.barrier("draw").enter(mural::Deadline::inMs(20'000));
            if (!entered) throw std::runtime_error(entered.error().message);
        }
        if (scene.work == "queue") return drawWork(task, scene);
        const mural::Range range = scene.fault == "range" ? mural::Range{} : task.context().range;
        const auto [first, end] = mural::itemsOf(range, scene.chunks.size());
        for (uint64_t i = first; i < end; ++i) drawChunk(task, scene.chunks[i]);
    }
    void drawWork(mural::RenderTask& task, const Scene& scene) {
        auto queue = task.queue<Item>(queueOf(task.frame().number));
        while (true) {
            auto item = queue.pop(mural::Deadline::inMs(20'000));
            if (!item) throw std::runtime_error(item.error().message);
            if (!*item) return;
            drawChunk(task, scene.chunks.at((*item)->chunk));
        }
    }
    void drawChunk(mural::RenderTask& task, const mural::Ref<Chunk>& ref) {
        auto chunk = task.objects().get(ref);
        if (!chunk) throw std::runtime_error(chunk.error().message);
        const auto bytes = (*chunk)->vertices.bytes();
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STREAM_DRAW);
        for (const GLuint attribute : {0U, 1U}) {
            glEnableVertexAttribArray(attribute);
            glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                                  reinterpret_cast<const void*>(uintptr_t{attribute * 12}));
        }
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(bytes.size() / sizeof(Vertex)));
    }
    GLuint program_ = 0, array_ = 0, buffer_ = 0;
};

} // namespace

int main(int argc, char** argv) { return mural::run<Turning, Triangles>(argc, argv); }
