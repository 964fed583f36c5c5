// A viewer of volumes by ray casting. A node draws the slab of its range, and loads only the slices of that slab. Mural
// blends the slabs in the order of their distances from the eye.
//
// A ray takes its samples at multiples of the step from the eye, so slabs have the samples of the whole volume: each
// sample belongs to exactly one slab.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <mural/mural.hpp>

#include "examples/base/arguments.hpp"
#include "examples/base/turning.hpp"
#include "examples/volume/model.hpp"
#include "examples/volume/slabs.hpp"

namespace mural::examples {
namespace {

constexpr const char* kHelp = R"(Shows a volume: NIfTI-1, NRRD or INR, also compressed with gzip.

  volume [OPTIONS] FILE
  --transfer FUNCTION   grey, brain, bone, labels, or points VALUE:RRGGBB:OPACITY from 0 to 1, separated by commas
  --window LOW,HIGH     values that become 0 and 1; others are clamped (default: those of the file)
  --bits 8|16           bits per voxel (default: as the file needs)
  --step S              distance of samples in voxels (default 1)
  --raw SIZE            the file has no header: 256x256x108 or 256x256x108:int16
  --frames N            ends after N frames
  --turn-per-frame DEG  turns by a fixed angle per frame, for reproducible pictures
  --turn-per-second DEG turns by time (default 20)
  --pitch DEG           tilts the volume towards the viewer (default -90: the third axis of the file points up)
  --report              nodes print how many slices of the volume they hold

Examples:
  tools/example-data brain cranium
  mural run -- ./volume --transfer brain build/example-data/ch2.nii.gz
  mural run --tiles 2x2 -- ./volume --window -200,1500 --transfer bone build/example-data/cranium.nrrd
  mural run --db 4 -- ./volume --transfer 0.3:000000:0,0.5:ff8040:0.1,1:ffffff:0.5 build/example-data/ch2.nii.gz
)";

constexpr uint32_t kSlicesPerBrick = 8;

struct Options {
    std::string file;
    uint64_t frames = 0; // 0: no end
    std::optional<double> turnPerFrame;
    double turnPerSecond = 20, pitch = -90, step = 1;
    VolumeWish wish;
    std::optional<RawForm> raw;
    TransferFunction transfer;
    bool reports = false;
};

Result<void> parseVoxelOptions(Arguments& arguments, Options& options) {
    options.wish.bits = static_cast<uint32_t>(arguments.takeNumber("--bits", 0, 8, 16));
    if (options.wish.bits % 8 != 0) return Error{"--bits needs 8 or 16"};
    if (const auto text = arguments.takeText("--window")) {
        std::array<double, 2> window{};
        char rest = 0;
        if (std::sscanf(text->c_str(), "%lf,%lf%c", &window[0], &window[1], &rest) != 2 || !(window[0] < window[1]))
            return Error{"--window needs two increasing numbers such as -200,1500, not \"" + *text + "\""};
        options.wish.window = window;
    }
    if (const auto text = arguments.takeText("--raw")) {
        const Result<RawForm> form = parseRawForm(*text);
        if (!form) return Error{"--raw: " + form.error().message};
        options.raw = form.value();
    }
    const Result<TransferFunction> transfer = parseTransferFunction(arguments.takeText("--transfer").value_or("grey"));
    if (!transfer) return Error{"--transfer: " + transfer.error().message};
    options.transfer = transfer.value();
    return {};
}

Result<Options> parseOptions(int argc, char** argv) {
    Arguments arguments(argc, argv);
    Options options;
    options.frames = static_cast<uint64_t>(arguments.takeNumber("--frames", 0, 1, 1e9));
    const double none = 1e9;
    const double perFrame = arguments.takeNumber("--turn-per-frame", none, -360, 360);
    if (perFrame != none) options.turnPerFrame = perFrame;
    options.turnPerSecond = arguments.takeNumber("--turn-per-second", options.turnPerSecond, -3600, 3600);
    options.pitch = arguments.takeNumber("--pitch", options.pitch, -180, 180);
    options.step = arguments.takeNumber("--step", options.step, .1, 10);
    options.reports = arguments.takeFlag("--report");
    if (const auto parsed = parseVoxelOptions(arguments, options); !parsed) return parsed.error();
    Result<std::vector<std::string>> files = arguments.finish();
    if (!files) return files.error();
    if (files->size() != 1) return Error{"one file is needed; --help shows examples"};
    options.file = files->front();
    return options;
}

// The application: reads the volume, publishes its bricks, and turns it.
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
        Result<Volume> volume = options_.raw ? readRawVolume(options_.file, *options_.raw, options_.wish)
                                             : readVolume(options_.file, options_.wish);
        if (!volume) return volume.error();
        return publish(session, sliceAlongLongestAxis(std::move(*volume)));
    }

    Next update(Session& session, const FrameClock& clock) override {
        if (options_.frames > 0 && clock.frame > options_.frames) return Next::End;
        Scene& scene = session.state<Scene>();
        scene.turn = options_.turnPerFrame ? *options_.turnPerFrame * static_cast<double>(clock.frame - 1)
                                           : options_.turnPerSecond * clock.seconds;
        return Next::Frame;
    }

    Result<void> publish(Session& session, const SlicedVolume& sliced) {
        Model model{sliced.volume.size,          sliced.volume.spacing, sliced.axes,
                    sliced.volume.bytesPerVoxel, kSlicesPerBrick,       {}};
        ShareOptions options;
        options.sharing = Sharing::Static;
        options.delivery = Delivery::OnDemand;
        for (uint32_t first = 0; first < sliced.slices(); first += kSlicesPerBrick) {
            const uint32_t end = std::min(first + kSlicesPerBrick, sliced.slices());
            Result<Blob> voxels = Blob::copyOf(sliced.slicesOf(first, end));
            if (!voxels) return voxels.error();
            Result<Shared<Brick>> shared = session.share(Brick{*voxels}, options);
            if (!shared) return shared.error();
            if (const auto committed = shared->commit(); !committed) return committed.error();
            model.bricks.push_back(shared->ref());
            bricks_.push_back(std::move(*shared));
        }
        options.delivery = Delivery::Push;
        Result<Shared<Model>> shared = session.share(std::move(model), options);
        if (!shared) return shared.error();
        if (const auto committed = shared->commit(); !committed) return committed.error();
        model_.emplace(std::move(*shared));
        session.state<Scene>() = {model_->ref(), 0, options_.pitch, options_.step, options_.transfer, options_.reports};
        return {};
    }

    Options options_;
    std::vector<Shared<Brick>> bricks_; // an object ends with its Shared
    std::optional<Shared<Model>> model_;
};

