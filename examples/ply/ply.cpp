// A viewer of polygon meshes. The triangles are in leaves of a kd-tree. A node draws the leaves of its range that its
// part of the picture shows, and loads only these.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <mural/mural.hpp>

#include "examples/base/arguments.hpp"
#include "examples/base/turning.hpp"
#include "examples/ply/leaf_geometry.hpp"
#include "examples/ply/model.hpp"

namespace mural::examples {
namespace {

constexpr const char* kHelp = R"(Shows a mesh: PLY, OFF, STL or OBJ, also compressed with gzip.

  ply [OPTIONS] FILE
  --frames N            ends after N frames
  --turn-per-frame DEG  turns by a fixed angle per frame, for reproducible pictures
  --turn-per-second DEG turns by time (default 20)
  --pitch DEG           tilts the mesh towards the viewer (default 0); -90 if its z axis points up
  --colour RRGGBB       colour of the mesh (default e0d0b8)
  --report              nodes print how many leaves of the mesh they hold

Examples:
  tools/example-data dragon
  mural run -- ./ply build/example-data/dragon.ply
  mural run --tiles 4x2 -- ./ply build/example-data/dragon.ply
  mural run --db 4 --size 640x480 --out pictures -- ./ply --frames 5 --turn-per-frame 10 build/example-data/dragon.ply
)";

struct Options {
    std::string file;
    uint64_t frames = 0; // 0: no end
    std::optional<double> turnPerFrame;
    double turnPerSecond = 20, pitch = 0; // degrees
    std::array<float, 3> colour{};
    bool reports = false;
};

Result<Options> parseOptions(int argc, char** argv) {
    Arguments arguments(argc, argv);
    Options options;
    options.frames = static_cast<uint64_t>(arguments.takeNumber("--frames", 0, 1, 1e9));
    const double none = 1e9;
    const double perFrame = arguments.takeNumber("--turn-per-frame", none, -360, 360);
    if (perFrame != none) options.turnPerFrame = perFrame;
    options.turnPerSecond = arguments.takeNumber("--turn-per-second", options.turnPerSecond, -3600, 3600);
    options.pitch = arguments.takeNumber("--pitch", 0, -180, 180);
    options.reports = arguments.takeFlag("--report");
    const Result<std::array<float, 3>> colour = parseColour(arguments.takeText("--colour").value_or("e0d0b8"));
    Result<std::vector<std::string>> files = arguments.finish();
    if (!files) return files.error();
    if (!colour) return colour.error();
    if (files->size() != 1) return Error{"one file is needed; --help shows examples"};
    options.colour = colour.value();
    options.file = files->front();
    return options;
}

// The application: reads the mesh, publishes its leaves, and turns it.
class Viewer : public Application {
    Result<Next> parse(int argc, char** argv) override {
        if (isHelpWanted(argc, argv)) {
            std::fputs(kHelp, stdout);
            return Next::End;
        }
        Result<Options> options = parseOptions(argc, argv);
        if (!options) return options.error();
        options_ = *options;
        return Next::Frame;
    }
    Result<void> start(Session& session, int, char**) override {
        const Result<Mesh> mesh = readMesh(options_.file);
        if (!mesh) return mesh.error();
        return publish(session, mesh.value());
    }

    Next update(Session& session, const FrameClock& clock) override {
        if (options_.frames > 0 && clock.frame > options_.frames) return Next::End;
        Scene& scene = session.state<Scene>();
        scene.turn = options_.turnPerFrame ? *options_.turnPerFrame * static_cast<double>(clock.frame - 1)
                                           : options_.turnPerSecond * clock.seconds;
        return Next::Frame;
    }

