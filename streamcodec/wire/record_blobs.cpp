#include "streamcodec/wire/record_blobs.hpp"

#include "streamcodec/wire/args.hpp"
#include "streamcodec/wire/client_arrays.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::wire {
namespace {

class CountingQueue : public BlobQueue {
public:
    std::span<const std::byte> takeBlob(bool& found) override {
        ++taken;
        found = true;
        return {};
    }
    size_t taken = 0;
};

void skip(Args& in, size_t bytes) { (void)in.fixed<std::byte>(bytes); }

void readClientArrays(Args& in) {
    const auto arrays = in.get<uint32_t>(), spans = in.get<uint32_t>();
    if (arrays > client_arrays::kSlots) return;
    skip(in, arrays * sizeof(client_arrays::ArrayRecord));
    for (uint32_t i = 0; i < spans && in.ok(); ++i) (void)in.data();
}

void readGl(Args& in, uint16_t opcode) {
    for (const ParameterInfo& p : parametersOf(opcode).parameters) {
        switch (p.travel) {
        case Travel::Scalar: skip(in, bytesOf(p.element)); break;
        case Travel::Wide: skip(in, 8); break;
        case Travel::Fixed: skip(in, p.fixedBytes); break;
        default: (void)in.data();
        }
    }
}

} // namespace

size_t blobsTakenBy(const RecordView& record) {
    CountingQueue queue;
    Args in(record.arguments, queue);
    switch (record.opcode) {
    case kOpClientArrays: readClientArrays(in); break;
    case kOpFillWindow: skip(in, 20), (void)in.data(); break;
    case kOpProgramLayout:
    case kOpProgramRecipe: skip(in, 4), (void)in.data(); break;
    case kOpBufferBytes: skip(in, 12), (void)in.data(); break;
    default: readGl(in, record.opcode); // not a control record
    }
    return queue.taken;
}

} // namespace mural::wire
