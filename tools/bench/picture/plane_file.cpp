#include "tools/bench/picture/plane_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace mural::bench {

using namespace compositor;

Result<NamedPlane> readPlane(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string word, format;
    int32_t width = 0, height = 0;
    in >> word >> format >> width >> height;
    if (!in || word != "plane" || width < 1 || height < 1 || width > 65536 || height > 65536)
        return Error{path + ": it does not begin with \"plane FORMAT WIDTH HEIGHT\"; capture it anew"};
    in.get();
    for (int f = 0; f < kPlaneFormats; ++f) {
        if (format != nameOf(static_cast<PlaneFormat>(f))) continue;
        NamedPlane named{std::filesystem::path(path).stem().string(),
                         Plane(static_cast<PlaneFormat>(f), width, height)};
        auto& bytes = named.plane.bytes();
        in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        if (in.gcount() != static_cast<std::streamsize>(bytes.size()))
            return Error{path + ": it is cut short; capture it anew"};
        return named;
    }
    return Error{path + ": there is no plane format \"" + format + "\"; capture it anew"};
}

Result<std::vector<NamedPlane>> readPlanes(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code failed;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
        const std::string path = entry.path().string();
        if (path.ends_with(".plane") && path.find(".next.") == std::string::npos) paths.push_back(path);
    }
    if (failed || paths.empty())
        return Error{folder + ": there are no *.plane files; let tools/bench/compositing capture some"};
    std::ranges::sort(paths);
    std::vector<NamedPlane> planes;
    for (const std::string& path : paths) {
        auto plane = readPlane(path);
        if (!plane) return plane.error();
        planes.push_back(std::move(*plane));
    }
    return planes;
}

} // namespace mural::bench
