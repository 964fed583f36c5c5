// Draws a picture 1:1 into the current window with OpenGL 3.0: uploaded as a texture and copied
// with glBlitFramebuffer, which no state (blending, dithering, filtering, a rasterised edge) can
// change. All calls with the window's context current, the destructor included.
#pragma once

#include <memory>
#include <string>

#include "common/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

class TextureBlit {
public:
    // `load` gives the address of a GL function by its name, null when it is not known.
    using Loader = void (*(*)(const char* name))();
    static Result<std::unique_ptr<TextureBlit>> create(Loader load);
    TextureBlit(const TextureBlit&) = delete;
    TextureBlit& operator=(const TextureBlit&) = delete;
    ~TextureBlit();

    // Keeps the picture in the texture.
    Result<void> upload(const Picture& picture);

    enum class Target { Back, BackLeft, BackRight };
    // Copies it to that buffer of the window, upper left corners together, black around it.
    Result<void> draw(Target target, int framebufferWidth, int framebufferHeight);
    // The window has a back buffer for each eye.
    [[nodiscard]] bool stereo() const;

    void finish(); // waits for the GPU
    [[nodiscard]] const std::string& renderer() const { return renderer_; }

private:
    struct Functions;

    TextureBlit();
    Result<void> allocate(int width, int height);

    std::unique_ptr<Functions> gl_;
    std::string renderer_;
    unsigned texture_ = 0;
    unsigned framebuffer_ = 0;
    int width_ = 0; // of the texture
    int height_ = 0;
};

} // namespace mural
