// GL's writes to client memory, compared with layoutOf, spanBytes and unpackTight. Nothing outside the pixels changes,
// and the bytes are the tight image laid out under the pack state.
#include "tests/streamcodec/sizes_gl_context.hpp"

#include <cstring>
#include <functional>

#include "streamcodec/sizes/gl_enums.hpp"
#include "tests/streamcodec/sizes_guarded_memory.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

using Read = std::function<void(void* pixels)>;

struct Image {
    GLenum format, type;
    int width, height, depth, dims;
};

class Checker {
public:
    explicit Checker(TestApi api) : api_(api) {}
    Random& random() { return random_; }

    void check(const Image& image, const Read& read) { check(image, randomStore(image), read); }

    void check(const Image& image, const PixelStore& store, const Read& read) {
        char text[128];
        std::snprintf(text, sizeof text, "seed %u format %#x type %#x %dx%dx%d ", seed_, image.format, image.type,
                      image.width, image.height, image.depth);
        SCOPED_TRACE(text + describe(store));
        const ImageLayout layout =
            layoutOf(store, image.format, image.type, image.width, image.height, image.depth, image.dims);
        ASSERT_TRUE(layout.known);
        const size_t span = spanBytes(layout);
        ASSERT_LE(span, memory_.size());

        std::vector<uint8_t> tight(tightBytes(layout));
        setPixelStore(Direction::Pack, tightStore(), api_);
        read(tight.data());
        std::vector<uint8_t> expected = random_.bytes(span);
        const std::vector<uint8_t> background = expected;
        unpackTight(expected.data(), tight.data(), layout);

        setPixelStore(Direction::Pack, store, api_);
        uint8_t* pointer = memory_.end() - span;
        std::memcpy(pointer, background.data(), span);
        memory_.close();
        read(pointer);
        EXPECT_FALSE(memory_.touched()) << "GL writes behind spanBytes";
        EXPECT_EQ(std::vector<uint8_t>(pointer, memory_.end()), expected);

        memory_.close();
        read(memory_.begin() - firstPixel(layout));
        EXPECT_FALSE(memory_.touched()) << "GL writes before the first pixel";
        memory_.close();
        read(pointer + 1);
        EXPECT_TRUE(memory_.touched()) << "GL does not write the last byte of spanBytes";
        EXPECT_FALSE(takeErrors());
    }

private:
    PixelStore randomStore(const Image& image) {
        PixelStore store = random_.store(image.width, image.height);
        // Mesa swaps depth through floats, which loses bits of 32-bit integers.
        if (image.format == GL_DEPTH_COMPONENT || image.format == GL_DEPTH_STENCIL) store.swapBytes = false;
        // Mesa clears the bits before the first pixel; the specification preserves them.
        if (image.type == GL_BITMAP) store.skipPixels &= ~7;
        if (api_ != TestApi::Compatibility) {
            store.swapBytes = store.lsbFirst = false;
            store.imageHeight = store.skipImages = 0;
        } else {
            store.invert = image.type != GL_BITMAP && random_.oneIn(4); // Mesa does not invert stipples
            if (store.invert) store.skipRows = 0;                       // see placesInvertedRowsAboveTheSkippedOnes
        }
        return store;
    }

    static size_t firstPixel(const ImageLayout& layout) {
        return static_cast<size_t>(layout.rowOffset(layout.rowStride < 0 ? layout.rows - 1 : 0, 0));
    }

    TestApi api_;
    uint32_t seed_ = std::random_device{}();
    Random random_{seed_};
    GuardedMemory memory_{size_t{1} << 19};
};

struct Source {
    GLenum internalformat, format, type;
};
constexpr Source kSources[] = {
    {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_RGBA32F, GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
    {GL_RGBA16I, GL_RGBA_INTEGER, GL_SHORT},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT},
    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8},
};

bool isDepth(GLenum format) {
    return format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL || format == GL_STENCIL_INDEX;
}

// Mesa 22.3 calls a null pointer for some pairs that it should reject. It accepts GL_BITMAP and colour indices but
// writes nothing, and writes integer luminance only partly.
bool isReadable(const Source& source, GLenum format) {
    if (format == GL_STENCIL_INDEX && source.format == GL_DEPTH_COMPONENT) return false;
    return isDepth(source.format) == isDepth(format) && format != GL_COLOR_INDEX && format != GL_YCBCR_MESA &&
           format != GL_LUMINANCE_INTEGER_EXT && format != GL_LUMINANCE_ALPHA_INTEGER_EXT;
}

int checkReadPixels(Checker& checker, TestApi api) {
    int pairs = 0;
    std::vector<uint8_t> pixel(64);
    for (const Source& source : kSources) {
        const TestFramebuffer framebuffer(source.internalformat, source.format, source.type);
        if (!framebuffer.complete()) continue;
        for (GLenum format : knownFormats())
            for (GLenum type : knownTypes()) {
                if (!isReadable(source, format) || type == GL_BITMAP) continue;
                setPixelStore(Direction::Pack, tightStore(), api);
                glReadPixels(0, 0, 1, 1, format, type, pixel.data());
                if (takeErrors()) continue;
                ++pairs;
                for (int round = 0; round < 3; ++round) {
                    const Image image{format, type, checker.random().between(1, 29), checker.random().between(1, 9),
                                      1,      2};
                    const Read read = [&](void* pixels) {
                        glReadPixels(1, 2, image.width, image.height, format, type, pixels);
                    };
                    // Mesa 22.3 writes luminance as one row of all pixels, ignoring the state.
                    if (format == GL_LUMINANCE || format == GL_LUMINANCE_ALPHA)
                        checker.check(image, tightStore(), read);
                    else
                        checker.check(image, read);
                }
                if (testing::Test::HasFailure()) return pairs;
            }
    }
    return pairs;
}

