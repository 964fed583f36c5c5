// GL's reads of images in client memory, compared with layoutOf, spanBytes and packTight: for all pairs of format and
// type that this GL accepts, with odd sizes and random pixel store states. A byte too many or too few reaches a guard
// page; a misplaced byte changes the picture.
#include "tests/streamcodec/sizes_gl_context.hpp"

#include <cstring>
#include <functional>

#include "streamcodec/sizes/gl_enums.hpp"
#include "tests/streamcodec/sizes_guarded_memory.hpp"
#include "tests/streamcodec/sizes_random.hpp"

namespace mural::sizes {
namespace {

using Upload = std::function<void(const void* pixels)>;
using Snapshot = std::function<std::vector<uint8_t>()>;

struct Image {
    GLenum format, type;
    int width, height, depth, dims;
};

std::string describe(const Image& image) {
    char text[96];
    std::snprintf(text, sizeof text, "format %#x type %#x %dx%dx%d ", image.format, image.type, image.width,
                  image.height, image.depth);
    return text;
}

// Mesa swaps depth through floats, which loses bits of 32-bit integers: only equal paths are comparable.
bool isDepth(GLenum format) { return format == GL_DEPTH_COMPONENT || format == GL_DEPTH_STENCIL; }

// A 32-bit depth, a byte of stencil, and three unused bytes.
size_t unreadAtTheEnd(GLenum type) { return type == GL_FLOAT_32_UNSIGNED_INT_24_8_REV ? 3 : 0; }

// Mesa 22.3 swaps bytes in a copy of all rows from the pointer on, and skips in the copy again.
PixelStore swappedOnly(const PixelStore& store) {
    return {.alignment = store.alignment, .swapBytes = true, .lsbFirst = store.lsbFirst};
}

// Mesa 22.3 reads colour indices as one row of all pixels, ignoring the pixel store state, and then divides its own
// copy by that state.
bool mesaIgnoresStore(const Image& image) {
    return image.format == GL_COLOR_INDEX && image.type != GL_BITMAP;
} // glBitmap is correct

class Checker {
public:
    explicit Checker(TestApi api) : api_(api) {}

    Random& random() { return random_; }
    [[nodiscard]] uint32_t seed() const { return seed_; }

    PixelStore randomStore(const Image& image) {
        PixelStore store = random_.store(image.width, image.height);
        if (api_ != TestApi::Compatibility) store.swapBytes = store.lsbFirst = false;
        if (api_ == TestApi::Es1) store = PixelStore{.alignment = store.alignment};
        if (isDepth(image.format)) store.swapBytes = false;
        if (store.swapBytes) store = swappedOnly(store);
        return mesaIgnoresStore(image) ? tightStore() : store;
    }

    // snapshot: an empty function if the result cannot be read.
    void check(const Image& image, const Upload& upload, const Snapshot& snapshot) {
        check(image, randomStore(image), upload, snapshot);
    }

    void check(const Image& image, const PixelStore& store, const Upload& upload, const Snapshot& snapshot) {
        SCOPED_TRACE("seed " + std::to_string(seed_) + " " + describe(image) + sizes::describe(store));
        const ImageLayout layout =
            layoutOf(store, image.format, image.type, image.width, image.height, image.depth, image.dims);
        ASSERT_TRUE(layout.known);
        const size_t span = spanBytes(layout);
        ASSERT_LE(span, memory_.size());
        const std::vector<uint8_t> client = random_.bytes(span);
        std::vector<uint8_t> tight(tightBytes(layout));
        packTight(tight.data(), client.data(), layout);

        setPixelStore(Direction::Unpack, store, api_);
        runAt(memory_.end() - span, client, 0, upload);
        EXPECT_FALSE(memory_.touched()) << "GL reads behind spanBytes";
        const std::vector<uint8_t> seen = snapshot ? snapshot() : std::vector<uint8_t>{};
        const auto first = static_cast<size_t>(layout.firstByte);
        runAt(memory_.begin() - first, client, first, upload);
        EXPECT_FALSE(memory_.touched()) << "GL reads before the first pixel";
        const size_t missing = unreadAtTheEnd(image.type) + 1;
        runAt(memory_.end() - span + missing,
              std::vector<uint8_t>(client.begin(), client.end() - static_cast<ptrdiff_t>(missing)), 0, upload);
        EXPECT_TRUE(memory_.touched()) << "GL does not read the last byte of spanBytes";

        setPixelStore(Direction::Unpack, tightStore(), api_);
        runAt(memory_.end() - tight.size(), tight, 0, upload);
        EXPECT_FALSE(memory_.touched()) << "GL reads behind tightBytes";
        if (snapshot) {
            EXPECT_EQ(seen, snapshot()) << "the tight image is another one";
        }
        EXPECT_FALSE(takeErrors());
    }

private:
    // Calls GL with `pointer`; the bytes start at offset `first`.
    void runAt(uint8_t* pointer, const std::vector<uint8_t>& bytes, size_t first, const Upload& upload) {
        if (bytes.size() > first) std::memcpy(pointer + first, bytes.data() + first, bytes.size() - first);
        memory_.close();
        upload(pointer);
    }