// The back faces of the slab's box. They are one voxel larger on all sides, because the fragment shader decides where
// the slab begins and ends; edges of the box must not cut rays off.
constexpr const char* kVertexShader = R"(#version 330 core
uniform mat4 toClip;
uniform vec3 lowest;
uniform vec3 highest;
const int kCorners[36] = int[36](0,4,6, 0,6,2, 1,3,7, 1,7,5, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,2,3, 0,3,1, 4,5,7, 4,7,6);
void main() {
    int corner = kCorners[gl_VertexID];
    vec3 side = vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    gl_Position = toClip * vec4(mix(lowest - 1., highest + 1., side), 1);
})";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform vec4 viewport;     // of the whole picture, in pixels
uniform vec4 fromClip;     // scale and offset from clip coordinates to the plane at distance 1
uniform mat4 eyeToVoxels;
uniform vec3 lowest;       // of the slab, in voxels
uniform vec3 highest;
uniform vec3 stored;       // first stored slice, 1 / stored slices, 0
uniform vec3 voxelSize;    // in units of the room
uniform vec3 perVoxel;     // texture coordinates
uniform float stepSize;    // in units of the room
uniform sampler3D voxels;
uniform sampler2D transfer; // with the opacity of one step
out vec4 pixel;

float valueAt(vec3 p) { return texture(voxels, vec3(p.xy * perVoxel.xy, (p.z - stored.x) * stored.y)).r; }

