// A double-buffered window with a current compatibility context.
#pragma once

#include <memory>
#include <string>

namespace mural::scenes {

class SceneWindow {
public:
    // Returns null on failure, with the reason in `why`.
    static std::unique_ptr<SceneWindow> open(int width, int height, std::string& why);
    SceneWindow(const SceneWindow&) = delete;
    SceneWindow& operator=(const SceneWindow&) = delete;
    ~SceneWindow();

    void show();

private:
    SceneWindow();
    struct Handles; // X handles; its headers define too many names
    std::unique_ptr<Handles> x_;
};

} // namespace mural::scenes
