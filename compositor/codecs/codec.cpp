#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

Error damagedPlane(const std::string& codec, const PlaneView& shape, size_t sizeBytes, const char* what) {
    return Error{"codec " + codec + ": " + std::to_string(sizeBytes) + " bytes are not a plane of " +
                 std::to_string(shape.width) + "x" + std::to_string(shape.height) + " " + nameOf(shape.format) + ": " +
                 what + "; check that sender and receiver run the same version"};
}

} // namespace mural::compositor
