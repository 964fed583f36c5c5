#include "nodes/culling/linear_view.hpp"

#include <algorithm>
#include <cmath>

namespace mural::culling {

namespace {

// Operations of one coefficient: the product of the matrices, then the product with the position. Drivers that multiply
// by both matrices in turn stay below it as well.
constexpr double kOperations = 24;

LinearForm formOfRow(const float (&projection)[16], const float (&modelview)[16], size_t row, size_t components) {
    LinearForm form;
    for (size_t column = 0; column < 4; ++column) {
        double factor = 0, magnitude = 0;
        for (size_t k = 0; k < 4; ++k) {
            const double product = double{projection[4 * k + row]} * modelview[4 * column + k];
            factor += product;
            magnitude += std::abs(product);
        }
        const bool isInput = column < components;
        if (!isInput && column < 3) continue; // a missing z is 0
        (isInput ? form.factor[column] : form.constant) = factor;
        (isInput ? form.error[column] : form.constantError) = kOperations * kRounding * magnitude;
    }
    return form;
}

} // namespace

bool LinearForm::isConstant() const {
    const auto isZero = [](double value) { return value == 0; };
    return std::ranges::all_of(factor, isZero) && std::ranges::all_of(error, isZero);
}

LinearView fixedFunctionView(const float (&projection)[16], const float (&modelview)[16], size_t components) {
    return {components, formOfRow(projection, modelview, 0, components),
            formOfRow(projection, modelview, 1, components), formOfRow(projection, modelview, 3, components)};
}

} // namespace mural::culling
