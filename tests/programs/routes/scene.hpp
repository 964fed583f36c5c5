// One small scene, drawn through functions that each program finds in its own way, without a linked GL library. It uses
// old and new commands, which reveals a route that captures only some of them.
#pragma once

namespace programs {

using GlFunction = void (*)();
using FindFunction = GlFunction (*)(const char* name);

class Scene {
public:
    explicit Scene(FindFunction find); // requires a current context
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene();
    void draw(int frame, int width, int height); // ends the program when GL reports an error

private:
    struct Functions;
    Functions* gl_;
    unsigned program_ = 0, buffer_ = 0, texture_ = 0;
    void makeObjects();
};

} // namespace programs