    TestApi api_;
    uint32_t seed_ = std::random_device{}();
    Random random_{seed_};
    GuardedMemory memory_{size_t{1} << 19};
};

// Tried in this order, then the format itself (OpenGL ES: unsized formats). For unsized formats the driver chooses the
// precision, depending on the byte order too.
constexpr GLenum kInternalFormats[] = {GL_RGBA32F,
                                       GL_RGBA,
                                       GL_RGBA32UI,
                                       GL_RGBA32I,
                                       GL_DEPTH24_STENCIL8,
                                       GL_DEPTH_COMPONENT24,
                                       GL_DEPTH_COMPONENT16,
                                       GL_DEPTH_COMPONENT32F,
                                       GL_DEPTH24_STENCIL8,
                                       GL_DEPTH32F_STENCIL8,
                                       GL_STENCIL_INDEX8,
                                       GL_YCBCR_MESA,
                                       GL_RGB,
                                       GL_RGBA8,
                                       GL_RGB8,
                                       GL_R8,
                                       GL_RG8,
                                       GL_R32F,
                                       GL_RG32F,
                                       GL_RGB32F,
                                       GL_R32UI,
                                       GL_RG32UI,
                                       GL_RGB32UI,
                                       GL_R32I,
                                       GL_RG32I,
                                       GL_RGB32I,
                                       GL_R16UI,
                                       GL_RG16UI,
                                       GL_RGB16UI,
                                       GL_RGBA16UI,
                                       GL_R16I,
                                       GL_RG16I,
                                       GL_RGB16I,
                                       GL_RGBA16I,
                                       GL_R8UI,
                                       GL_RG8UI,
                                       GL_RGB8UI,
                                       GL_RGBA8UI,
                                       GL_R8I,
                                       GL_RG8I,
                                       GL_RGB8I,
                                       GL_RGBA8I,
                                       GL_R8_SNORM,
                                       GL_RG8_SNORM,
                                       GL_RGB8_SNORM,
                                       GL_RGBA8_SNORM,
                                       GL_RGB10_A2,
                                       GL_RGB10_A2UI,
                                       GL_R11F_G11F_B10F,
                                       GL_RGB9_E5,
                                       GL_RGB565,
                                       GL_RGBA4,
                                       GL_RGB5_A1,
                                       GL_R16F,
                                       GL_RG16F,
                                       GL_RGB16F,
                                       GL_RGBA16F,
                                       GL_LUMINANCE,
                                       GL_ALPHA,
                                       GL_SRGB8,
                                       GL_SRGB8_ALPHA8,
                                       GL_DUDV_ATI};

// 0: GL has no texture of this format and type.
GLenum internalFormatFor(GLenum format, GLenum type) {
    const auto accepted = [&](GLenum internalformat) {
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalformat), 1, 1, 0, format, type, nullptr);
        return !takeErrors();
    };
    for (GLenum internalformat : kInternalFormats)
        if (accepted(internalformat)) return internalformat;
    return accepted(format) ? format : 0;
}

std::vector<uint8_t> textureBytes(GLenum target, GLenum format, GLenum type, size_t pixels) {
    setPixelStore(Direction::Pack, tightStore(), TestApi::Compatibility);
    std::vector<uint8_t> bytes(pixels * groupBytes(format, type));
    glGetTexImage(target, 0, format, type, bytes.data());
    return bytes;
}

