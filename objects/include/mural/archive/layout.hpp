// Describes the fields of a type in words. Both ends compare the descriptions before they exchange values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mural::archive {

template <class T> struct Codec; // mural/archive/codecs.hpp

// The address identifies a type within a process.
template <class T> inline constexpr char kTypeMark = 0;

// The visitor that `fields` receives while a layout is described. Lists the kinds of the fields, for example
// "float64, list of (float32, float32), text".
class LayoutWriter {
public:
    template <class... Fields> void operator()(Fields&...) { (add<std::remove_const_t<Fields>>(), ...); }
    template <class Field> LayoutWriter& operator&(Field& field) {
        (*this)(field);
        return *this;
    }

    // Appends one field, after a separator.
    template <class T> void add() {
        if (count_++ > 0) text_ += separator();
        kind<T>();
    }
    // Appends the description of a type without a separator.
    template <class T> void kind() { Codec<T>::layout(*this); }
    void word(std::string_view word) { text_ += word; }

    // Appends the fields of a structure in parentheses. A type within itself is described by its distance.
    template <class T, class Visit> void structure(Visit&& visit) {
        const void* const mark = &kTypeMark<T>;
        if (const auto at = std::find(open_.rbegin(), open_.rend(), mark); at != open_.rend()) {
            text_ += "itself " + std::to_string(at - open_.rbegin() + 1) + " up";
            return;
        }
        const bool isTop = text_.empty() && open_.empty();
        if (isTop) hasTopFields_ = true;
        open_.push_back(mark);
        const size_t outer = std::exchange(count_, 0);
        if (!isTop) text_ += '(';
        visit(*this);
        if (!isTop) text_ += ')';
        count_ = outer;
        open_.pop_back();
    }

    [[nodiscard]] const std::string& text() const { return text_; }

private:
    [[nodiscard]] const char* separator() const { return hasTopFields_ && open_.size() == 1 ? "; " : ", "; }

    std::string text_;
    size_t count_ = 0;
    bool hasTopFields_ = false;     // the described type itself is a structure
    std::vector<const void*> open_; // structures around the current field
};

// The layout of a type; both ends of an object must have the same.
struct TypeLayout {
    std::string typeName;
    std::string text;        // fields in words, separated by "; "
    uint64_t hash = 0;       // of the text; equal on all builds
    uint32_t fieldCount = 0; // at least 1
};

// Returns the XXH3-64 of bytes.
uint64_t hashOf(std::span<const std::byte> bytes);
uint64_t hashOf(std::string_view text);

// Returns the first difference of two layouts as the rest of a sentence: "field 2 is text here and int32 there".
std::string differenceOf(std::string_view here, std::string_view there);

// Returns the name of a type as the compiler prints it.
template <class T> std::string typeNameOf() {
    const std::string_view function =
        __PRETTY_FUNCTION__; // "... [with T = Scene; std::string = ...]", clang: "[T = Scene]"
    const size_t from = function.find("T = ") + 4;
    const size_t end = std::min(function.find(';', from), function.rfind(']'));
    return std::string(function.substr(from, end - from));
}

} // namespace mural::archive
