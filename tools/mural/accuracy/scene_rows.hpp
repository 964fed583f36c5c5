// Measures decompositions of Mural's scenes: compares natively drawn scenes with every decomposition.
#pragma once

#include "tools/mural/accuracy/accuracy_row.hpp"
#include "tools/mural/accuracy/accuracy_runs.hpp"

namespace mural::cli {

class SceneRows {
public:
    SceneRows(const AccuracyRuns& runs, bool quick) : runs_(runs), quick_(quick) {}

    // Draws the references. Errors: no scenes program, no GL.
    Result<void> prepare();
    void measure(std::vector<AccuracyRow>& rows);

    [[nodiscard]] const std::vector<OwnedPicture>& nativePictures() const { return native_; }
    [[nodiscard]] std::string subject() const;
    [[nodiscard]] const std::string& gl() const { return gl_; }

private:
    struct Method;
    static std::vector<Method> methods();
    [[nodiscard]] int width() const { return quick_ ? 253 : 1021; }
    [[nodiscard]] int height() const { return quick_ ? 191 : 767; }
    [[nodiscard]] Words program(const Words& more) const;
    Result<std::vector<OwnedPicture>> drawNatively(const Words& more);
    Result<std::vector<OwnedPicture>> drawByMural(const Words& options, const Words& more);
    Result<std::vector<OwnedPicture>> referenceOf(const Method& method);
    Result<std::vector<OwnedPicture>> meanOf(int samples);
    Result<std::vector<OwnedPicture>> anaglyph();
    Result<std::vector<OwnedPicture>> reduced(const Words& more);
    static AccuracyRow rowOf(const Method& method, size_t scene);
    void measureAllScenes(const Method& method, std::vector<AccuracyRow>& rows);
    void measureEachScene(const Method& method, std::vector<AccuracyRow>& rows);

    const AccuracyRuns& runs_;
    bool quick_;
    std::string gl_;
    std::vector<OwnedPicture> native_;
};

} // namespace mural::cli