TEST(SizesImageReadGl, matchesReadPixels) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    Checker checker(TestApi::Compatibility);
    const int pairs = checkReadPixels(checker, TestApi::Compatibility);
    std::printf("%d pairs of format and type\n", pairs);
    EXPECT_GE(pairs, 100);
}

TEST(SizesImageReadGl, matchesReadPixelsOfOpenGlEs3) {
    const TestContext context(TestApi::Es3);
    if (!context.valid()) GTEST_SKIP() << "no OpenGL ES 3 over EGL surfaceless here";
    Checker checker(TestApi::Es3);
    const int pairs = checkReadPixels(checker, TestApi::Es3);
    std::printf("%d pairs of format and type\n", pairs);
    EXPECT_GE(pairs, 5);
}

// Images of 1, 2 and 3 dimensions with random content.
class Texture {
public:
    Texture(const Source& source, const Image& image, Random& random) : target_(targetOf(image.dims)) {
        glGenTextures(1, &name_);
        glBindTexture(target_, name_);
        setPixelStore(Direction::Unpack, tightStore(), TestApi::Compatibility);
        const auto internal = static_cast<GLint>(source.internalformat);
        const std::vector<uint8_t> bytes =
            random.bytes(tightBytes(source.format, source.type, image.width, image.height, image.depth));
        if (image.dims == 1)
            glTexImage1D(target_, 0, internal, image.width, 0, source.format, source.type, bytes.data());
        if (image.dims == 2)
            glTexImage2D(target_, 0, internal, image.width, image.height, 0, source.format, source.type, bytes.data());
        if (image.dims == 3)
            glTexImage3D(target_, 0, internal, image.width, image.height, image.depth, 0, source.format, source.type,
                         bytes.data());
    }
    ~Texture() { glDeleteTextures(1, &name_); }
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    [[nodiscard]] GLenum target() const { return target_; }

private:
    static GLenum targetOf(int dims) {
        return dims == 1 ? GL_TEXTURE_1D : dims == 2 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
    }
    GLenum target_;
    GLuint name_ = 0;
};

void checkGetTexImage(Checker& checker, const Source& source, int dims, int& pairs) {
    const Image size{0,
                     0,
                     checker.random().between(1, 19),
                     dims > 1 ? checker.random().between(1, 7) : 1,
                     dims > 2 ? checker.random().between(1, 3) : 1,
                     dims};
    const Texture texture(source, size, checker.random());
    std::vector<uint8_t> image(size_t{19} * 7 * 3 * 40);
    for (GLenum format : knownFormats())
        for (GLenum type : knownTypes()) {
            if (!isReadable(source, format) || type == GL_BITMAP) continue;
            // Mesa 22.3 writes bytes for every type.
            if (format == GL_STENCIL_INDEX && type != GL_UNSIGNED_BYTE && type != GL_BYTE) continue;
            setPixelStore(Direction::Pack, tightStore(), TestApi::Compatibility);
            glGetTexImage(texture.target(), 0, format, type, image.data());
            if (takeErrors()) continue;
            ++pairs;
            for (int round = 0; round < 2; ++round)
                checker.check({format, type, size.width, size.height, size.depth, dims},
                              [&](void* pixels) { glGetTexImage(texture.target(), 0, format, type, pixels); });
            if (testing::Test::HasFailure()) return;
        }
}

TEST(SizesImageReadGl, matchesGetTexImage) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    Checker checker(TestApi::Compatibility);
    int pairs = 0;
    for (const Source& source : kSources)
        for (int dims : {1, 2, 3}) {
            checkGetTexImage(checker, source, dims, pairs);
            if (HasFailure()) return;
        }
    std::printf("%d cases of texture, format and type\n", pairs);
    EXPECT_GE(pairs, 100);
}

TEST(SizesImageReadGl, matchesGetPolygonStipple) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    Checker checker(TestApi::Compatibility);
    setPixelStore(Direction::Unpack, tightStore(), TestApi::Compatibility);
    const std::vector<uint8_t> stipple = checker.random().bytes(128);
    glPolygonStipple(stipple.data());
    for (int round = 0; round < 50 && !HasFailure(); ++round)
        checker.check({GL_COLOR_INDEX, GL_BITMAP, 32, 32, 1, 2},
                      [](void* bits) { glGetPolygonStipple(static_cast<GLubyte*>(bits)); });
}

// Mesa counts rows downwards from the highest row of the image, skipped rows first. The first row lies below the
// highest row, and below the pointer if more rows are skipped than exist.
TEST(SizesImageReadGl, placesInvertedRowsAboveTheSkippedOnes) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    const TestFramebuffer framebuffer(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    ASSERT_TRUE(framebuffer.complete());
    PixelStore store = tightStore();
    std::vector<uint8_t> tight(size_t{5} * 4 * 4);
    setPixelStore(Direction::Pack, store, TestApi::Compatibility);
    glReadPixels(0, 0, 5, 4, GL_RGBA, GL_UNSIGNED_BYTE, tight.data());
    store.invert = true;
    store.skipRows = 2;
    const ImageLayout layout = layoutOf(store, GL_RGBA, GL_UNSIGNED_BYTE, 5, 4, 1, 2);
    std::vector<uint8_t> expected(400, 0xee);
    std::vector<uint8_t> written = expected;
    unpackTight(expected.data() + 200, tight.data(), layout);
    setPixelStore(Direction::Pack, store, TestApi::Compatibility);
    glReadPixels(0, 0, 5, 4, GL_RGBA, GL_UNSIGNED_BYTE, written.data() + 200);
    EXPECT_EQ(written, expected);
}

} // namespace
} // namespace mural::sizes
