#include "streamcodec/trace/dump/record_text.hpp"

#include <fmt/format.h>
#include <string_view>

#include "streamcodec/trace/dump/value_text.hpp"
#include "streamcodec/wire/client_arrays.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/opcode_names.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::trace {
namespace {

// Control records. The letter after ':' is the type of a parameter; without one it is u32.
//   i: i32  q: u64  e: enum  x: hexadecimal  w: WindowConfig  v: value
struct OwnRecord {
    uint16_t opcode;
    const char* name;
    const char* parameters;
};
constexpr OwnRecord kOwn[] = {
    {wire::kOpBlobBegin, "BlobBegin", "bytes:q"},
    {wire::kOpBlobData, "BlobData", "bytes"},
    {wire::kOpCreateContext, "CreateContext", "context share api major minor profile:x flags:x config:w"},
    {wire::kOpDestroyContext, "DestroyContext", "context"},
    {wire::kOpMakeCurrent, "MakeCurrent", "context draw read"},
    {wire::kOpWindow, "Window", "window config:w"},
    {wire::kOpDestroyWindow, "DestroyWindow", "window"},
    {wire::kOpSwap, "Swap", "window frame"},
    {wire::kOpClientArrays, "ClientArrays", "arrays spans"},
    {wire::kOpRequestPixels, "RequestPixels", "request:x x:i y:i width:i height:i format:e type:e groupBytes:x"},
    {wire::kOpRequestTexImage, "RequestTexImage", "request:x byName texture:e level:i format:e type:e bytes:q"},
    {wire::kOpRequestBuffer, "RequestBuffer", "request:x buffer offset:q bytes:q"},
    {wire::kOpRequestQuery, "RequestQuery", "request:x query pname:e"},
    {wire::kOpFillWindow, "FillWindow", "x:i y:i width:i height:i planes:x pixels:v"},
    {wire::kOpProgramLayout, "ProgramLayout", "program layout:v"},
    {wire::kOpBufferBytes, "BufferBytes", "buffer offset:q bytes:v"},
    {wire::kOpFinish, "Finish", "request:x"},
    {wire::kOpFrontPicture, "FrontPicture", "window frame"},
    {wire::kOpBeginConditional, "BeginConditional", "draws"},
    {wire::kOpQueryKnown, "QueryKnown", "query passed"},
    {wire::kOpDrawAll, "DrawAll", ""},
    {wire::kOpCreateImage, "CreateImage", "image:q context target:e name level:i layer:i"},
    {wire::kOpDestroyImage, "DestroyImage", "image:q"},
    {wire::kOpRequestProgram, "RequestProgram", "request:x program"},
    {wire::kOpProgramRecipe, "ProgramSources", "program recipe:v"},
    {wire::kOpErrorReported, "ErrorReported", ""},
};

const OwnRecord* ownRecord(uint16_t opcode) {
    for (const OwnRecord& own : kOwn)
        if (own.opcode == opcode) return &own;
    return nullptr;
}

template <class T> std::string loaded(Element element, T value) {
    return numberText(element, 0, reinterpret_cast<const std::byte*>(&value));
}

std::string configText(Args& in) {
    wire::WindowConfig c{};
    if (const auto* p = in.fixed<wire::WindowConfig>(sizeof c)) std::memcpy(&c, p, sizeof c);
    return fmt::format("{}x{} rgba {},{},{},{} depth {} stencil {} samples {}{}{}{}{}", c.width, c.height, c.red,
                       c.green, c.blue, c.alpha, c.depth, c.stencil, c.samples, c.doubleBuffer ? " double" : " single",
                       c.stereo ? " stereo" : "", c.srgb ? " srgb" : "", c.isPbuffer ? " pbuffer" : "");
}

std::string dataText(const Data& d, Travel travel, Element element, uint16_t group) {
    if (d.isOffset()) return fmt::format("offset {}", reinterpret_cast<uintptr_t>(d.pointer()));
    if (d.absent()) return "NULL";
    if (travel == Travel::Text) return quoted(d.size() > 0 && d.isText() ? d.span().first(d.size() - 1) : d.span());
    return arrayText(element, group, d.span());
}

std::string textsText(const Data& d, int64_t count) {
    StringList texts;
    if (!texts.parse(d, count)) return "malformed";
    std::string text = "[";
    for (size_t i = 0; i < texts.count(); ++i)
        text += (i > 0 ? ", " : "") +
                quoted(std::as_bytes(std::span(texts.pointers()[i], static_cast<size_t>(texts.lengths()[i]))));
    return text + "]";
}

std::string ownArgument(Args& in, char kind) {
    switch (kind) {
    case 'i': return loaded(Element::I32, in.get<int32_t>());
    case 'q': return loaded(Element::U64, in.get<uint64_t>());
    case 'e': return loaded(Element::Enum, in.get<uint32_t>());
    case 'x': return fmt::format("0x{:x}", in.get<uint32_t>());
    case 'w': return configText(in);
    case 'v': return dataText(in.data(), Travel::Value, Element::Bytes, 0);
    default: return loaded(Element::U32, in.get<uint32_t>());
    }
}

std::string ownText(const OwnRecord& own, Args& in) {
    std::string text;
    std::string_view left = own.parameters;
    while (!left.empty()) {
        const std::string_view one = left.substr(0, left.find(' '));
        left.remove_prefix(std::min(left.size(), one.size() + 1));
        const size_t colon = one.find(':');
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", one.substr(0, colon),
                            ownArgument(in, colon == std::string_view::npos ? ' ' : one[colon + 1]));
    }
    return text;
}

