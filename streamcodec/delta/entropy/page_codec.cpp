#include "streamcodec/delta/entropy/page_codec.hpp"

#include "streamcodec/delta/varint.hpp"

namespace mural::delta {

bool PageCompressor::compress(Coding coding, std::span<const std::byte> pages, std::vector<std::byte>& into) {
    if (coding != Coding::Zstd) return rest_.compress(coding, pages, into);
    if (!splitter_.split(pages)) {
        writeVarint(0, into);
        return rest_.compress(coding, pages, into);
    }
    codedFront_.clear(), codedPlanes_.clear();
    if (!fronts_.compress(coding, splitter_.front(), codedFront_)) return false;
    const auto planes = splitter_.planes();
    const bool counted = countedPlanes_.suits(planes);
    if (counted && !countedPlanes_.compress(planes, codedPlanes_)) return false;
    if (!counted && !planes.empty() && !planes_.compress(coding, planes, codedPlanes_)) return false;
    writeVarint(splitter_.pixelPieces(), into);
    writeVarint(codedFront_.size(), into);
    writeVarint(codedPlanes_.size() * 2 + (counted ? 1 : 0), into);
    into.insert(into.end(), codedFront_.begin(), codedFront_.end());
    into.insert(into.end(), codedPlanes_.begin(), codedPlanes_.end());
    return splitter_.rest().empty() || rest_.compress(coding, splitter_.rest(), into);
}

void PageCompressor::prepare() {
    for (SectionCompressor* compressor : {&rest_, &fronts_, &planes_}) compressor->prepare();
    countedPlanes_.prepare();
}

bool PageDecompressor::decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into) {
    if (coding != Coding::Zstd) return rest_.decompress(coding, bytes, into);
    uint32_t pieces = 0;
    if (!readVarint(bytes, pieces)) return false;
    return pieces == 0 ? rest_.decompress(coding, bytes, into) : decompressPixels(pieces, bytes, into);
}

bool PageDecompressor::decompressPixels(uint32_t pieces, std::span<const std::byte> bytes, std::span<std::byte> into) {
    uint32_t frontCoded = 0, planesCoded = 0;
    if (!readVarint(bytes, frontCoded) || !readVarint(bytes, planesCoded)) return false;
    const bool counted = (planesCoded & 1) != 0;
    planesCoded /= 2;
    if (pieces > into.size() / kPageBytes || uint64_t{frontCoded} + planesCoded > bytes.size()) return false;
    const auto front = bytes.first(frontCoded), planes = bytes.subspan(frontCoded, planesCoded),
               rest = bytes.subspan(size_t{frontCoded} + planesCoded);
    frontBytes_.resize(frontBytes(into.size(), pieces));
    if (!fronts_.decompress(Coding::Zstd, front, frontBytes_) || !joiner_.begin(frontBytes_, into.size(), pieces))
        return false;
    planeBytes_.resize(joiner_.planeBytes());
    if (!decompressPlanes(counted, planes)) return false;
    restBytes_.resize(joiner_.restBytes());
    if (restBytes_.empty() ? !rest.empty() : !rest_.decompress(Coding::Zstd, rest, restBytes_)) return false;
    joiner_.join(planeBytes_, restBytes_, into);
    return true;
}

bool PageDecompressor::decompressPlanes(bool counted, std::span<const std::byte> planes) {
    if (counted) return countedPlanes_.decompress(planes, planeBytes_);
    return planeBytes_.empty() ? planes.empty() : planes_.decompress(Coding::Zstd, planes, planeBytes_);
}

} // namespace mural::delta
