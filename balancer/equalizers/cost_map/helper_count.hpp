// Decides how many children work. Each helper shortens the drawing and lengthens the assembly by the destination, so a
// helper that costs more than it saves is released; it returns when the work grows.
#pragma once

#include <cstddef>

namespace mural::balance {

class HelperCount {
public:
    // work: time of all children together. assembly: time of the destination for the pictures of `helpers` helpers.
    void observe(double work, double assembly, size_t helpers);
    // Returns the number of helpers that work, of `all`. gain: least reduction of the frame time that pays a change.
    // drawsItself: the destination draws, too.
    size_t choose(size_t all, bool drawsItself, double gain);
    [[nodiscard]] size_t working(size_t all) const { return isChosen_ && chosen_ < all ? chosen_ : all; }

private:
    [[nodiscard]] double frameTime(size_t helpers, bool drawsItself) const;

    double work_ = 0;
    double assemblyPerHelper_ = 0;
    bool hasAssembly_ = false;
    bool isChosen_ = false;
    size_t chosen_ = 0;
    int frames_ = 0; // since the last change
};

} // namespace mural::balance