// Reads the values after the counts, so their blobs are consumed in order.
std::string clientArraysText(Args& in) {
    const auto arrays = in.get<uint32_t>(), spans = in.get<uint32_t>();
    if (arrays > client_arrays::kSlots || spans > arrays) return "malformed";
    const auto* records = in.fixed<std::byte>(arrays * sizeof(client_arrays::ArrayRecord));
    std::string text;
    for (uint32_t i = 0; records != nullptr && i < arrays; ++i) {
        client_arrays::ArrayRecord a{};
        std::memcpy(&a, records + i * sizeof a, sizeof a);
        text += fmt::format("{}{{slot={}, size={}, type={}, stride={}, first={}, count={}}}", i > 0 ? ", " : "", a.slot,
                            a.size, enumText(0, a.type), a.strideBytes, a.firstElement, a.elementCount);
    }
    for (uint32_t i = 0; i < spans && in.ok(); ++i)
        text += ", " + dataText(in.data(), Travel::Value, Element::Bytes, 0);
    return text;
}

std::string argumentText(const ParameterInfo& p, Args& in, int64_t count) {
    switch (p.travel) {
    case Travel::Scalar: {
        std::byte value[8] = {};
        if (bytesOf(p.element) == 8) {
            const auto wide = in.get<uint64_t>();
            std::memcpy(value, &wide, sizeof wide);
        } else {
            const auto word = in.get<uint32_t>();
            std::memcpy(value, &word, sizeof word);
        }
        return numberText(p.element, p.group, value);
    }
    case Travel::Wide: return fmt::format("0x{:x}", in.get<uint64_t>());
    case Travel::Fixed: {
        const auto* bytes = in.fixed<std::byte>(p.fixedBytes);
        return bytes == nullptr ? "" : arrayText(p.element, p.group, {bytes, p.fixedBytes});
    }
    case Travel::Texts: return textsText(in.data(), count);
    case Travel::Value:
    case Travel::Text: break;
    }
    return dataText(in.data(), p.travel, p.element, p.group);
}

std::string glText(uint16_t opcode, Args& in) {
    const CommandParameters command = parametersOf(opcode);
    std::string text;
    int64_t count = 0; // number of strings, from the preceding parameter
    for (const ParameterInfo& p : command.parameters) {
        const std::string value = argumentText(p, in, count);
        if (std::string_view(p.name) == "count") count = std::strtoll(value.c_str(), nullptr, 10);
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", p.name, value);
    }
    if (command.resultBytes == 4) text += fmt::format("{}made={}", text.empty() ? "" : ", ", in.get<uint32_t>());
    if (command.resultBytes == 8) text += fmt::format("{}made=0x{:x}", text.empty() ? "" : ", ", in.get<uint64_t>());
    return text;
}

} // namespace

std::string recordName(uint16_t opcode) {
    if (const char* name = opcode >= wire::kFirstGlOpcode ? glOpcodeName(opcode) : nullptr) return name;
    if (const OwnRecord* own = ownRecord(opcode)) return std::string("Mural.") + own->name;
    return fmt::format("opcode {}", opcode);
}

std::string recordText(const wire::RecordView& record, StreamBlobs& blobs) {
    const bool blob = blobs.take(record);
    Args in(record.arguments, blobs);
    std::string text = recordName(record.opcode) + "(";
    const OwnRecord* own = ownRecord(record.opcode);
    if (record.opcode == wire::kOpClientArrays)
        text += clientArraysText(in);
    else if (own != nullptr)
        text += ownText(*own, in);
    else if (record.opcode >= wire::kFirstGlOpcode && glOpcodeName(record.opcode) != nullptr)
        text += glText(record.opcode, in);
    else
        return text + fmt::format("{} bytes), unknown", record.arguments.size());
    const bool malformed = !in.ok() || (!blob && blobs.malformed());
    return text + (malformed ? "), malformed" : ")");
}

} // namespace mural::trace