// Half a voxel in each direction stays within one stored slice beyond the slab.
vec3 gradientAt(vec3 p) {
    vec3 low = vec3(valueAt(p - vec3(.5, 0, 0)), valueAt(p - vec3(0, .5, 0)), valueAt(p - vec3(0, 0, .5)));
    vec3 high = vec3(valueAt(p + vec3(.5, 0, 0)), valueAt(p + vec3(0, .5, 0)), valueAt(p + vec3(0, 0, .5)));
    return (high - low) / voxelSize;
}

void main() {
    vec2 place = (gl_FragCoord.xy - viewport.xy) / viewport.zw * 2. - 1.;
    vec3 ray = normalize(vec3(place * fromClip.xy + fromClip.zw, -1));
    vec3 origin = eyeToVoxels[3].xyz;
    vec3 direction = mat3(eyeToVoxels) * ray;
    direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 a = (lowest - origin) / direction, b = (highest - origin) / direction;
    vec3 near = min(a, b), far = max(a, b);
    float first = ceil(max(max(near.x, near.y), max(near.z, 0.)) / stepSize);
    float end = ceil(min(min(far.x, far.y), far.z) / stepSize);
    // The surface normal faces the eye, in coordinates of the voxels scaled to the room.
    vec3 toLight = -normalize(direction * voxelSize);
    vec4 sum = vec4(0);
    for (float k = first; k < end; k += 1.) {
        vec3 p = origin + k * stepSize * direction;
        vec4 colour = texture(transfer, vec2(valueAt(p) * (255. / 256.) + .5 / 256., .5));
        if (colour.a == 0.) continue;
        vec3 gradient = gradientAt(p);
        float size = length(gradient * voxelSize);
        float light = size > .01 ? .3 + .7 * abs(dot(normalize(gradient), toLight)) : .8;
        sum += (1. - sum.a) * colour.a * vec4(colour.rgb * light, 1);
    }
    if (sum.a == 0.) discard;
    pixel = sum;
})";

// The render node: draws the slab of its range.
class VolumeRenderer : public Renderer {
    Result<void> start(Pipe& pipe) override {
        Result<unsigned> program = linkProgram(kVertexShader, kFragmentShader);
        if (!program) return program.error();
        program_ = *program;
        node_ = pipe.node;
        glGenVertexArrays(1, &vertices_);
        glGenTextures(1, &transfer_);
        return {};
    }

    // Colours of slabs are blended before they are rounded to 8 bits.
    GlWish wish() const override {
        GlWish wish;
        wish.isHalfFloat = true;
        return wish;
    }

    Composition composition() const override {
        Composition composition;
        composition.by = Composition::By::Over;
        return composition;
    }

    double order(RenderTask& task, const Range& range) const override {
        const Scene& scene = task.state<Scene>();
        const Result<Snapshot<Model>> model = task.objects().get(scene.model);
        if (!model) return range.start;
        const Slab slab = slabOf(range, model.value()->size[2]);
        const Vector3 eye = transformPoint(eyeToVoxels(task, scene, *model.value()), {0, 0, 0});
        return distanceOfSlab(eye.z, slab.first, slab.end);
    }