    Result<void> publish(Session& session, const Mesh& mesh) {
        Model model;
        std::vector<uint32_t> order;
        ShareOptions options;
        options.sharing = Sharing::Static;
        options.delivery = Delivery::OnDemand;
        model.tree = KdTree::build(mesh, order);
        for (uint32_t leaf = 0; leaf < model.tree.leaves(); ++leaf) {
            const uint64_t first = model.tree.firstTriangle(leaf);
            const auto triangles = std::span(order).subspan(first, model.tree.endTriangle(leaf) - first);
            Result<Blob> geometry = Blob::copyOf(packLeaf(mesh, triangles));
            if (!geometry) return geometry.error();
            Result<Shared<Leaf>> shared = session.share(Leaf{*geometry}, options);
            if (!shared) return shared.error();
            if (const auto committed = shared->commit(); !committed) return committed.error();
            model.leaves.push_back(shared->ref());
            leaves_.push_back(std::move(*shared));
        }
        const Box& box = model.tree.nodes().front().box;
        for (size_t k = 0; k < 3; ++k) model.centre[k] = (double(box.lowest[k]) + double(box.highest[k])) / 2;
        double square = 0;
        for (const Point& p : mesh.positions) square = std::max(square, squareOf(p, model.centre));
        model.radius = square > 0 ? std::sqrt(square) : 1;
        options.delivery = Delivery::Push;
        Result<Shared<Model>> shared = session.share(std::move(model), options);
        if (!shared) return shared.error();
        if (const auto committed = shared->commit(); !committed) return committed.error();
        model_.emplace(std::move(*shared));
        session.state<Scene>() = {model_->ref(), 0, options_.pitch, options_.colour, options_.reports};
        return {};
    }

    static double squareOf(const Point& point, const std::array<double, 3>& centre) {
        double square = 0;
        for (size_t k = 0; k < 3; ++k) square += (point[k] - centre[k]) * (point[k] - centre[k]);
        return square;
    }

    Options options_;
    std::vector<Shared<Leaf>> leaves_; // an object ends with its Shared
    std::optional<Shared<Model>> model_;
};

constexpr const char* kVertexShader = R"(#version 330 core
uniform mat4 toEye;
uniform mat4 toClip;
uniform vec3 tint;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
out vec3 eyePosition;
out vec3 eyeNormal;
out vec3 surface;
void main() {
    vec4 p = toEye * vec4(position, 1);
    eyePosition = p.xyz;
    eyeNormal = mat3(toEye) * normal;
    surface = colour.rgb * tint;
    gl_Position = toClip * vec4(position, 1);
})";

// Light at the eye. Both sides of a triangle are lit, because the order of corners differs among files.
constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 eyePosition;
in vec3 eyeNormal;
in vec3 surface;
out vec4 pixel;
void main() {
    float light = abs(dot(normalize(eyeNormal), normalize(eyePosition)));
    float shine = light * light * light * light;
    pixel = vec4(surface * (.12 + .88 * light) + .25 * shine * shine * shine, 1);
})";

// A leaf in the memory of the GL.
struct LoadedLeaf {
    unsigned buffer = 0, vertices = 0;
    int indices = 0;
    size_t indexOffset = 0;
};

LoadedLeaf load(std::span<const std::byte> bytes) {
    const auto view = viewLeaf(bytes);
    if (!view) throw std::runtime_error("a leaf of the mesh is damaged");
    const auto offsetOf = [&](const void* part) {
        return static_cast<size_t>(static_cast<const std::byte*>(part) - bytes.data());
    };
    const size_t first = offsetOf(view->vertices.data());
    const auto at = [&](size_t member) { return reinterpret_cast<const void*>(first + member); };
    LoadedLeaf leaf;
    leaf.indices = static_cast<int>(view->indices.size());
    leaf.indexOffset = offsetOf(view->indices.data());
    glGenVertexArrays(1, &leaf.vertices);
    glGenBuffers(1, &leaf.buffer);
    glBindVertexArray(leaf.vertices);
    glBindBuffer(GL_ARRAY_BUFFER, leaf.buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, leaf.buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);
    constexpr int kStride = sizeof(LeafVertex);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, at(offsetof(LeafVertex, position)));
    glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, kStride, at(offsetof(LeafVertex, normal)));
    glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(LeafVertex, colour)));
    for (unsigned attribute = 0; attribute < 3; ++attribute) glEnableVertexAttribArray(attribute);
    return leaf;
}

// The render node: draws the leaves of its range.
class MeshRenderer : public Renderer {
    Result<void> start(Pipe& pipe) override {
        Result<unsigned> program = linkProgram(kVertexShader, kFragmentShader);
        if (!program) return program.error();
        program_ = *program;
        toEye_ = glGetUniformLocation(program_, "toEye");
        toClip_ = glGetUniformLocation(program_, "toClip");
        tint_ = glGetUniformLocation(program_, "tint");
        node_ = pipe.node;
        return {};
    }

