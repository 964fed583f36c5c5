// mural-scenes: draws the scenes of `mural bench accuracy` frame by frame, independent of time.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/mural/accuracy/scenes/scene_window.hpp"
#include "tools/mural/accuracy/scenes/scene_names.hpp"
#include "tools/mural/accuracy/scenes/scenes.hpp"

namespace {

using mural::scenes::View;

struct Options {
    int width = 509, height = 383, frames = 6;
    int first = 0;    // number of the first frame
    int still = -1;   // all later frames show this one; -1: none does
    std::string save; // folder; empty: nothing is saved
    int scene = -1;   // a single scene; -1: all in sequence
    View view;
};

const char* const kUsage =
    "usage: mural-scenes [--size WxH] [--frames N] [--first FRAME] [--still FRAME] [--scene NAME] [--save FOLDER]\n"
    "                    [--move X,Y] [--eye E,FOCUS]\n";

bool take(const std::string& name, const char* value, Options& o) {
    if (name == "--size") return std::sscanf(value, "%dx%d", &o.width, &o.height) == 2 && o.width > 0 && o.height > 0;
    if (name == "--frames") return std::sscanf(value, "%d", &o.frames) == 1 && o.frames > 0;
    if (name == "--first") return std::sscanf(value, "%d", &o.first) == 1 && o.first >= 0;
    if (name == "--still") return std::sscanf(value, "%d", &o.still) == 1 && o.still >= 0;
    if (name == "--move") return std::sscanf(value, "%f,%f", &o.view.moveX, &o.view.moveY) == 2;
    if (name == "--scene") {
        const auto found = std::ranges::find(mural::scenes::kSceneNames, std::string(value));
        o.scene = static_cast<int>(found - mural::scenes::kSceneNames.begin());
        return found != mural::scenes::kSceneNames.end();
    }
    if (name == "--eye") return std::sscanf(value, "%f,%f", &o.view.eye, &o.view.focus) == 2;
    o.save = value;
    return name == "--save" && *value != '\0';
}

// Saves the window's back buffer as a PPM file, top row first.
void save(const Options& o, int frame) {
    std::vector<unsigned char> pixels(static_cast<size_t>(o.width) * static_cast<size_t>(o.height) * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, o.width, o.height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    char name[32];
    std::snprintf(name, sizeof name, "/frame-%06d.ppm", frame + 1);
    FILE* file = std::fopen((o.save + name).c_str(), "wb");
    if (file == nullptr) throw std::runtime_error("cannot write " + o.save + name);
    std::fprintf(file, "P6\n%d %d\n255\n", o.width, o.height);
    const size_t row = static_cast<size_t>(o.width) * 3;
    for (int y = o.height; y-- > 0;) std::fwrite(pixels.data() + static_cast<size_t>(y) * row, 1, row, file);
    if (std::fclose(file) != 0) throw std::runtime_error("cannot write " + o.save + name + ": check the free space");
}

int drawAll(const Options& o) {
    std::string why;
    const auto window = mural::scenes::SceneWindow::open(o.width, o.height, why);
    if (!window) throw std::runtime_error(why);
    std::printf("%s, %s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                reinterpret_cast<const char*>(glGetString(GL_VERSION)));
    const mural::scenes::Scenes scenes(o.width, o.height, o.view);
    for (int frame = 0; frame < o.frames; ++frame) {
        const int number = o.still < 0 ? o.first + frame : std::min(o.first + frame, o.still);
        scenes.draw(o.scene < 0 ? number : number * static_cast<int>(mural::scenes::kSceneNames.size()) + o.scene);
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            throw std::runtime_error("GL error " + std::to_string(error) + " in frame " + std::to_string(frame));
        if (!o.save.empty()) save(o, frame);
        window->show();
    }
    return 0;
}

} // namespace

int main(int count, char** arguments) {
    Options options;
    for (int i = 1; i < count; i += 2)
        if (i + 1 >= count || !take(arguments[i], arguments[i + 1], options)) {
            std::fprintf(stderr, "mural-scenes: unknown option %s, or its value is missing\n%s", arguments[i], kUsage);
            return 2;
        }
    try {
        return drawAll(options);
    } catch (const std::runtime_error& error) {
        std::fprintf(stderr, "mural-scenes: %s\n", error.what());
        return 1;
    }
}