    void draw(RenderTask& task) override {
        const Scene& scene = task.state<Scene>();
        if (scene.model.isNull()) return; // no frame of the application yet
        Result<Snapshot<Model>> model = task.objects().get(scene.model, Deadline::inMs(30'000));
        if (!model) throw std::runtime_error(model.error().message);
        const Slab slab = slabOf(task.context().range, (*model)->size[2]);
        if (slab.empty()) return;
        load(task, scene.model, **model, slab);
        loadTransfer(scene);
        task.setNearFar(.1, 3 * kObjectDistance);
        task.apply();
        setUniforms(task, scene, **model, slab);
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
        // An exchange of two axes turns the order of corners around.
        glFrontFace((*model)->axes[2] == 2 ? GL_CCW : GL_CW);
        glBindVertexArray(vertices_);
        glDrawArrays(GL_TRIANGLES, 0, 36);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        if (scene.reports) report((*model)->size[2]);
    }

    // The room size of voxels, and the placement of the volume.
    static Vector3 roomSize(const Model& model) {
        double square = 0;
        for (size_t k = 0; k < 3; ++k) square += std::pow(model.size[k] * model.spacing[k] / 2, 2);
        const double scale = kObjectRadius / std::sqrt(square);
        return {model.spacing[0] * scale, model.spacing[1] * scale, model.spacing[2] * scale};
    }
    static Matrix4 axesToFile(const Model& model) {
        Matrix4 matrix;
        matrix.m = {};
        for (size_t k = 0; k < 3; ++k) matrix.m[model.axes[k] % 3][k] = 1;
        matrix.m[3][3] = 1;
        return matrix;
    }
    static Matrix4 voxelsToEye(RenderTask& task, const Scene& scene, const Model& model) {
        const Vector3 size = roomSize(model);
        const Matrix4 centred = Matrix4::translation({model.size[0] * -.5, model.size[1] * -.5, model.size[2] * -.5});
        return task.toEye() * Placement(scene.turn, scene.pitch, {}, 1).toRoom * axesToFile(model) *
               scaling(size.x, size.y, size.z) * centred;
    }
    static Matrix4 eyeToVoxels(RenderTask& task, const Scene& scene, const Model& model) {
        const Vector3 size = roomSize(model);
        const Matrix4 centred = Matrix4::translation({model.size[0] * .5, model.size[1] * .5, model.size[2] * .5});
        return centred * scaling(1 / size.x, 1 / size.y, 1 / size.z) * axesToFile(model) *
               Placement(scene.turn, scene.pitch, {}, 1).fromRoom * rigidInverse(task.toEye());
    }

    void setUniforms(RenderTask& task, const Scene& scene, const Model& model, const Slab& slab) {
        const auto at = [this](const char* name) { return glGetUniformLocation(program_, name); };
        const auto set = [&](const char* name, double x, double y, double z) {
            glUniform3f(at(name), static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        };
        const Matrix4 projection = task.projection();
        const auto& p = projection.m;
        std::array<int, 4> viewport{};
        glGetIntegerv(GL_VIEWPORT, viewport.data());
        glUseProgram(program_);
        glUniform4f(at("viewport"), static_cast<float>(viewport[0]), static_cast<float>(viewport[1]),
                    static_cast<float>(viewport[2]), static_cast<float>(viewport[3]));
        glUniform4f(at("fromClip"), static_cast<float>(1 / p[0][0]), static_cast<float>(1 / p[1][1]),
                    static_cast<float>(p[0][2] / p[0][0]), static_cast<float>(p[1][2] / p[1][1]));
        glUniformMatrix4fv(at("eyeToVoxels"), 1, GL_FALSE, glMatrix(eyeToVoxels(task, scene, model)).data());
        glUniformMatrix4fv(at("toClip"), 1, GL_FALSE, glMatrix(projection * voxelsToEye(task, scene, model)).data());
        set("lowest", 0, 0, slab.first);
        set("highest", model.size[0], model.size[1], slab.end);
        set("stored", storedFirst_, 1. / (storedEnd_ - storedFirst_), 0);
        const Vector3 size = roomSize(model);
        set("voxelSize", size.x, size.y, size.z);
        set("perVoxel", 1. / model.size[0], 1. / model.size[1], 0);
        glUniform1f(at("stepSize"), static_cast<float>(scene.step * std::min({size.x, size.y, size.z})));
        glUniform1i(at("voxels"), 0);
        glUniform1i(at("transfer"), 1);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, transfer_);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_3D, voxels_);
    }

    // Loads the stored slices of the slab, in addition to those that are loaded. Slabs move when the load changes;
    // slices that were needed once may be needed again.
    void load(RenderTask& task, const Ref<Model>& ref, const Model& model, const Slab& slab) {
        uint32_t first = slab.storedFirst, end = slab.storedEnd;
        if (ref.id == shown_.id) {
            if (storedFirst_ <= first && end <= storedEnd_) return;
            first = std::min(first, storedFirst_);
            end = std::max(end, storedEnd_);
        }
        const uint32_t step = std::max(model.slicesPerBrick, 1u);
        const size_t firstBrick = first / step;
        const size_t endBrick = std::min<size_t>((end + step - 1) / step, model.bricks.size());
        const std::vector<AnyRef> wanted(model.bricks.begin() + static_cast<std::ptrdiff_t>(firstBrick),
                                         model.bricks.begin() + static_cast<std::ptrdiff_t>(endBrick));
        task.objects().prefetch(wanted);
        createTexture(model, end - first);
        for (size_t brick = firstBrick; brick < endBrick; ++brick) {
            const Result<Snapshot<Brick>> object = task.objects().get(model.bricks[brick], Deadline::inMs(30'000));
            if (!object) throw std::runtime_error(object.error().message);
            const auto begin = static_cast<uint32_t>(brick) * step;
            upload(model, object.value()->voxels.bytes(), begin, std::max(first, begin), std::min(end, begin + step),
                   first);
        }
        storedFirst_ = first;
        storedEnd_ = end;
        shown_ = ref;
    }

    void createTexture(const Model& model, uint32_t slices) {
        int most = 0;
        glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
        const uint32_t largest = std::max({model.size[0], model.size[1], slices});
        if (largest > static_cast<uint32_t>(most))
            throw std::runtime_error("the volume has " + std::to_string(largest) +
                                     " voxels along an axis; this GL has at most " + std::to_string(most));
        shown_ = {}; // until all slices are loaded
        glDeleteTextures(1, &voxels_);
        glGenTextures(1, &voxels_);
        glBindTexture(GL_TEXTURE_3D, voxels_);
        for (const unsigned filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
        for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
        glTexImage3D(GL_TEXTURE_3D, 0, model.bytesPerVoxel == 1 ? GL_R8 : GL_R16, static_cast<int>(model.size[0]),
                     static_cast<int>(model.size[1]), static_cast<int>(slices), 0, GL_RED, typeOf(model), nullptr);
    }

    // Uploads the slices [from, to) of a brick that begins with slice `begin`.
    static void upload(const Model& model, std::span<const std::byte> voxels, uint32_t begin, uint32_t from,
                       uint32_t to, uint32_t storedFirst) {
        const size_t sliceBytes = size_t{model.size[0]} * model.size[1] * model.bytesPerVoxel;
        if (voxels.size() < (to - begin) * sliceBytes) throw std::runtime_error("a brick of the volume is too short");
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, static_cast<int>(from - storedFirst), static_cast<int>(model.size[0]),
                        static_cast<int>(model.size[1]), static_cast<int>(to - from), GL_RED, typeOf(model),
                        voxels.data() + (from - begin) * sliceBytes);
    }
    static unsigned typeOf(const Model& model) {
        return model.bytesPerVoxel == 1 ? GL_UNSIGNED_BYTE : GL_UNSIGNED_SHORT;
    }

    // The table with the opacity of one step. Floats keep small opacities apart.
    void loadTransfer(const Scene& scene) {
        if (scene.transfer == loadedTransfer_ && scene.step == loadedStep_) return;
        const TransferTable table = scene.transfer.table();
        std::vector<float> entries(table.size());
        for (size_t at = 0; at < table.size(); ++at) {
            const double value = table[at] / 255.;
            entries[at] = static_cast<float>(at % 4 == 3 ? 1 - std::pow(1 - value, scene.step) : value);
        }
        glBindTexture(GL_TEXTURE_2D, transfer_);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kTransferEntries, 1, 0, GL_RGBA, GL_FLOAT, entries.data());
        loadedTransfer_ = scene.transfer;
        loadedStep_ = scene.step;
    }

    void report(uint32_t slices) {
        if (reported_ == storedEnd_ - storedFirst_) return;
        reported_ = storedEnd_ - storedFirst_;
        std::fprintf(stderr, "volume: node %d holds %u of %u slices\n", node_, reported_, slices);
    }

    unsigned program_ = 0, vertices_ = 0, transfer_ = 0, voxels_ = 0;
    int node_ = 0;
    Ref<Model> shown_;
    uint32_t storedFirst_ = 0, storedEnd_ = 0, reported_ = 0;
    TransferFunction loadedTransfer_;
    double loadedStep_ = 0;
};

} // namespace
} // namespace mural::examples

int main(int argc, char** argv) {
    return mural::run<mural::examples::Viewer, mural::examples::VolumeRenderer>(argc, argv);
}
