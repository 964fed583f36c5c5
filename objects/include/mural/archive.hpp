// Objects as bytes: the fields of a type, listed once, give its encoding, its decoding, change detection and a check of
// its layout.
//
//   struct Scene {
//       double angle = 0;
//       std::vector<Light> lights;
//       template <class Visit> void fields(Visit& visit) { visit(angle, lights); }
//   };
//
// A type must be default-constructible and copyable. A member function `serialize(archive)` in the form of the library
// cereal serves as well, and so does a free function `fields(visit, scene)` in the namespace of the type. A type
// without fields of its own, such as a vector of numbers, counts as one field.
//
// Fields: numbers except long double, enums, bool, std::array, vector, string, optional, variant, map and pair,
// geometry types, Blob, Ref, and structures of these.
//
// A slot is the unit of change detection. Each of the first 63 fields is a slot; all further fields share slot 63.
#pragma once

#include <cstdint>
#include <string>

#include <mural/archive/codecs.hpp>

namespace mural::archive {

constexpr uint32_t kMaxSlots = 64;
[[nodiscard]] constexpr uint32_t slotOf(uint32_t field) { return field < kMaxSlots ? field : kMaxSlots - 1; }
[[nodiscard]] constexpr uint32_t slotsOf(uint32_t fieldCount) { return slotOf(fieldCount - 1) + 1; }

// Passes each top-level field to operation(field number, field).
template <class Operation> class FieldEnumerator {
public:
    explicit FieldEnumerator(Operation& operation) : operation_(operation) {}
    template <class... Fields> void operator()(Fields&... fields) { (operation_(next_++, fields), ...); }
    template <class Field> FieldEnumerator& operator&(Field& field) {
        (*this)(field);
        return *this;
    }
    [[nodiscard]] uint32_t count() const { return next_; }

private:
    Operation& operation_;
    uint32_t next_ = 0;
};

// Calls operation(field number, field) for each top-level field of a constant or mutable object. Returns their number.
template <class T, class Operation> uint32_t forEachField(T& object, Operation&& operation) {
    if constexpr (HasFields<std::remove_const_t<T>>) {
        FieldEnumerator<std::remove_reference_t<Operation>> enumerator(operation);
        visitFields(enumerator, object);
        return enumerator.count();
    } else {
        operation(0, object);
        return 1;
    }
}

// Returns the layout of T; computed at the first call. Two layouts that encode equally may differ in their hash.
template <class T> const TypeLayout& layoutOf() {
    static_assert(
        std::is_default_constructible_v<T> && std::is_copy_constructible_v<T>,
        "a distributed type must be default-constructible and copyable; in place of a reference use a value or "
        "mural::Ref<T>");
    static const TypeLayout layout = [] {
        TypeLayout made;
        made.typeName = typeNameOf<T>();
        LayoutWriter writer;
        writer.kind<T>();
        made.text = writer.text();
        made.hash = hashOf(made.text);
        T probe{};
        made.fieldCount = forEachField(probe, [](uint32_t, const auto&) {});
        return made;
    }();
    return layout;
}

// The slots of one object as bytes. Reuse it to reuse its memory.
struct EncodedSlots {
    Encoder encoder;
    uint32_t count = 0;
    size_t ends[kMaxSlots] = {};     // in encoder.out()
    size_t blobEnds[kMaxSlots] = {}; // in encoder.blobs()

    [[nodiscard]] std::span<const std::byte> bytesOf(uint32_t slot) const {
        return encoder.out().bytes(slot == 0 ? 0 : ends[slot - 1], ends[slot]);
    }
    [[nodiscard]] std::span<const Blob> blobsOf(uint32_t slot) const {
        const size_t from = slot == 0 ? 0 : blobEnds[slot - 1];
        return std::span(encoder.blobs()).subspan(from, blobEnds[slot] - from);
    }
};

// Encodes all fields.
template <class T> void encodeSlots(const T& object, EncodedSlots& into) {
    into.encoder.clear();
    into.count = 0;
    forEachField(object, [&into]<class Field>(uint32_t number, const Field& field) {
        Codec<std::remove_const_t<Field>>::encode(into.encoder, field);
        const uint32_t slot = slotOf(number);
        into.ends[slot] = into.encoder.out().size();
        into.blobEnds[slot] = into.encoder.blobs().size();
        into.count = slot + 1;
    });
}

// Encodes one field.
template <class T> void encodeField(const T& object, uint32_t number, Encoder& to) {
    forEachField(object, [&]<class Field>(uint32_t at, const Field& field) {
        if (at == number) Codec<std::remove_const_t<Field>>::encode(to, field);
    });
}

// Decodes the slots whose bit is set in `slots`. bytesOf(slot) returns the encoded slot. Returns an error that begins
// with the number of the field, counted from 1; the object is then partly changed.
template <class T, class BytesOf>
Result<void> decodeSlots(T& object, uint64_t slots, const BlobSource* blobs, BytesOf&& bytesOf) {
    Decoder last({});
    uint32_t lastField = 0;
    std::string problem;
    const auto finishSlot = [&] {
        if (problem.empty() && last.ok() && last.left() > 0) last.fail("has more bytes than expected");
        if (problem.empty() && !last.ok())
            problem = "field " + std::to_string(lastField + 1) + " " + std::string(last.problem());
    };
    forEachField(object, [&]<class Field>(uint32_t number, Field& field) {
        const uint32_t slot = slotOf(number);
        if ((slots >> slot & 1) == 0 || !problem.empty()) return;
        if (number == slot) { // the first field of its slot
            finishSlot();
            last = Decoder(bytesOf(slot), blobs);
        }
        lastField = number;
        last(field);
    });
    finishSlot();
    if (problem.empty()) return {};
    return Error{problem};
}

} // namespace mural::archive
