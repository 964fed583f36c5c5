// Finds out how a type lists its fields.
#pragma once

#include <type_traits>

namespace mural::archive {

// Stands for any visitor when a type is examined.
struct AnyVisitor {
    template <class... Fields> void operator()(Fields&...) {}
    template <class Field> AnyVisitor& operator&(Field&) { return *this; }
};

// struct Scene { double angle; template <class Visit> void fields(Visit& visit) { visit(angle); } };
template <class T> concept HasMemberFields = requires(T& value, AnyVisitor& visit) { value.fields(visit); };

// template <class Visit> void fields(Visit& visit, Scene& scene) { visit(scene.angle); }  in the namespace of Scene
template <class T> concept HasFreeFields = requires(T& value, AnyVisitor& visit) { fields(visit, value); };

// struct Scene { double angle; template <class Archive> void serialize(Archive& archive) { archive(angle); } };
template <class T> concept HasSerialize = requires(T& value, AnyVisitor& visit) { value.serialize(visit); };

template <class T> concept HasFields = HasMemberFields<T> || HasFreeFields<T> || HasSerialize<T>;

// Passes all fields of `value` to a visitor, in one or several calls. Visitors for encoding do not write, so `value`
// may be constant.
template <class Visitor, class T> void visitFields(Visitor& visit, const T& value) {
    T& mutableValue = const_cast<T&>(value);
    if constexpr (HasMemberFields<T>) {
        mutableValue.fields(visit);
    } else if constexpr (HasFreeFields<T>) {
        fields(visit, mutableValue);
    } else {
        mutableValue.serialize(visit);
    }
}

} // namespace mural::archive
