// Executes a vertex shader on symbols: each variable holds the nodes that make its scalars. Reads glslang's tree.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <glslang/Include/intermediate.h>

#include "nodes/culling/slice_builder.hpp"

namespace mural::culling {

// glslang's strings have an allocator of their own.
inline std::string textOf(const glslang::TString& text) { return {text.data(), text.size()}; }

class SliceInterpreter {
public:
    // root: of a parsed shader. It must outlive the interpreter.
    explicit SliceInterpreter(TIntermNode* root);
    // Executes main().
    ShaderSlice slice();

private:
    using Typed = glslang::TIntermTyped;
    using Aggregate = glslang::TIntermAggregate;
    using Variables = std::map<long long, SliceValue>;
    enum class Flow { Next, Break, Continue, Return };
    // A statement that is not followed. Variables that it may assign become unknown.
    struct Unfollowed {
        const char* reason;
    };
    // A variable, and the positions of the assigned scalars in it; all, if an index is unknown.
    struct Target {
        glslang::TIntermSymbol* symbol = nullptr;
        std::vector<size_t> scalars;
        bool isKnown = true;
    };

    // slice_statements.cpp
    Flow run(TIntermNode* node);
    Flow runSequence(Aggregate* sequence);
    Flow runSelection(glslang::TIntermSelection* selection);
    Flow runLoop(glslang::TIntermLoop* loop);
    Flow unroll(glslang::TIntermLoop* loop);
    void forget(TIntermNode* node);
    void forgetTarget(TIntermNode* node);
    [[nodiscard]] bool leaves(TIntermNode* node) const;
    [[nodiscard]] bool assigns(TIntermNode* node) const;
    SliceValue call(Aggregate* node);

    // slice_expressions.cpp
    SliceValue eval(TIntermNode* node);
    SliceValue evalSymbol(glslang::TIntermSymbol* symbol);
    SliceValue evalUnary(glslang::TIntermUnary* node);
    SliceValue evalBinary(glslang::TIntermBinary* node);
    SliceValue evalAggregate(Aggregate* node);
    SliceValue construct(Aggregate* node);
    SliceValue operation(glslang::TOperator op, const Typed* left, const Typed* right, const SliceValue& a,
                         const SliceValue& b, const glslang::TType& type);
    SliceValue assign(Typed* to, SliceValue value);
    Target targetOf(Typed* node);
    SliceValue& variable(glslang::TIntermSymbol* symbol);
    void addSources(const glslang::TType& type, const std::string& name, bool isUniform, SliceValue& out);

    TIntermNode* root_;
    SliceBuilder builder_;
    Variables variables_;
    std::map<std::string, Aggregate*> functions_; // by mangled name
    std::map<long long, glslang::TIntermSymbol*> symbols_;
    SliceValue returned_;
    int depth_ = 0;
    size_t steps_ = 0;
};

// Number of scalars of a type; 0: not representable.
[[nodiscard]] size_t scalarsOf(const glslang::TType& type);
// Position of a member's first scalar in its structure.
[[nodiscard]] size_t memberOffset(const glslang::TType& structure, size_t member);

} // namespace mural::culling
