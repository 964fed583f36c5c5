#include "interposer/memory/image_part.hpp"

#include <cstring>

namespace mural {

void keepPart(std::byte* image, const ImagePart& part) {
    if (part.groupBytes == 0) return;
    const size_t rowBytes = part.groupBytes * static_cast<size_t>(part.size.width);
    std::byte* out = image;
    for (GLint z = 0; z < part.size.depth; ++z) {
        for (GLint y = 0; y < part.size.height; ++y, out += rowBytes) {
            const size_t row = static_cast<size_t>(part.from.depth + z) * static_cast<size_t>(part.image.height) +
                               static_cast<size_t>(part.from.height + y);
            const size_t pixel = row * static_cast<size_t>(part.image.width) + static_cast<size_t>(part.from.width);
            std::memmove(out, image + pixel * part.groupBytes, rowBytes);
        }
    }
}

} // namespace mural
