#include "balancer/simulation/cost_trace.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <ostream>
#include <sstream>

namespace mural::simulation {

namespace {

constexpr size_t kMostCells = 1 << 20, kMostRanges = 1 << 16, kMostFrames = 100000;
constexpr const char* kMagic = "mural-cost-trace";

class Reader {
public:
    Reader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

    Result<CostTrace> read() {
        if (!header()) return error();
        std::string line;
        while (next(line)) {
            std::istringstream words(line);
            std::string word;
            words >> word;
            bool isGood = false;
            if (word == "frame")
                isGood = frame();
            else if (word == "cells" || word == "ranges")
                isGood = values(words, word == "cells");
            else
                isGood = fail("\"" + word + "\" is not frame, cells or ranges");
            if (!isGood) return error();
        }
        if (trace_.frames.empty()) fail("there are no frames");
        if (message_.empty()) complete();
        return message_.empty() ? Result<CostTrace>(std::move(trace_)) : error();
    }

private:
    bool next(std::string& line) {
        while (std::getline(in_, line)) {
            ++line_;
            const size_t first = line.find_first_not_of(" \t\r");
            if (first != std::string::npos && line[first] != '#') return true;
        }
        return false;
    }

    bool fail(std::string message) {
        if (message_.empty()) message_ = std::move(message);
        return false;
    }
    [[nodiscard]] Error error() const { return {name_ + ":" + std::to_string(line_) + ": " + message_}; }

    bool header() {
        std::string line, word;
        int version = 0;
        if (!next(line)) return fail("the file is empty; a cost trace begins with \"mural-cost-trace 1\"");
        std::istringstream magic(line);
        if (!(magic >> word >> version) || word != kMagic || version != 1)
            return fail("this is no cost trace; it begins with \"mural-cost-trace 1\"");
        if (!next(line)) return fail("the second line must be \"grid COLUMNS ROWS RANGES\"");
        std::istringstream grid(line);
        long columns = 0, rows = 0, ranges = 0;
        if (!(grid >> word >> columns >> rows >> ranges) || word != "grid" || columns < 1 || rows < 1 || ranges < 1)
            return fail("the second line must be \"grid COLUMNS ROWS RANGES\" with numbers from 1 on");
        trace_.columns = static_cast<size_t>(columns);
        trace_.rows = static_cast<size_t>(rows);
        trace_.ranges = static_cast<size_t>(ranges);
        if (trace_.columns > kMostCells || trace_.rows > kMostCells || trace_.columns * trace_.rows > kMostCells ||
            trace_.ranges > kMostRanges)
            return fail("the grid is too large; the picture has at most 1048576 cells, the range 65536 parts");
        trace_.name = name_;
        return true;
    }

    bool frame() {
        complete();
        if (!message_.empty()) return false;
        if (trace_.frames.size() >= kMostFrames) return fail("more than 100000 frames");
        trace_.frames.emplace_back();
        return true;
    }

    // Numbers, or VALUE*COUNT for equal ones.
    bool values(std::istringstream& words, bool isCells) {
        if (trace_.frames.empty()) return fail("values before the first frame");
        std::vector<float>& all = isCells ? trace_.frames.back().cells : trace_.frames.back().ranges;
        const size_t wanted = isCells ? trace_.columns * trace_.rows : trace_.ranges;
        std::string word;
        while (words >> word) {
            float value = 0;
            size_t count = 1;
            const char* const end = word.data() + word.size();
            auto read = std::from_chars(word.data(), end, value);
            if (read.ec == std::errc{} && read.ptr != end && *read.ptr == '*')
                read = std::from_chars(read.ptr + 1, end, count);
            if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(value) || value < 0)
                return fail("\"" + word + "\" is no cost; give seconds from 0 on, or SECONDS*COUNT");
            if (count > wanted || all.size() + count > wanted)
                return fail("more than " + std::to_string(wanted) + (isCells ? " cells" : " parts of the range"));
            all.insert(all.end(), count, value);
        }
        return true;
    }

    // Completes the last frame. A frame without cells or ranges spreads the cost of the other evenly.
    void complete() {
        if (trace_.frames.empty()) return;
        CostFrame& f = trace_.frames.back();
        const size_t cells = trace_.columns * trace_.rows;
        if (f.cells.empty() && f.ranges.empty()) {
            fail("the frame before has neither cells nor ranges");
            return;
        }
        const auto spread = [](const std::vector<float>& from, std::vector<float>& to, size_t count) {
            double sum = 0;
            for (const float v : from) sum += v;
            to.assign(count, static_cast<float>(sum / static_cast<double>(count)));
        };
        if (f.cells.empty()) spread(f.ranges, f.cells, cells);
        if (f.ranges.empty()) spread(f.cells, f.ranges, trace_.ranges);
        if (f.cells.size() != cells)
            fail("the frame has " + std::to_string(f.cells.size()) + " of " + std::to_string(cells) + " cells");
        if (f.ranges.size() != trace_.ranges)
            fail("the frame has " + std::to_string(f.ranges.size()) + " of " + std::to_string(trace_.ranges) +
                 " parts of the range");
    }

    std::istream& in_;
    const std::string name_;
    size_t line_ = 0;
    std::string message_;
    CostTrace trace_;
};

void writeValues(const char* word, const std::vector<float>& values, std::ostream& out) {
    out << word;
    for (size_t i = 0; i < values.size();) {
        size_t same = 1;
        while (i + same < values.size() && values[i + same] == values[i]) ++same;
        char text[32];
        const auto end = std::to_chars(std::begin(text), std::end(text), values[i]);
        out << ' ' << std::string_view(text, static_cast<size_t>(end.ptr - text));
        if (same > 1) out << '*' << same;
        i += same;
    }
    out << '\n';
}

} // namespace

Result<CostTrace> readCostTrace(std::istream& in, const std::string& name) { return Reader(in, name).read(); }

Result<CostTrace> readCostTrace(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return Error{path + " can't be read; name a cost trace, or a scene that --list shows"};
    return readCostTrace(in, path);
}

void writeCostTrace(const CostTrace& trace, std::ostream& out) {
    out << kMagic << " 1\ngrid " << trace.columns << ' ' << trace.rows << ' ' << trace.ranges << '\n';
    for (const CostFrame& frame : trace.frames) {
        out << "frame\n";
        writeValues("cells", frame.cells, out);
        writeValues("ranges", frame.ranges, out);
    }
}

} // namespace mural::simulation
