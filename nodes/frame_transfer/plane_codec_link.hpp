// Combines all codecs of a link into one. The first byte identifies the codec.
#pragma once

#include "common/base/copy_bytes.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"

namespace mural {

class LinkEncoder final : public compositor::Codec {
public:
    explicit LinkEncoder(const std::string& codec) : encoder_(codec) {}

    [[nodiscard]] size_t boundBytes(const compositor::PlaneShape& shape) const override {
        return 1 + shape.sizeBytes();
    }
    [[nodiscard]] Result<size_t> encode(const compositor::PlaneView& plane, std::span<std::byte> into) override {
        packed_.clear();
        into[0] = std::byte{encoder_.encode(plane, packed_)};
        copyBytes(packed_, into.subspan(1));
        return packed_.size() + 1;
    }
    [[nodiscard]] Result<void> decode(std::span<const std::byte>, const compositor::MutablePlaneView&) override {
        return Error{"this end only encodes"};
    }

    void transferred(uint64_t bytes, int64_t ns) { encoder_.transferred(bytes, ns); }

private:
    PlaneEncoder encoder_;
    std::vector<std::byte> packed_;
};

class LinkDecoder final : public compositor::Codec {
public:
    explicit LinkDecoder(const std::string& codec) : decoder_(codec) {}

    [[nodiscard]] size_t boundBytes(const compositor::PlaneShape& shape) const override {
        return 1 + shape.sizeBytes();
    }
    [[nodiscard]] Result<size_t> encode(const compositor::PlaneView&, std::span<std::byte>) override {
        return Error{"this end only decodes"};
    }
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes,
                                      const compositor::MutablePlaneView& into) override {
        if (bytes.empty()) return Error{"a plane with an unknown codec"};
        return decoder_.decode(static_cast<CodecNumber>(bytes.front()), bytes.subspan(1), into);
    }

private:
    PlaneDecoder decoder_;
};

} // namespace mural