void checkTextures(Checker& checker, TestApi api, GLenum format, GLenum type, GLenum internalformat) {
    for (int dims : {1, 2, 3}) {
        if (dims == 1 && api != TestApi::Compatibility) continue;
        if (dims == 3 && api == TestApi::Es1) continue;
        const GLenum target = dims == 1 ? GL_TEXTURE_1D : dims == 2 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY;
        for (int round = 0; round < 3; ++round) {
            // Pixels with shared chroma occur in pairs.
            const int step = internalformat == GL_YCBCR_MESA ? 2 : 1;
            const Image image{format,
                              type,
                              step * checker.random().between(1, 19 / step),
                              dims > 1 ? checker.random().between(1, 7) : 1,
                              dims > 2 ? checker.random().between(1, 3) : 1,
                              dims};
            const auto internal = static_cast<GLint>(internalformat);
            const Upload upload = [&](const void* pixels) {
                if (dims == 1) glTexImage1D(target, 0, internal, image.width, 0, format, type, pixels);
                if (dims == 2) glTexImage2D(target, 0, internal, image.width, image.height, 0, format, type, pixels);
                if (dims == 3)
                    glTexImage3D(target, 0, internal, image.width, image.height, image.depth, 0, format, type, pixels);
            };
            upload(nullptr);
            if (takeErrors()) break; // not for this kind of texture
            Snapshot snapshot;
            const size_t pixels =
                static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * static_cast<size_t>(image.depth);
            if (api == TestApi::Compatibility && format != GL_COLOR_INDEX)
                snapshot = [&, pixels] { return textureBytes(target, format, type, pixels); };
            checker.check(image, upload, snapshot);
        }
    }
}

void checkAllTextures(TestApi api) {
    const TestContext context(api);
    if (!context.valid()) GTEST_SKIP() << "no such context over EGL surfaceless here";
    Checker checker(api);
    int pairs = 0;
    for (GLenum format : knownFormats())
        for (GLenum type : knownTypes()) {
            const GLenum internalformat = internalFormatFor(format, type);
            if (internalformat == 0 || type == GL_BITMAP) continue; // as in drawPixels
            ASSERT_NE(groupBytes(format, type), 0u) << std::hex << "GL takes format " << format << " type " << type;
            SCOPED_TRACE("internal format " + std::to_string(internalformat));
            checkTextures(checker, api, format, type, internalformat);
            if (testing::Test::HasFailure()) return;
            ++pairs;
        }
    std::printf("%d pairs of format and type\n", pairs);
    EXPECT_GE(pairs, api == TestApi::Es1 ? 5 : 50);
}

TEST(SizesImageUploadGl, matchesTexturesOfTheCompatibilityProfile) { checkAllTextures(TestApi::Compatibility); }
TEST(SizesImageUploadGl, matchesTexturesOfOpenGlEs3) { checkAllTextures(TestApi::Es3); }
TEST(SizesImageUploadGl, matchesTexturesOfOpenGlEs1) { checkAllTextures(TestApi::Es1); }

// Formats and types that GL accepts and the sizes do not know.
void findUnknown(TestApi api) {
    const TestContext context(api);
    if (!context.valid()) GTEST_SKIP() << "no such context over EGL surfaceless here";
    constexpr GLenum kSomeFormats[] = {GL_RGBA,       GL_RGB,         GL_RED, GL_DEPTH_STENCIL, GL_DEPTH_COMPONENT,
                                       GL_YCBCR_MESA, GL_RGBA_INTEGER};
    constexpr GLenum kSomeTypes[] = {GL_UNSIGNED_BYTE,        GL_FLOAT,
                                     GL_UNSIGNED_INT_24_8,    GL_UNSIGNED_SHORT_8_8_MESA,
                                     GL_UNSIGNED_SHORT_5_6_5, GL_UNSIGNED_SHORT_4_4_4_4};
    constexpr GLenum kSomeInternal[] = {GL_RGBA, GL_RGB, GL_RGBA32UI, GL_DEPTH24_STENCIL8, GL_YCBCR_MESA};
    const auto accepts = [](GLenum internalformat, GLenum format, GLenum type) {
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalformat), 1, 1, 0, format, type, nullptr);
        return !takeErrors();
    };
    for (GLenum value = 0; value <= 0xffff; ++value) {
        for (GLenum type : kSomeTypes) {
            if (componentsOf(value) != 0) break;
            EXPECT_FALSE(accepts(value, value, type)) << std::hex << "format " << value << " type " << type;
            for (GLenum internal : kSomeInternal)
                EXPECT_FALSE(accepts(internal, value, type)) << std::hex << "format " << value << " type " << type;
        }
        for (GLenum format : kSomeFormats) {
            if (swapUnitBytes(value) != 0) break;
            EXPECT_FALSE(accepts(format, format, value)) << std::hex << "format " << format << " type " << value;
            for (GLenum internal : kSomeInternal)
                EXPECT_FALSE(accepts(internal, format, value)) << std::hex << "format " << format << " type " << value;
        }
    }
}

TEST(SizesImageUploadGl, supportsEveryFormatAndType) { findUnknown(TestApi::Compatibility); }
TEST(SizesImageUploadGl, supportsEveryFormatAndTypeOfOpenGlEs) { findUnknown(TestApi::Es3); }