    void draw(RenderTask& task) override {
        const Scene& scene = task.state<Scene>();
        if (scene.model.isNull()) return; // no frame of the application yet
        if (scene.model.id != shown_.id) change(task, scene.model);
        const Placement placement(scene.turn, scene.pitch, model_->centre, model_->radius);
        const Matrix4 toEye = task.toEye() * placement.toRoom;
        task.setNearFar(.1, 3 * kObjectDistance);
        task.apply();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glUseProgram(program_);
        glUniformMatrix4fv(toEye_, 1, GL_FALSE, glMatrix(toEye).data());
        glUniformMatrix4fv(toClip_, 1, GL_FALSE, glMatrix(task.projection() * toEye).data());
        glUniform3fv(tint_, 1, scene.colour.data());
        const std::vector<uint32_t> leaves = visibleLeaves(task, toEye);
        request(task, leaves);
        // The order of leaves decides between equal depths, also between nodes.
        for (const uint32_t leaf : leaves) {
            const LoadedLeaf& loaded = leafOf(task, leaf);
            glBindVertexArray(loaded.vertices);
            glDrawElements(GL_TRIANGLES, loaded.indices, GL_UNSIGNED_SHORT,
                           reinterpret_cast<void*>(loaded.indexOffset));
        }
        if (scene.reports) report();
    }

    std::vector<uint32_t> visibleLeaves(RenderTask& task, const Matrix4& toEye) {
        const Frustum frustum = task.cullFrustum();
        const auto vector = [](const Point& p) { return Vector3{p[0], p[1], p[2]}; };
        std::vector<uint32_t> leaves;
        model_->tree.visit(
            model_->tree.leavesOf(task.context().range),
            [&](const Box& box) { return isOutside(frustum, toEye, vector(box.lowest), vector(box.highest)); },
            [&](uint32_t leaf) {
                if (leaf < model_->leaves.size()) leaves.push_back(leaf);
            });
        return leaves;
    }

    // Requests all missing leaves at once, so that they arrive while the first ones are loaded.
    void request(RenderTask& task, const std::vector<uint32_t>& leaves) {
        std::vector<AnyRef> missing;
        for (const uint32_t leaf : leaves) {
            if (!loaded_.contains(leaf)) missing.push_back(model_->leaves[leaf]);
        }
        if (!missing.empty()) task.objects().prefetch(missing);
    }

    const LoadedLeaf& leafOf(RenderTask& task, uint32_t leaf) {
        const auto [entry, isNew] = loaded_.try_emplace(leaf);
        if (isNew) {
            const Result<Snapshot<Leaf>> object = task.objects().get(model_->leaves[leaf], Deadline::inMs(30'000));
            if (!object) {
                loaded_.erase(entry);
                throw std::runtime_error(object.error().message);
            }
            entry->second = load(object.value()->geometry.bytes());
            bytes_ += object.value()->geometry.sizeBytes();
        }
        return entry->second;
    }

    void change(RenderTask& task, const Ref<Model>& model) {
        Result<Snapshot<Model>> object = task.objects().get(model, Deadline::inMs(30'000));
        if (!object) throw std::runtime_error(object.error().message);
        for (const auto& [leaf, loaded] : loaded_) {
            glDeleteBuffers(1, &loaded.buffer);
            glDeleteVertexArrays(1, &loaded.vertices);
        }
        loaded_.clear();
        bytes_ = 0;
        model_ = std::move(*object);
        shown_ = model;
    }

    void report() {
        if (reported_ == loaded_.size()) return;
        reported_ = loaded_.size();
        std::fprintf(stderr, "ply: node %d holds %zu of %u leaves, %.1f MB\n", node_, loaded_.size(),
                     model_->tree.leaves(), static_cast<double>(bytes_) / 1e6);
    }

    unsigned program_ = 0;
    int toEye_ = -1, toClip_ = -1, tint_ = -1, node_ = 0;
    Ref<Model> shown_;
    Snapshot<Model> model_;
    std::map<uint32_t, LoadedLeaf> loaded_; // by leaf
    size_t bytes_ = 0, reported_ = 0;
};

} // namespace
} // namespace mural::examples

int main(int argc, char** argv) {
    return mural::run<mural::examples::Viewer, mural::examples::MeshRenderer>(argc, argv);
}
