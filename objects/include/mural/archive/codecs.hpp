// Encoding, decoding and layout of each kind of field. A program may specialize Codec for a type of its own.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <mural/archive/decoder.hpp>
#include <mural/archive/encoder.hpp>
#include <mural/archive/fields.hpp>
#include <mural/archive/geometry_fields.hpp>
#include <mural/archive/layout.hpp>
#include <mural/ref.hpp>

namespace mural::archive {

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>;

template <class T> consteval bool isPlainEnum() {
    if constexpr (std::is_enum_v<T>) {
        return !std::is_same_v<std::underlying_type_t<T>, bool>;
    } else {
        return false;
    }
}

// True for types whose encoding equals their memory: numbers, and structures of numbers without padding whose fields
// are listed in the order of declaration. Arrays of such types are copied as a whole. A program may specialize it for a
// type of its own, such as a vertex.
template <class T> inline constexpr bool kIsPlain = Number<T> || isPlainEnum<T>();
template <class T, size_t N> inline constexpr bool kIsPlain<std::array<T, N>> = kIsPlain<T>;
template <> inline constexpr bool kIsPlain<Frustum> = true;
template <> inline constexpr bool kIsPlain<Matrix4> = true;
template <> inline constexpr bool kIsPlain<PixelKernel> = true;
template <> inline constexpr bool kIsPlain<PixelViewport> = true;
template <> inline constexpr bool kIsPlain<Range> = true;
template <> inline constexpr bool kIsPlain<SubPixel> = true;
template <> inline constexpr bool kIsPlain<Vector3> = true;
template <> inline constexpr bool kIsPlain<Viewport> = true;
template <> inline constexpr bool kIsPlain<Zoom> = true;

// The largest number of elements that are allocated before their bytes have been read.
constexpr size_t kMaxElementsAhead = 4096;

template <class T> constexpr bool kIsNeverAField = false;

template <class T>
constexpr bool kIsPointer = std::is_pointer_v<T> || std::is_member_pointer_v<T> || requires(T& pointer) {
    pointer.get() == &*pointer;
};

// The types without a specialization below cannot be fields.
template <class T> struct Codec {
    static_assert(!kIsPointer<T>,
                  "a pointer cannot be a field: use std::optional<T>, std::vector<T>, mural::Ref<T> or mural::Blob");
    static_assert(!std::is_same_v<T, long double>,
                  "long double differs between machines and cannot be a field: use double");
    static_assert(!std::is_reference_v<T>, "a reference cannot be a field: use a value or mural::Ref<T>");
    static_assert(
        kIsNeverAField<T>,
        "this type cannot be a field: give it a member `template <class V> void fields(V& v) { v(a, b); }`, or "
        "use a number, an enum, bool, std::array, vector, string, optional, variant, map, pair, mural::Ref or "
        "mural::Blob");
    static void encode(Encoder&, const T&) {}
    static void decode(Decoder&, T&) {}
    static void layout(LayoutWriter&) {}
};

template <> struct Codec<bool> {
    static void encode(Encoder& to, const bool& value) { to.plain(static_cast<uint8_t>(value)); }
    static void decode(Decoder& from, bool& value) {
        uint8_t byte = 0;
        if (!from.plain(byte)) return;
        if (byte > 1) return from.fail("is neither true nor false");
        value = byte != 0;
    }
    static void layout(LayoutWriter& to) { to.word("bool"); }
};

template <Number T> struct Codec<T> {
    static void encode(Encoder& to, const T& value) { to.plain(value); }
    static void decode(Decoder& from, T& value) { from.plain(value); }
    static void layout(LayoutWriter& to) {
        if constexpr (std::is_same_v<T, char>) {
            to.word("char"); // signed on some machines
        } else {
            to.word(std::is_floating_point_v<T> ? "float" : std::is_signed_v<T> ? "int" : "uint");
            to.word(std::to_string(8 * sizeof(T)));
        }
    }
};

template <class T>
requires std::is_enum_v<T>
struct Codec<T> {
    static void encode(Encoder& to, const T& value) { to.plain(value); }
    static void decode(Decoder& from, T& value) {
        std::underlying_type_t<T> number{};
        if constexpr (std::is_same_v<decltype(number), bool>) {
            Codec<bool>::decode(from, number);
        } else {
            from.plain(number);
        }
        if (from.ok()) value = static_cast<T>(number);
    }
    static void layout(LayoutWriter& to) {
        to.word("enum of ");
        to.kind<std::underlying_type_t<T>>();
    }
};

// Elements of a container whose size both ends know.
template <class T> struct Elements {
    static void encode(Encoder& to, const T* from, size_t count) {
        if constexpr (kIsPlain<T>) {
            to.bytes(from, count * sizeof(T));
        } else {
            for (size_t i = 0; i < count; ++i) Codec<T>::encode(to, from[i]);
        }
    }
    static void decode(Decoder& from, T* into, size_t count) {
        if constexpr (kIsPlain<T>) {
            const std::byte* const bytes = from.take(count * sizeof(T));
            if (bytes && count > 0) std::memcpy(static_cast<void*>(into), bytes, count * sizeof(T));
        } else {
            for (size_t i = 0; i < count && from.ok(); ++i) Codec<T>::decode(from, into[i]);
        }
    }
    static void layout(LayoutWriter& to, size_t count) {
        to.word(std::to_string(count) + " x ");
        to.kind<T>();
    }
};

template <class T, size_t N> struct Codec<std::array<T, N>> {
    static void encode(Encoder& to, const std::array<T, N>& value) { Elements<T>::encode(to, value.data(), N); }
    static void decode(Decoder& from, std::array<T, N>& value) { Elements<T>::decode(from, value.data(), N); }
    static void layout(LayoutWriter& to) { Elements<T>::layout(to, N); }
};

template <class T, size_t N> struct Codec<T[N]> {
    static void encode(Encoder& to, const T (&value)[N]) { Elements<T>::encode(to, value, N); }
    static void decode(Decoder& from, T (&value)[N]) { Elements<T>::decode(from, value, N); }
    static void layout(LayoutWriter& to) { Elements<T>::layout(to, N); }
};

// A list. The length of a list of plain elements takes 8 bytes, so a list at the beginning of a field is aligned.
template <class T, class Allocator> struct Codec<std::vector<T, Allocator>> {
    using List = std::vector<T, Allocator>;

    static void encode(Encoder& to, const List& value) {
        if constexpr (std::is_same_v<T, bool>) {
            to.count(value.size());
            for (const bool bit : value) to.plain(static_cast<uint8_t>(bit));
        } else if constexpr (kIsPlain<T>) {
            to.plain(static_cast<uint64_t>(value.size()));
            Elements<T>::encode(to, value.data(), value.size());
        } else {
            to.count(value.size());
            for (const T& element : value) Codec<T>::encode(to, element);
        }
    }
    static void decode(Decoder& from, List& value) {
        if constexpr (kIsPlain<T>) {
            decodePlain(from, value);
        } else {
            const uint32_t count = from.count();
            if (!from.ok()) return;
            value.clear();
            value.reserve(std::min<size_t>(count, kMaxElementsAhead));
            for (uint32_t i = 0; i < count && from.ok(); ++i) {
                T element{};
                const size_t before = from.left();
                Codec<T>::decode(from, element);
                if (from.left() == before) return from.fail("has elements without contents");
                value.push_back(std::move(element));
            }
        }
    }
    static void layout(LayoutWriter& to) {
        to.word("list of ");
        to.kind<T>();
    }

private:
    static void decodePlain(Decoder& from, List& value) {
        uint64_t count = 0;
        if (!from.plain(count)) return;
        if (count > from.left() / sizeof(T)) return from.fail("has a length beyond its end");
        const std::byte* const bytes = from.take(count * sizeof(T));
        if (reinterpret_cast<uintptr_t>(bytes) % alignof(T) == 0) { // one copy, without clearing the memory first
            const T* const elements = static_cast<const T*>(static_cast<const void*>(bytes));
            value.assign(elements, elements + count);
        } else {
            value.resize(count);
            if (count > 0) std::memcpy(static_cast<void*>(value.data()), bytes, count * sizeof(T));
        }
    }
};

template <> struct Codec<std::string> {
    static void encode(Encoder& to, const std::string& value) {
        to.count(value.size());
        to.bytes(value.data(), value.size());
    }
    static void decode(Decoder& from, std::string& value) {
        const uint32_t count = from.count();
        const std::byte* const bytes = from.take(count);
        if (bytes && from.ok()) value.assign(reinterpret_cast<const char*>(bytes), count);
    }
    static void layout(LayoutWriter& to) { to.word("text"); }
};

template <class T> struct Codec<std::optional<T>> {
    static void encode(Encoder& to, const std::optional<T>& value) {
        to.plain(static_cast<uint8_t>(value.has_value()));
        if (value) Codec<T>::encode(to, *value);
    }
    static void decode(Decoder& from, std::optional<T>& value) {
        bool isPresent = false;
        Codec<bool>::decode(from, isPresent);
        if (!from.ok()) return;
        value.reset();
        if (isPresent) Codec<T>::decode(from, value.emplace());
    }
    static void layout(LayoutWriter& to) {
        to.word("optional ");
        to.kind<T>();
    }
};

template <> struct Codec<std::monostate> {
    static void encode(Encoder&, const std::monostate&) {}
    static void decode(Decoder&, std::monostate&) {}
    static void layout(LayoutWriter& to) { to.word("nothing"); }
};

template <class... Types> struct Codec<std::variant<Types...>> {
    using Variant = std::variant<Types...>;
    static_assert(sizeof...(Types) < 255, "a variant field has at most 254 alternatives");

    static void encode(Encoder& to, const Variant& value) {
        to.plain(static_cast<uint8_t>(value.index()));
        if (!value.valueless_by_exception())
            std::visit([&]<class T>(const T& alternative) { Codec<T>::encode(to, alternative); }, value);
    }
    static void decode(Decoder& from, Variant& value) {
        uint8_t index = 0;
        if (!from.plain(index)) return;
        if (index >= sizeof...(Types)) return from.fail("has an unknown alternative");
        decodeAlternative(from, value, index, std::index_sequence_for<Types...>());
    }
    static void layout(LayoutWriter& to) {
        to.word("one of (");
        size_t i = 0;
        ((to.word(i++ > 0 ? " or " : ""), to.kind<Types>()), ...);
        to.word(")");
    }

private:
    template <size_t... Index>
    static void decodeAlternative(Decoder& from, Variant& value, size_t index, std::index_sequence<Index...>) {
        ((Index == index
              ? Codec<std::variant_alternative_t<Index, Variant>>::decode(from, value.template emplace<Index>())
              : void()),
         ...);
    }
};

template <class First, class Second> struct Codec<std::pair<First, Second>> {
    static void encode(Encoder& to, const std::pair<First, Second>& value) {
        Codec<std::remove_const_t<First>>::encode(to, value.first);
        Codec<Second>::encode(to, value.second);
    }
    static void decode(Decoder& from, std::pair<First, Second>& value) {
        Codec<First>::decode(from, value.first);
        Codec<Second>::decode(from, value.second);
    }
    static void layout(LayoutWriter& to) {
        to.word("(");
        to.kind<std::remove_const_t<First>>();
        to.word(", ");
        to.kind<Second>();
        to.word(")");
    }
};

template <class Key, class Value, class Order, class Allocator> struct Codec<std::map<Key, Value, Order, Allocator>> {
    using Map = std::map<Key, Value, Order, Allocator>;

    static void encode(Encoder& to, const Map& value) {
        to.count(value.size());
        for (const auto& entry : value) Codec<typename Map::value_type>::encode(to, entry);
    }
    // Accepts keys in ascending order only, because equal contents have equal bytes.
    static void decode(Decoder& from, Map& value) {
        const uint32_t count = from.count();
        if (!from.ok()) return;
        value.clear();
        for (uint32_t i = 0; i < count && from.ok(); ++i) {
            std::pair<Key, Value> entry{};
            const size_t before = from.left();
            Codec<std::pair<Key, Value>>::decode(from, entry);
            if (from.left() == before) return from.fail("has elements without contents");
            if (!value.empty() && !value.key_comp()(value.rbegin()->first, entry.first))
                return from.fail("has keys out of order");
            value.emplace_hint(value.end(), std::move(entry));
        }
    }
    static void layout(LayoutWriter& to) {
        to.word("map of ");
        to.kind<typename Map::value_type>();
    }
};

// A blob travels by name. Its bytes are sent before, or are requested by the reader.
template <> struct Codec<Blob> {
    static void encode(Encoder& to, const Blob& value) {
        to.plain(value.name());
        to.plain(static_cast<uint64_t>(value.sizeBytes()));
        if (!value.empty()) to.refer(value);
    }
    static void decode(Decoder& from, Blob& value) {
        BlobName name{};
        uint64_t sizeBytes = 0;
        if (!from.plain(name) || !from.plain(sizeBytes)) return;
        if (sizeBytes == 0) {
            value = Blob();
            return;
        }
        const Blob* const found = from.blobs() ? from.blobs()->find(name) : nullptr;
        if (!found) return from.fail("refers to a blob that has not arrived");
        if (found->sizeBytes() != sizeBytes) return from.fail("refers to a blob of another size");
        value = *found;
    }
    static void layout(LayoutWriter& to) { to.word("blob"); }
};

template <> struct Codec<AnyRef> {
    static void encode(Encoder& to, const AnyRef& value) {
        to.plain(value.id);
        to.plain(value.version);
    }
    static void decode(Decoder& from, AnyRef& value) {
        from.plain(value.id);
        from.plain(value.version);
    }
    static void layout(LayoutWriter& to) { to.word("reference"); }
};
template <class T> struct Codec<Ref<T>> : Codec<AnyRef> {};

template <HasFields T> struct Codec<T> {
    static void encode(Encoder& to, const T& value) {
        if constexpr (kIsPlain<T>) {
            to.plain(value);
        } else {
            visitFields(to, value);
        }
    }
    static void decode(Decoder& from, T& value) {
        if constexpr (kIsPlain<T>) {
            from.plain(value);
        } else {
            visitFields(from, value);
        }
    }
    static void layout(LayoutWriter& to) {
        to.structure<T>([](LayoutWriter& inside) { visitFields(inside, T{}); });
    }
};

} // namespace mural::archive
