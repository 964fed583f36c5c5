// Expressions of a shader (slice_interpreter.hpp).
#include <algorithm>
#include <utility>

#include "nodes/culling/slice_interpreter.hpp"

namespace mural::culling {

using namespace glslang;

namespace {

constexpr size_t kMaxScalars = 1 << 16;

bool isWholeType(const TType& type) {
    const TBasicType basic = type.getBasicType();
    return basic == EbtInt || basic == EbtUint || basic == EbtBool;
}

bool isScalarType(const TType& type) {
    const TBasicType basic = type.getBasicType();
    return basic == EbtFloat || basic == EbtInt || basic == EbtUint || basic == EbtBool;
}

size_t rowsOf(const TIntermTyped* node) { return static_cast<size_t>(node->getMatrixRows()); }

double constantOf(const TConstUnion& value) {
    switch (value.getType()) {
    case EbtInt: return value.getIConst();
    case EbtUint: return value.getUConst();
    case EbtBool: return value.getBConst() ? 1 : 0;
    case EbtFloat:
    case EbtDouble: return static_cast<double>(static_cast<float>(value.getDConst()));
    default: return 0;
    }
}

SliceValue part(const SliceValue& value, size_t from, size_t count) {
    if (from + count > value.size()) return SliceValue(count, kUnknown);
    return {value.begin() + static_cast<ptrdiff_t>(from), value.begin() + static_cast<ptrdiff_t>(from + count)};
}

TOperator plainOperator(TOperator op) {
    switch (op) {
    case EOpAddAssign: return EOpAdd;
    case EOpSubAssign: return EOpSub;
    case EOpMulAssign: return EOpMul;
    case EOpDivAssign: return EOpDiv;
    case EOpVectorTimesMatrixAssign: return EOpVectorTimesMatrix;
    case EOpVectorTimesScalarAssign: return EOpVectorTimesScalar;
    case EOpMatrixTimesScalarAssign: return EOpMatrixTimesScalar;
    case EOpMatrixTimesMatrixAssign: return EOpMatrixTimesMatrix;
    default: return EOpNull;
    }
}

bool isConversion(TOperator op) {
    return op == EOpConvIntToFloat || op == EOpConvUintToFloat || op == EOpConvBoolToFloat || op == EOpConvIntToUint ||
           op == EOpConvBoolToInt || op == EOpConvBoolToUint || op == EOpConvUintToInt;
}

} // namespace

size_t scalarsOf(const TType& type) {
    size_t count = 1;
    if (type.isArray()) {
        if (type.isUnsizedArray() || type.getArraySizes()->getNumDims() != 1) return 0;
        count = static_cast<size_t>(std::max(type.getOuterArraySize(), 0));
    }
    if (type.isStruct()) {
        size_t members = 0;
        for (const TTypeLoc& member : *type.getStruct()) members += scalarsOf(*member.type);
        count *= members;
    } else if (type.isMatrix()) {
        count *= static_cast<size_t>(type.getMatrixCols() * type.getMatrixRows());
    } else {
        count *= static_cast<size_t>(std::max(type.getVectorSize(), 1));
    }
    return count > kMaxScalars ? 0 : count;
}

size_t memberOffset(const TType& structure, size_t member) {
    size_t offset = 0;
    for (size_t i = 0; i < member; ++i) offset += scalarsOf(*(*structure.getStruct())[i].type);
    return offset;
}

// Appends a node for each scalar of a uniform or an attribute. Those that GL does not name become unknown.
void SliceInterpreter::addSources(const TType& type, const std::string& name, bool isUniform, SliceValue& out) {
    if (type.isArray()) {
        const TType element(type, 0);
        for (int i = 0; i < type.getOuterArraySize(); ++i)
            addSources(element, name + "[" + std::to_string(i) + "]", isUniform, out);
        return;
    }
    if (type.isStruct()) {
        for (const TTypeLoc& member : *type.getStruct())
            addSources(*member.type, name + "." + textOf(member.type->getFieldName()), isUniform, out);
        return;
    }
    if (name == "gl_ModelViewProjectionMatrix") {
        SliceValue projection, modelview;
        for (uint32_t i = 0; i < 16; ++i) projection.push_back(builder_.uniform("gl_ProjectionMatrix", i));
        for (uint32_t i = 0; i < 16; ++i) modelview.push_back(builder_.uniform("gl_ModelViewMatrix", i));
        out = builder_.matrixTimesMatrix(projection, modelview, 4, 4);
        return;
    }
    const size_t count = scalarsOf(type);
    const bool isKnown = isUniform ? isScalarType(type) : type.getBasicType() == EbtFloat && !type.isMatrix();
    for (size_t i = 0; i < count; ++i) {
        const auto component = static_cast<uint32_t>(i);
        out.push_back(!isKnown    ? kUnknown
                      : isUniform ? builder_.uniform(name, component)
                                  : builder_.input(name, component));
    }
}

SliceValue& SliceInterpreter::variable(TIntermSymbol* symbol) {
    const auto [it, isNew] = variables_.try_emplace(symbol->getId());
    if (!isNew) return it->second;
    symbols_.try_emplace(symbol->getId(), symbol);
    const TType& type = symbol->getType();
    const TStorageQualifier storage = symbol->getQualifier().storage;
    const size_t count = scalarsOf(type);
    const bool isBlock = type.getBasicType() == EbtBlock;
    const bool isSource = count > 0 && !isBlock && (storage == EvqUniform || storage == EvqVaryingIn);
    // Arrays of attributes are several attributes.
    if (isSource && (storage == EvqUniform || !(type.isArray() || type.isStruct())))
        addSources(type, textOf(symbol->getName()), storage == EvqUniform, it->second);
    it->second.resize(count, kUnknown);
    return it->second;
}

SliceValue SliceInterpreter::evalSymbol(TIntermSymbol* symbol) {
    const TConstUnionArray& constants = symbol->getConstArray();
    // The constant of a uniform is only its initial value.
    if (constants.empty() || symbol->getQualifier().storage == EvqUniform) return variable(symbol);
    SliceValue value;
    for (int i = 0; i < constants.size(); ++i) value.push_back(builder_.constant(constantOf(constants[i])));
    return value;
}

SliceInterpreter::Target SliceInterpreter::targetOf(Typed* node) {
    if (auto* const symbol = node->getAsSymbolNode()) {
        Target target{symbol, {}, true};
        for (size_t i = 0; i < variable(symbol).size(); ++i) target.scalars.push_back(i);
        return target;
    }
    auto* const b = node->getAsBinaryNode();
    if (!b) return {nullptr, {}, false};
    Target target = targetOf(b->getLeft());
    const auto narrow = [&](size_t from, size_t count) {
        if (from + count > target.scalars.size()) {
            target.isKnown = false;
            return;
        }
        target.scalars = {target.scalars.begin() + static_cast<ptrdiff_t>(from),
                          target.scalars.begin() + static_cast<ptrdiff_t>(from + count)};
    };
    const size_t size = scalarsOf(node->getType());
    switch (b->getOp()) {
    case EOpIndexDirect:
    case EOpIndexIndirect: {
        const SliceValue index = eval(b->getRight());
        const double* const at = index.size() == 1 ? builder_.known(index[0]) : nullptr;
        if (at && *at >= 0)
            narrow(static_cast<size_t>(*at) * size, size);
        else
            target.isKnown = false;
        return target;
    }
    case EOpIndexDirectStruct: {
        const auto member = static_cast<size_t>(b->getRight()->getAsConstantUnion()->getConstArray()[0].getIConst());
        narrow(memberOffset(b->getLeft()->getType(), member), size);
        return target;
    }
    case EOpVectorSwizzle: {
        std::vector<size_t> chosen;
        for (TIntermNode* component : b->getRight()->getAsAggregate()->getSequence()) {
            const auto at = static_cast<size_t>(component->getAsConstantUnion()->getConstArray()[0].getIConst());
            if (at >= target.scalars.size()) return {target.symbol, {}, false};
            chosen.push_back(target.scalars[at]);
        }
        target.scalars = chosen;
        return target;
    }
    default: target.isKnown = false; return target;
    }
}

SliceValue SliceInterpreter::assign(Typed* to, SliceValue value) {
    const Target target = targetOf(to);
    if (!target.symbol) throw Unfollowed{"an assignment to an unknown place"};
    SliceValue& all = variable(target.symbol);
    if (!target.isKnown || value.size() != target.scalars.size()) {
        all.assign(all.size(), kUnknown);
        return SliceValue(scalarsOf(to->getType()), kUnknown);
    }
    for (size_t i = 0; i < value.size(); ++i) all[target.scalars[i]] = value[i];
    return value;
}

SliceValue SliceInterpreter::eval(TIntermNode* node) {
    if (!node) return {};
    if (++steps_ > 200'000) throw Unfollowed{"too many operations"};
    if (auto* const constant = node->getAsConstantUnion()) {
        SliceValue value;
        for (int i = 0; i < constant->getConstArray().size(); ++i)
            value.push_back(builder_.constant(constantOf(constant->getConstArray()[i])));
        return value;
    }
    if (auto* const symbol = node->getAsSymbolNode()) return evalSymbol(symbol);
    if (auto* const unary = node->getAsUnaryNode()) return evalUnary(unary);
    if (auto* const binary = node->getAsBinaryNode()) return evalBinary(binary);
    if (auto* const selection = node->getAsSelectionNode()) {
        const SliceValue condition = eval(selection->getCondition());
        const double* const is = condition.size() == 1 ? builder_.known(condition[0]) : nullptr;
        if (is) return eval(*is != 0 ? selection->getTrueBlock() : selection->getFalseBlock());
        if (assigns(selection->getTrueBlock()) || assigns(selection->getFalseBlock()))
            throw Unfollowed{"an assignment on a condition"};
        const SliceValue first = eval(selection->getTrueBlock()), second = eval(selection->getFalseBlock());
        return builder_.select(condition.size() == 1 ? condition[0] : kUnknown, first, second);
    }
    if (Aggregate* const aggregate = node->getAsAggregate()) return evalAggregate(aggregate);
    throw Unfollowed{"an unknown expression"};
}

SliceValue SliceInterpreter::evalUnary(TIntermUnary* node) {
    const TOperator op = node->getOp();
    const SliceValue value = eval(node->getOperand());
    const bool isWhole = isWholeType(node->getOperand()->getType());
    if (isConversion(op)) return value;
    const bool isUp = op == EOpPreIncrement || op == EOpPostIncrement;
    if (isUp || op == EOpPreDecrement || op == EOpPostDecrement) {
        const SliceValue next =
            builder_.each(isUp ? SliceOp::Add : SliceOp::Subtract, value, {builder_.constant(1)}, isWhole);
        assign(node->getOperand(), next);
        return op == EOpPreIncrement || op == EOpPreDecrement ? next : value;
    }
    switch (op) {
    case EOpNegative: return builder_.eachOne(SliceOp::Negate, value, isWhole);
    case EOpLogicalNot:
    case EOpVectorLogicalNot: return builder_.eachOne(SliceOp::Not, value, true);
    case EOpAbs: return builder_.eachOne(SliceOp::Absolute, value);
    case EOpSqrt: return builder_.eachOne(SliceOp::SquareRoot, value);
    case EOpInverseSqrt:
        return builder_.each(SliceOp::Divide, {builder_.constant(1)}, builder_.eachOne(SliceOp::SquareRoot, value));
    case EOpSin: return builder_.eachOne(SliceOp::Sine, value);
    case EOpCos: return builder_.eachOne(SliceOp::Cosine, value);
    case EOpRadians: return builder_.each(SliceOp::Multiply, value, {builder_.constant(0.017453292519943295)});
    case EOpLength: return {builder_.make(SliceOp::SquareRoot, builder_.dot(value, value), 0)};
    case EOpNormalize:
        return builder_.each(SliceOp::Divide, value,
                             {builder_.make(SliceOp::SquareRoot, builder_.dot(value, value), 0)});
    case EOpTranspose: {
        const size_t rows = rowsOf(node->getOperand());
        SliceValue turned;
        for (size_t row = 0; row < rows; ++row)
            for (size_t at = row; at < value.size(); at += rows) turned.push_back(value[at]);
        return turned;
    }
    default: return SliceValue(scalarsOf(node->getType()), kUnknown);
    }
}

SliceValue SliceInterpreter::evalBinary(TIntermBinary* node) {
    const TOperator op = node->getOp();
    if (op == EOpAssign) return assign(node->getLeft(), eval(node->getRight()));
    const SliceValue a = eval(node->getLeft());
    const size_t size = scalarsOf(node->getType());
    switch (op) {
    case EOpIndexDirect:
    case EOpIndexIndirect: {
        const SliceValue index = eval(node->getRight());
        const double* const at = index.size() == 1 ? builder_.known(index[0]) : nullptr;
        return at && *at >= 0 ? part(a, static_cast<size_t>(*at) * size, size) : SliceValue(size, kUnknown);
    }
    case EOpIndexDirectStruct: {
        const auto member = static_cast<size_t>(node->getRight()->getAsConstantUnion()->getConstArray()[0].getIConst());
        return part(a, memberOffset(node->getLeft()->getType(), member), size);
    }
    case EOpVectorSwizzle: {
        SliceValue chosen;
        for (TIntermNode* component : node->getRight()->getAsAggregate()->getSequence()) {
            const auto at = static_cast<size_t>(component->getAsConstantUnion()->getConstArray()[0].getIConst());
            chosen.push_back(at < a.size() ? a[at] : kUnknown);
        }
        return chosen;
    }
    default: break;
    }
    if ((op == EOpLogicalAnd || op == EOpLogicalOr) && assigns(node->getRight()))
        throw Unfollowed{"an assignment on a condition"};
    const SliceValue b = eval(node->getRight());
    const TOperator plain = plainOperator(op);
    SliceValue value =
        operation(plain != EOpNull ? plain : op, node->getLeft(), node->getRight(), a, b, node->getType());
    if (plain != EOpNull) return assign(node->getLeft(), std::move(value));
    if (node->modifiesState()) return assign(node->getLeft(), SliceValue(a.size(), kUnknown));
    return value;
}

SliceValue SliceInterpreter::operation(TOperator op, const Typed* left, const Typed* right, const SliceValue& a,
                                       const SliceValue& b, const TType& type) {
    const bool isWhole = isWholeType(left->getType()) && isWholeType(right->getType());
    const bool areScalars = a.size() == 1 && b.size() == 1;
    const auto unknown = [&] { return SliceValue(scalarsOf(type), kUnknown); };
    const auto one = [&](SliceOp what, uint32_t x, uint32_t y) {
        return areScalars ? SliceValue{builder_.make(what, x, y, isWhole)} : unknown();
    };
    const auto inverse = [&](const SliceValue& value) { return builder_.eachOne(SliceOp::Not, value, true); };
    switch (op) {
    case EOpAdd: return builder_.each(SliceOp::Add, a, b, isWhole);
    case EOpSub: return builder_.each(SliceOp::Subtract, a, b, isWhole);
    case EOpMul:
    case EOpVectorTimesScalar:
    case EOpMatrixTimesScalar: return builder_.each(SliceOp::Multiply, a, b, isWhole);
    case EOpDiv: return isWhole ? unknown() : builder_.each(SliceOp::Divide, a, b);
    case EOpMatrixTimesVector: return builder_.matrixTimesVector(a, b, rowsOf(left));
    case EOpVectorTimesMatrix: return builder_.vectorTimesMatrix(a, b, rowsOf(right));
    case EOpMatrixTimesMatrix: return builder_.matrixTimesMatrix(a, b, rowsOf(left), rowsOf(right));
    case EOpLessThan: return one(SliceOp::Less, a[0], b[0]);
    case EOpGreaterThan: return one(SliceOp::Less, b[0], a[0]);
    case EOpLessThanEqual: return inverse(one(SliceOp::Less, b[0], a[0]));
    case EOpGreaterThanEqual: return inverse(one(SliceOp::Less, a[0], b[0]));
    case EOpEqual: return one(SliceOp::Equal, a[0], b[0]);
    case EOpNotEqual: return inverse(one(SliceOp::Equal, a[0], b[0]));
    case EOpLogicalAnd: return one(SliceOp::And, a[0], b[0]);
    case EOpLogicalOr: return inverse(one(SliceOp::And, inverse({a[0]})[0], inverse({b[0]})[0]));
    default: return unknown();
    }
}

// Vectors from scalars and vectors, matrices from a scalar, from components, or from another matrix of their size.
SliceValue SliceInterpreter::construct(Aggregate* node) {
    const size_t size = scalarsOf(node->getType());
    SliceValue parts;
    bool hasMatrix = false;
    for (TIntermNode* argument : node->getSequence()) {
        const SliceValue value = eval(argument);
        hasMatrix = hasMatrix || argument->getAsTyped()->isMatrix();
        parts.insert(parts.end(), value.begin(), value.end());
    }
    const bool toWhole = isWholeType(node->getType());
    for (TIntermNode* argument : node->getSequence())
        if (toWhole && !isWholeType(argument->getAsTyped()->getType())) return SliceValue(size, kUnknown);
    if (node->isMatrix()) {
        const size_t rows = rowsOf(node);
        if (parts.size() == 1) {
            SliceValue diagonal(size, kUnknown);
            for (size_t i = 0; i < size; ++i) diagonal[i] = i / rows == i % rows ? parts[0] : builder_.constant(0);
            return diagonal;
        }
        if (!hasMatrix) return part(parts, 0, size);
        Typed* const from = node->getSequence()[0]->getAsTyped();
        const size_t fromRows = rowsOf(from);
        SliceValue matrix(size, kUnknown);
        for (size_t i = 0; i < size; ++i) {
            const size_t column = i / rows, row = i % rows, at = column * fromRows + row;
            const bool isInside = row < fromRows && at < parts.size();
            matrix[i] = isInside ? parts[at] : builder_.constant(row == column ? 1 : 0);
        }
        return matrix;
    }
    if (parts.size() == 1 && size > 1 && !node->isStruct() && !node->isArray()) return SliceValue(size, parts[0]);
    return part(parts, 0, size);
}

SliceValue SliceInterpreter::evalAggregate(Aggregate* node) {
    const TOperator op = node->getOp();
    if (op == EOpFunctionCall) return call(node);
    if (op > EOpConstructGuardStart && op < EOpConstructGuardEnd) return construct(node);
    const TIntermSequence& arguments = node->getSequence();
    if (op == EOpComma) {
        SliceValue value;
        for (TIntermNode* argument : arguments) value = eval(argument);
        return value;
    }
    if (op == EOpSequence || op == EOpNull) {
        if (runSequence(node) != Flow::Next) throw Unfollowed{"a branch in an expression"};
        return {};
    }
    if (op == EOpFtransform) {
        SliceValue matrix, vertex;
        addSources(TType(EbtFloat, EvqUniform, 0, 4, 4), "gl_ModelViewProjectionMatrix", true, matrix);
        for (uint32_t i = 0; i < 4; ++i) vertex.push_back(builder_.input("gl_Vertex", i));
        return builder_.matrixTimesVector(matrix, vertex, 4);
    }
    const SliceValue unknown(scalarsOf(node->getType()), kUnknown);
    std::vector<SliceValue> values;
    for (TIntermNode* argument : arguments) {
        if (!argument->getAsTyped()) throw Unfollowed{"an unknown argument"};
        values.push_back(eval(argument));
    }
    if (node->modifiesState() || op == EOpModf || op == EOpFrexp) {
        forget(node);
        return unknown;
    }
    const auto binary = [&](SliceOp what) {
        return values.size() == 2 ? builder_.each(what, values[0], values[1]) : unknown;
    };
    switch (op) {
    case EOpMin: return binary(SliceOp::Minimum);
    case EOpMax: return binary(SliceOp::Maximum);
    case EOpClamp:
        if (values.size() != 3) return unknown;
        return builder_.each(SliceOp::Minimum, builder_.each(SliceOp::Maximum, values[0], values[1]), values[2]);
    case EOpMul: return binary(SliceOp::Multiply); // matrixCompMult
    case EOpDot: return values.size() == 2 ? SliceValue{builder_.dot(values[0], values[1])} : unknown;
    case EOpMix: {
        if (values.size() != 3 || isWholeType(arguments[2]->getAsTyped()->getType())) return unknown;
        const SliceValue rest = builder_.each(SliceOp::Subtract, {builder_.constant(1)}, values[2]);
        return builder_.each(SliceOp::Add, builder_.each(SliceOp::Multiply, values[0], rest),
                             builder_.each(SliceOp::Multiply, values[1], values[2]));
    }
    case EOpCross: {
        if (values.size() != 2 || values[0].size() != 3 || values[1].size() != 3) return unknown;
        SliceValue product;
        for (size_t i = 0; i < 3; ++i) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            product.push_back(builder_.make(SliceOp::Subtract,
                                            builder_.make(SliceOp::Multiply, values[0][j], values[1][k]),
                                            builder_.make(SliceOp::Multiply, values[0][k], values[1][j])));
        }
        return product;
    }
    default: return unknown;
    }
}

} // namespace mural::culling
