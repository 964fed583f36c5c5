// One small scene, drawn through functions that each program finds in its own way: no GL library is
// linked for it. Old and new commands, so that a route that catches only some of them shows.
#pragma once

namespace programs {

using GlFunction = void (*)();
using FindFunction = GlFunction (*)(const char* name);

class Scene {
public:
    explicit Scene(FindFunction find); // with a current context
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene();
    void draw(int frame, int width, int height); // fails loudly when GL reports an error

private:
    struct Functions;
    Functions* gl_;
    unsigned program_ = 0, buffer_ = 0, texture_ = 0;
    void makeObjects();
};

} // namespace programs