// A framebuffer with all kinds of buffers for glDrawPixels and glBitmap.
class DrawTarget {
public:
    static constexpr int kSize = 32;

    DrawTarget() {
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glGenRenderbuffers(2, buffers_);
        attach(buffers_[0], GL_RGBA8, GL_COLOR_ATTACHMENT0);
        attach(buffers_[1], GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
        glViewport(0, 0, kSize, kSize);
        float ramp[256];
        for (int i = 0; i < 256; ++i) ramp[i] = static_cast<float>(i) / 255;
        for (GLenum map : {GL_PIXEL_MAP_I_TO_R, GL_PIXEL_MAP_I_TO_G, GL_PIXEL_MAP_I_TO_B, GL_PIXEL_MAP_I_TO_A})
            glPixelMapfv(map, 256, ramp);
    }
    ~DrawTarget() {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDeleteRenderbuffers(2, buffers_);
        glDeleteFramebuffers(1, &framebuffer_);
    }
    DrawTarget(const DrawTarget&) = delete;
    DrawTarget& operator=(const DrawTarget&) = delete;

    static void clear() {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        glWindowPos2i(0, 0);
    }
    static std::vector<uint8_t> read() {
        setPixelStore(Direction::Pack, tightStore(), TestApi::Compatibility);
        std::vector<uint8_t> bytes(size_t{kSize} * kSize * 8);
        glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        glReadPixels(0, 0, kSize, kSize, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, bytes.data() + bytes.size() / 2);
        return bytes;
    }

private:
    static void attach(GLuint buffer, GLenum format, GLenum point) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorage(GL_RENDERBUFFER, format, kSize, kSize);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, buffer);
    }
    GLuint framebuffer_ = 0;
    GLuint buffers_[2] = {};
};

TEST(SizesImageUploadGl, matchesDrawPixels) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    const DrawTarget target;
    Checker checker(TestApi::Compatibility);
    const std::vector<uint8_t> zeros(64);
    int pairs = 0;
    for (GLenum format : knownFormats())
        for (GLenum type : knownTypes()) {
            if (type == GL_BITMAP) continue; // Mesa accepts bits here, and reports on stderr that they are unsupported
            setPixelStore(Direction::Unpack, tightStore(), TestApi::Compatibility);
            glDrawPixels(1, 1, format, type, zeros.data());
            if (takeErrors()) continue;
            for (int round = 0; round < 3; ++round) {
                const Image image{format, type, checker.random().between(1, 29), checker.random().between(1, 9), 1, 2};
                const Upload draw = [&](const void* pixels) {
                    DrawTarget::clear();
                    glDrawPixels(image.width, image.height, format, type, pixels);
                };
                checker.check(image, draw, DrawTarget::read);
            }
            if (HasFailure()) return;
            ++pairs;
        }
    std::printf("%d pairs of format and type\n", pairs);
    EXPECT_GE(pairs, 50);
}

TEST(SizesImageUploadGl, matchesBitmaps) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    const DrawTarget target;
    Checker checker(TestApi::Compatibility);
    for (int round = 0; round < 100; ++round) {
        const Image image{
            GL_COLOR_INDEX, GL_BITMAP, checker.random().between(1, 30), checker.random().between(1, 30), 1, 2};
        const Upload draw = [&](const void* bits) {
            DrawTarget::clear();
            glBitmap(image.width, image.height, 0, 0, 0, 0, static_cast<const GLubyte*>(bits));
            glFlush(); // Mesa batches small bitmaps
        };
        checker.check(image, draw, DrawTarget::read);
        if (HasFailure()) return;
    }
}

TEST(SizesImageUploadGl, matchesPolygonStipples) {
    const TestContext context(TestApi::Compatibility);
    if (!context.valid()) GTEST_SKIP() << "no compatibility profile over EGL surfaceless here";
    Checker checker(TestApi::Compatibility);
    const Upload stipple = [](const void* bits) { glPolygonStipple(static_cast<const GLubyte*>(bits)); };
    const Snapshot stippleBits = [] {
        setPixelStore(Direction::Pack, tightStore(), TestApi::Compatibility);
        std::vector<uint8_t> bytes(128);
        glGetPolygonStipple(bytes.data());
        return bytes;
    };
    const Image image{GL_COLOR_INDEX, GL_BITMAP, 32, 32, 1, 2};
    for (int round = 0; round < 100 && !HasFailure(); ++round) {
        PixelStore store = checker.randomStore(image);
        store.skipPixels &= ~7; // Mesa 22.3 writes past its copy if bits are shifted
        checker.check(image, store, stipple, stippleBits);
    }
}

} // namespace
} // namespace mural::sizes
