// Statements, functions and loops of a shader (slice_interpreter.hpp).
#include <utility>

#include "nodes/culling/slice_interpreter.hpp"

namespace mural::culling {

using namespace glslang;

namespace {

// Limit of executed statements of a shader, including unrolled loops.
constexpr size_t kMaxSteps = 20'000;
constexpr int kMaxDepth = 32;

// Calls `visit` with each child of the node.
template <class Visit> void forChildren(TIntermNode* node, Visit&& visit) {
    if (auto* const a = node->getAsAggregate()) {
        for (TIntermNode* child : a->getSequence()) visit(child);
    } else if (auto* const b = node->getAsBinaryNode()) {
        visit(b->getLeft());
        visit(b->getRight());
    } else if (auto* const u = node->getAsUnaryNode()) {
        visit(u->getOperand());
    } else if (auto* const s = node->getAsSelectionNode()) {
        visit(s->getCondition());
        visit(s->getTrueBlock());
        visit(s->getFalseBlock());
    } else if (auto* const l = node->getAsLoopNode()) {
        visit(l->getBody());
        visit(l->getTest());
        visit(l->getTerminal());
    } else if (auto* const w = node->getAsSwitchNode()) {
        visit(w->getCondition());
        visit(w->getBody());
    } else if (auto* const branch = node->getAsBranchNode()) {
        visit(branch->getExpression());
    }
}

bool isAssignment(TOperator op) {
    return (op >= EOpAssign && op <= EOpRightShiftAssign) || op == EOpPreIncrement || op == EOpPreDecrement ||
           op == EOpPostIncrement || op == EOpPostDecrement;
}

} // namespace

SliceInterpreter::SliceInterpreter(TIntermNode* root) : root_(root) {
    Aggregate* const all = root->getAsAggregate();
    if (!all) return;
    for (TIntermNode* node : all->getSequence())
        if (Aggregate* const a = node ? node->getAsAggregate() : nullptr; a && a->getOp() == EOpFunction)
            functions_[textOf(a->getName())] = a;
}

ShaderSlice SliceInterpreter::slice() {
    Aggregate* const all = root_->getAsAggregate();
    const auto main = functions_.find("main(");
    if (!all || main == functions_.end())
        return {.nodes = {}, .uniforms = {}, .inputs = {}, .reason = "no main function"};
    try {
        for (TIntermNode* node : all->getSequence()) { // initial values of global variables
            Aggregate* const a = node ? node->getAsAggregate() : nullptr;
            if (!a || (a->getOp() != EOpFunction && a->getOp() != EOpLinkerObjects)) run(node);
        }
        const TIntermSequence& parts = main->second->getSequence();
        if (parts.size() > 1) run(parts[1]);
    } catch (const Unfollowed& u) {
        return {.nodes = {}, .uniforms = {}, .inputs = {}, .reason = u.reason};
    }
    for (const auto& [id, symbol] : symbols_) {
        const TType& type = symbol->getType();
        const SliceValue& value = variables_[id];
        size_t at = 0;
        bool isPosition = symbol->getName() == "gl_Position";
        if (type.getBasicType() == EbtBlock && type.getTypeName() == "gl_PerVertex" && !type.isArray())
            for (size_t i = 0; i < type.getStruct()->size() && !isPosition; ++i)
                if ((*type.getStruct())[i].type->getFieldName() == "gl_Position") {
                    at = memberOffset(type, i);
                    isPosition = true;
                }
        if (isPosition && value.size() >= at + 4) return builder_.finish(value[at], value[at + 1], value[at + 3]);
    }
    return {.nodes = {}, .uniforms = {}, .inputs = {}, .reason = "no position is written"};
}

SliceInterpreter::Flow SliceInterpreter::run(TIntermNode* node) {
    if (!node) return Flow::Next;
    if (++steps_ > kMaxSteps) throw Unfollowed{"too many operations"};
    if (Aggregate* const a = node->getAsAggregate(); a && a->getOp() == EOpSequence) return runSequence(a);
    if (auto* const s = node->getAsSelectionNode()) return runSelection(s);
    if (auto* const l = node->getAsLoopNode()) return runLoop(l);
    if (node->getAsSwitchNode()) {
        if (leaves(node)) throw Unfollowed{"a return in a switch"};
        forget(node);
        return Flow::Next;
    }
    if (auto* const branch = node->getAsBranchNode()) {
        switch (branch->getFlowOp()) {
        case EOpReturn:
            returned_ = branch->getExpression() ? eval(branch->getExpression()) : SliceValue{};
            return Flow::Return;
        case EOpBreak: return Flow::Break;
        case EOpContinue: return Flow::Continue;
        default: throw Unfollowed{"an unknown branch"};
        }
    }
    eval(node);
    return Flow::Next;
}

SliceInterpreter::Flow SliceInterpreter::runSequence(Aggregate* sequence) {
    for (TIntermNode* child : sequence->getSequence())
        if (const Flow flow = run(child); flow != Flow::Next) return flow;
    return Flow::Next;
}

SliceInterpreter::Flow SliceInterpreter::runSelection(TIntermSelection* selection) {
    const SliceValue condition = eval(selection->getCondition());
    if (condition.size() == 1)
        if (const double* const is = builder_.known(condition[0]))
            return run(*is != 0 ? selection->getTrueBlock() : selection->getFalseBlock());
    const Variables before = variables_;
    const SliceValue returnedBefore = returned_;
    Flow first = Flow::Next, second = Flow::Next;
    Variables afterFirst;
    try {
        first = run(selection->getTrueBlock());
        afterFirst = std::exchange(variables_, before);
        second = run(selection->getFalseBlock());
    } catch (const Unfollowed&) {
        if (leaves(selection)) throw;
        variables_ = before;
        forget(selection);
        return Flow::Next;
    }
    if (first != Flow::Next || second != Flow::Next) throw Unfollowed{"a conditional return"};
    returned_ = returnedBefore;
    for (auto& [id, value] : variables_) {
        const auto other = afterFirst.find(id);
        value = other == afterFirst.end()
                    ? SliceValue(value.size(), kUnknown)
                    : builder_.select(condition.empty() ? kUnknown : condition[0], other->second, value);
    }
    for (const auto& [id, value] : afterFirst) variables_.try_emplace(id, value.size(), kUnknown);
    return Flow::Next;
}

SliceInterpreter::Flow SliceInterpreter::runLoop(TIntermLoop* loop) {
    const Variables before = variables_;
    try {
        return unroll(loop);
    } catch (const Unfollowed&) {
        if (leaves(loop)) throw;
        variables_ = before;
        forget(loop);
        return Flow::Next;
    }
}

SliceInterpreter::Flow SliceInterpreter::unroll(TIntermLoop* loop) {
    for (bool isFirst = true;; isFirst = false) {
        if (++steps_ > kMaxSteps) throw Unfollowed{"too many operations"};
        if (loop->getTest() && (loop->testFirst() || !isFirst)) {
            const SliceValue test = eval(loop->getTest());
            const double* const goesOn = test.size() == 1 ? builder_.known(test[0]) : nullptr;
            if (!goesOn) throw Unfollowed{"a loop whose end is unknown"};
            if (*goesOn == 0) return Flow::Next;
        }
        const Flow flow = run(loop->getBody());
        if (flow == Flow::Break) return Flow::Next;
        if (flow == Flow::Return) return flow;
        if (loop->getTerminal()) eval(loop->getTerminal());
    }
}

// Makes everything unknown that the node may assign.
void SliceInterpreter::forget(TIntermNode* node) {
    if (!node) return;
    if (++depth_ > kMaxDepth * 8) throw Unfollowed{"too deep"};
    if (auto* const b = node->getAsBinaryNode(); b && isAssignment(b->getOp())) forgetTarget(b->getLeft());
    if (auto* const u = node->getAsUnaryNode(); u && isAssignment(u->getOp())) forgetTarget(u->getOperand());
    if (Aggregate* const a = node->getAsAggregate()) {
        if (a->getOp() == EOpFunctionCall) {
            for (TIntermNode* argument : a->getSequence()) forgetTarget(argument); // perhaps an output
            if (const auto callee = functions_.find(textOf(a->getName())); callee != functions_.end())
                forget(callee->second);
        } else if (a->getOp() == EOpModf || a->getOp() == EOpFrexp) {
            for (TIntermNode* argument : a->getSequence()) forgetTarget(argument);
        }
    }
    forChildren(node, [&](TIntermNode* child) { forget(child); });
    --depth_;
}

void SliceInterpreter::forgetTarget(TIntermNode* node) {
    while (node)
        if (auto* const symbol = node->getAsSymbolNode()) {
            SliceValue& value = variable(symbol);
            value.assign(value.size(), kUnknown);
            return;
        } else if (auto* const b = node->getAsBinaryNode()) {
            node = b->getLeft();
        } else {
            return;
        }
}

// Whether the node contains a return.
bool SliceInterpreter::leaves(TIntermNode* node) const {
    if (!node) return false;
    if (auto* const branch = node->getAsBranchNode()) return branch->getFlowOp() == EOpReturn;
    bool found = false;
    forChildren(node, [&](TIntermNode* child) { found = found || leaves(child); });
    return found;
}

// Whether the node may assign something. Functions with variables of their own count as well.
bool SliceInterpreter::assigns(TIntermNode* node) const {
    if (!node) return false;
    if (auto* const o = node->getAsOperator(); o && (isAssignment(o->getOp()) || o->getOp() == EOpFunctionCall))
        return true;
    bool found = false;
    forChildren(node, [&](TIntermNode* child) { found = found || assigns(child); });
    return found;
}

SliceValue SliceInterpreter::call(Aggregate* node) {
    const auto function = functions_.find(textOf(node->getName()));
    SliceValue unknown(scalarsOf(node->getType()), kUnknown);
    if (function == functions_.end() || function->second->getSequence().size() < 2) {
        forget(node);
        return unknown;
    }
    if (++depth_ > kMaxDepth) throw Unfollowed{"recursive functions"};
    const TIntermSequence& arguments = node->getSequence();
    const TIntermSequence& parameters = function->second->getSequence()[0]->getAsAggregate()->getSequence();
    if (arguments.size() != parameters.size()) throw Unfollowed{"a call with other arguments"};
    std::vector<SliceValue> values;
    for (TIntermNode* argument : arguments) values.push_back(eval(argument));
    for (size_t i = 0; i < values.size(); ++i) variable(parameters[i]->getAsSymbolNode()) = values[i];
    returned_.clear();
    const Flow flow = run(function->second->getSequence()[1]);
    SliceValue result = flow == Flow::Return ? std::move(returned_) : unknown;
    for (size_t i = 0; i < values.size(); ++i) {
        auto* const parameter = parameters[i]->getAsSymbolNode();
        const TStorageQualifier storage = parameter->getQualifier().storage;
        if (storage == EvqOut || storage == EvqInOut) assign(arguments[i]->getAsTyped(), variable(parameter));
    }
    --depth_;
    result.resize(unknown.size(), kUnknown);
    return result;
}

} // namespace mural::culling
