#include "streamcodec/filter/upload.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <algorithm>
#include <xxhash.h>

#include "streamcodec/command_traits.hpp"
#include "streamcodec/filter/command_class.hpp"
#include "streamcodec/effect_rules.hpp"
#include "streamcodec/wire/record.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::filter {
namespace {

using wire::argumentWord;
using wire::RecordView;

uint64_t wideAt(const RecordView& r, size_t word) {
    return argumentWord(r, word) | uint64_t{argumentWord(r, word + 1)} << 32;
}

bool isFace(uint32_t target) {
    return target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
}

} // namespace

std::optional<Upload> uploadOf(const RecordView& r, uint64_t blobBytes) {
    Upload u;
    const EffectKind effect = effectRuleOf(r.opcode).kind;
    const size_t words = r.arguments.size() / 4;
    size_t shapeEnd = words, valueEnd = words; // the words between are the value
    const uint8_t valueWord = valueWordOf(r.opcode);
    if (valueWord != kNoValue) {
        if (valueWord >= words) return std::nullopt;
        const uint32_t tag = argumentWord(r, valueWord);
        shapeEnd = valueEnd = valueWord + 1u;
        if (tag <= record::kInlineBytes) {
            valueEnd += (size_t{tag} + 3) / 4;
            if (valueEnd > words) return std::nullopt;
            u.inlineValue = r.arguments.subspan(shapeEnd * 4, tag);
            u.shape.valueBytes = tag;
            u.given = tag > 0;
        } else if (tag == record::kTagBlob) {
            if (blobBytes == 0) return std::nullopt;
            u.shape.valueBytes = blobBytes;
            u.given = true;
        }
    } else if (effect == EffectKind::Uniform) { // scalars after the location
        shapeEnd = 1;
        if (words < 2) return std::nullopt;
        u.inlineValue = r.arguments.subspan(4);
        u.shape.valueBytes = u.inlineValue.size();
        u.given = true;
    }
    size_t n = 0;
    u.shape.words[n++] = r.opcode;
    u.shape.words[n++] = static_cast<uint32_t>(words);
    for (size_t i = 0; i < words; ++i) {
        if (i == shapeEnd) i = valueEnd;
        if (i >= words) break;
        if (n == u.shape.words.size()) return std::nullopt;
        u.shape.words[n++] = argumentWord(r, i);
    }
    if (r.opcode == wire::kOpBufferBytes) { // buffer, offset, value
        u.place = {0, 0, wideAt(r, 1), wideAt(r, 1) + u.shape.valueBytes};
        return u;
    }
    switch (effect) {
    case EffectKind::BufferData:
        u.kind = hasTrait(r.opcode, Trait::Immutable) ? UploadKind::Storage : UploadKind::Whole;
        return u;
    case EffectKind::BufferSubData: // target, offset, size
        u.place = {0, 0, wideAt(r, 1), wideAt(r, 1) + u.shape.valueBytes};
        return u;
    case EffectKind::Uniform:
        if (static_cast<int32_t>(argumentWord(r, 0)) < 0) return std::nullopt;
        // array elements are consecutive
        u.place = {0, 0, argumentWord(r, 0),
                   uint64_t{argumentWord(r, 0)} + (valueWord == kNoValue ? 1 : std::max(argumentWord(r, 1), 1u))};
        return u;
    case EffectKind::TexStorage: u.kind = UploadKind::Storage; return u;
    case EffectKind::TexImage:
        u.kind = hasTrait(r.opcode, Trait::Multisample) ? UploadKind::Storage : UploadKind::Whole;
        [[fallthrough]];
    default: // glTexSubImage..., by target or name
        u.place = {isFace(argumentWord(r, 0)) ? argumentWord(r, 0) : 0, argumentWord(r, 1), 0, UINT64_MAX};
        return u;
    }
}

Summing::Summing() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }
Summing::~Summing() { XXH3_freeState(state_); }
void Summing::add(std::span<const std::byte> bytes) { XXH3_128bits_update(state_, bytes.data(), bytes.size()); }
Sum Summing::sum() const {
    const XXH128_hash_t h = XXH3_128bits_digest(state_);
    return {h.low64, h.high64};
}

} // namespace mural::filter
