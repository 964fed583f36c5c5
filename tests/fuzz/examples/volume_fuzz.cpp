// Feeds arbitrary bytes to the readers of volumes. They report an error or return a volume with all its voxels.
#include "examples/data/volume.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::string_view bytes(reinterpret_cast<const char*>(input.data()), input.size());
    const Result<examples::Volume> volume = examples::parseVolume(bytes, "input");
    if (!volume) {
        must(volume.error().message.rfind("input", 0) == 0, "an error names the file");
        return 0;
    }
    const examples::Volume& v = volume.value();
    must(v.voxelCount() > 0 && v.voxels.size() == v.voxelCount() * v.bytesPerVoxel, "all voxels exist");
    for (const double spacing : v.spacing) must(spacing > 0, "a spacing is positive");
    return v.voxelCount();
}

} // namespace mural::fuzz
