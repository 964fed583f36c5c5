// The scenes: one per feature that a decomposition may get wrong. A frame depends on its number only.
#pragma once

#include <vector>

namespace mural::scenes {

// Transformations of Mural's passes, done by the program itself as their reference.
struct View {
    float moveX = 0, moveY = 0; // of the viewport, in pixels
    float eye = 0;              // to the right of the centre, in scene units
    float focus = 6;            // distance at which all eyes converge
};

class Scenes {
public:
    // Requires a current context. Throws std::runtime_error, with one line, if a feature is missing.
    Scenes(int width, int height, const View& view);
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
    View view_;
    unsigned program_ = 0, texture_ = 0;
    std::vector<float> soup_; // triangle soup: x, y, z, r, g, b per corner
};

} // namespace mural::scenes
