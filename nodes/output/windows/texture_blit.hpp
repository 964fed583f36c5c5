// Draws a picture 1:1 into the current window with OpenGL 3.0: a texture upload and glBlitFramebuffer, which blending,
// dithering, filtering and rasterisation do not affect. All calls, including the destructor, need the window's context
// current.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

class TextureBlit {
public:
    // `load` returns the address of a GL function, or null.
    using Loader = void (*(*)(const char* name))();
    static Result<std::unique_ptr<TextureBlit>> create(Loader load);
    TextureBlit(const TextureBlit&) = delete;
    TextureBlit& operator=(const TextureBlit&) = delete;
    ~TextureBlit();

    // Stores the picture in the texture.
    Result<void> upload(const Picture& picture);

    enum class Target { Back, BackLeft, BackRight };
    // Copies it to the target buffer of the window, aligned at the upper left corner, with black around it.
    Result<void> draw(Target target, int framebufferWidth, int framebufferHeight);
    // True if the window has a back buffer per eye.
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
