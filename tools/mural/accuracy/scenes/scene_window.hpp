// A double-buffered window with a compatibility context that stays current.
#pragma once

#include <memory>
#include <string>

namespace mural::scenes {

class SceneWindow {
public:
    // Null when it can't be had; then `why` says it.
    static std::unique_ptr<SceneWindow> open(int width, int height, std::string& why);
    SceneWindow(const SceneWindow&) = delete;
    SceneWindow& operator=(const SceneWindow&) = delete;
    ~SceneWindow();

    void show();

private:
    SceneWindow();
    struct Handles; // of X: its headers define too many names
    std::unique_ptr<Handles> x_;
};

} // namespace mural::scenes
