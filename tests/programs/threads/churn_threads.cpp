// Windows and contexts created and destroyed in arbitrary order. Another thread takes each step: it opens a window
// whose context may share with another's, draws into a window of any thread, or closes one.
#include "tests/programs/support/gl.hpp"
#include "tests/programs/support/program.hpp"
#include "tests/programs/support/show.hpp"

#include <thread>
#include <vector>

using namespace programs;

namespace {

constexpr std::size_t kMax = 5;

struct Place {
    std::unique_ptr<Window> window;
    int group;      // windows with the same number share
    GLuint texture; // shared by the group
};
std::vector<Place> places;
int lastGroup = 0;

void makeTexture(Place& place, unsigned seed) {
    GLubyte texels[4 * 4 * 3];
    Sequence numbers(seed);
    for (GLubyte& value : texels) {
        value = numbers.byte();
    }
    glGenTextures(1, &place.texture);
    glBindTexture(GL_TEXTURE_2D, place.texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 4, 4, 0, GL_RGB, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void open(const Options& options, unsigned seed) {
    Place made = {nullptr, 0, 0};
    const Place* share = seed % 3 == 0 || places.empty() ? nullptr : &places[seed % places.size()];
    WindowSpec spec;
    spec.x = int(places.size()) * 30;
    made.window = openGlxWindow(spec, options.width - int(seed % 50), options.height - int(seed % 30),
                                share == nullptr ? nullptr : share->window.get());
    made.window->makeCurrent();
    if (share != nullptr) {
        made.group = share->group;
        made.texture = share->texture;
    } else {
        made.group = ++lastGroup;
        makeTexture(made, seed);
    }
    made.window->release();
    places.push_back(std::move(made));
}

void draw(Place& place, unsigned seed) {
    Sequence numbers(seed);
    place.window->makeCurrent();
    glClearColor(numbers.unit(), 0.2F, numbers.unit(), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBindTexture(GL_TEXTURE_2D, place.texture);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex2f(-0.8F, -0.7F);
    glTexCoord2f(1, 0), glVertex2f(0.7F, -numbers.unit());
    glTexCoord2f(1, 1), glVertex2f(0.8F, numbers.unit());
    glTexCoord2f(0, 1), glVertex2f(-0.6F, 0.8F);
    glEnd();
    checkNoError("in a window of another thread");
    place.window->swap();
    place.window->release();
}

void step(const Options& options, unsigned seed) {
    const unsigned action = seed % 5;
    if (places.empty() || (action == 0 && places.size() < kMax)) {
        open(options, seed / 5);
    } else if (action == 1 && places.size() > 1) {
        places.erase(places.begin() + long(seed / 5 % places.size()));
    } else {
        draw(places[seed / 5 % places.size()], seed);
    }
}

} // namespace

int main(int argc, char** argv) {
    const Options options = parseOptions(argc, argv);
    Sequence numbers(11);
    for (int i = 0; i < options.frames * 12; ++i) {
        std::thread(step, std::cref(options), numbers.next()).join();
    }
    return 0;
}
