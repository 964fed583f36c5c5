// What is drawn: one scene for each kind of thing that a decomposition may get wrong. A frame depends on its number alone.
#pragma once

#include <vector>

namespace mural::scenes {

// What Mural's passes do to a program that knows nothing of them, done by the program itself: the reference for those.
struct Look {
    float moveX = 0, moveY = 0; // of the viewport, pixels
    float eye = 0;              // to the right of the middle, units of the scene
    float focus = 6;            // distance at which all eyes see the same
};

class Scenes {
public:
    // A context is current. Throws std::runtime_error, with one line, where it lacks something.
    Scenes(int width, int height, const Look& look);
    void draw(int frame) const;

private:
    void useViewport() const;
    void usePerspective(double nearPlane, double farPlane, int round) const;
    void drawTriangles(int round) const;
    void drawLighting(int round) const;
    void drawTextures(int round) const;
    void drawLines(int round) const;
    void drawBlending(int round) const;
    void drawDepths(int round) const;

    int width_, height_;
    Look look_;
    unsigned program_ = 0, texture_ = 0;
    std::vector<float> soup_; // triangles: x, y, z, r, g, b for each corner
};

} // namespace mural::scenes
