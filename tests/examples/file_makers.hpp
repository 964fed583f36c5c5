// Small files for the tests of the readers.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include <zlib.h>

namespace mural::test {

// Appends numbers in one byte order.
class Bytes {
public:
    explicit Bytes(std::endian order, std::string begin = {}) : text(std::move(begin)), order_(order) {}
    template <class T> Bytes& add(T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        if (order_ != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
        text.append(bytes, sizeof(T));
        return *this;
    }
    template <class T, class... More> Bytes& addAll(T value, More... more) {
        add(value);
        (add(static_cast<T>(more)), ...);
        return *this;
    }
    template <class T> Bytes& put(size_t offset, T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        if (order_ != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
        text.replace(offset, sizeof(T), bytes, sizeof(T));
        return *this;
    }
    std::string text;

private:
    std::endian order_;
};

inline std::string gzipped(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

// A NIfTI-1 file of 2x1x2 voxels of 16 bits with the values of `voxels`.
inline std::string niftiOf(std::endian order, const std::array<int16_t, 4>& voxels) {
    Bytes file(order, std::string(352, '\0'));
    file.put(0, int32_t{348}).put(40, int16_t{3}).put(42, int16_t{2}).put(44, int16_t{1}).put(46, int16_t{2});
    file.put(70, int16_t{4}).put(80, 1.5f).put(84, 2.f).put(88, 3.f).put(108, 352.f);
    file.text.replace(344, 3, "n+1");
    for (const int16_t voxel : voxels) file.add(voxel);
    return file.text;
}

// An INR file of 2x2x1 voxels of 8 bits.
inline std::string inrOf(const std::string& voxels) {
    std::string header = "#INRIMAGE-4#{\nXDIM=2\nYDIM=2\nZDIM=1\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\n"
                         "SCALE=2**0\nCPU=decm\nVX=0.5\nVY=0.5\nVZ=1.25\n";
    header.resize(252, '\n');
    return header + "##}\n" + voxels;
}

} // namespace mural::test
