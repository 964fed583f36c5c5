#include "balancer/config/eqc/value_reader.hpp"

#include <algorithm>
#include <charconv>

#include "balancer/config/eqc/attribute_words.hpp"

namespace mural::config {

namespace {

std::string_view withoutPlus(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    return text;
}

bool sameButCase(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [&](char x, char y) { return lower(x) == lower(y); });
}

} // namespace

bool isAttributeWord(std::string_view word) { return findAttributeWord(word) != nullptr; }

bool ValueReader::takesAs(const Token& token, std::string_view word) {
    if (token.text == word) return true;
    if (!sameButCase(token.text, word)) return false;
    replaced(token, word);
    return true;
}

void ValueReader::replaced(const Token& token, std::string_view by) {
    tokens_.warn(token.at, std::string(token.text) + " is read as " + std::string(by), "write " + std::string(by));
}

// Frames carry no stencil values since 2007.
bool ValueReader::ignoredMember(Buffer) {
    if (tokens_.peek().kind != TokenKind::Word || !sameButCase(tokens_.peek().text, "STENCIL")) return false;
    tokens_.warn(tokens_.peek().at, "stencil buffers are not read back", "remove STENCIL");
    tokens_.take();
    return true;
}

void ValueReader::read(std::string& value) {
    const Token& token = tokens_.take();
    if (token.kind == TokenKind::String)
        value = token.text;
    else
        tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), "use text in double quotes");
}

void ValueReader::read(char& value) {
    const Token& token = tokens_.take();
    if (token.kind == TokenKind::Character)
        value = token.text.front();
    else
        tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token),
                     "use one character in single quotes");
}

void ValueReader::read(double& value) {
    const Token& token = tokens_.take();
    if (token.kind != TokenKind::Number)
        return tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), "use a number");
    const std::string_view text = withoutPlus(token.text);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::invalid_argument)
        return tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), "use a number");
    if (error == std::errc::result_out_of_range) {
        // Numbers too small for a double are 0.
        const size_t point = text.find('.');
        const bool tiny = text.find("e-") != std::string_view::npos ||
                          (point != std::string_view::npos && text.find_first_of("123456789") > point);
        if (!tiny) return tokens_.fail(token.at, std::string(field_) + " is too large", "use a smaller number");
        number = 0;
    }
    value = number;
}

void ValueReader::read(int32_t& value) {
    const Token& token = tokens_.take();
    const std::string remedy = "use a whole number";
    if (token.kind != TokenKind::Number)
        return tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), remedy);
    std::string_view text = withoutPlus(token.text);
    if (const size_t point = text.find('.'); point != std::string_view::npos &&
                                             text.find_first_not_of('0', point + 1) == std::string_view::npos &&
                                             point > 0) {
        tokens_.warn(token.at, std::string(field_) + " is a whole number", "omit the decimal point");
        text = text.substr(0, point);
    }
    int32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::result_out_of_range)
        return tokens_.fail(token.at, std::string(field_) + " is too large", "use a number below 2147483648");
    if (error != std::errc{} || end != text.data() + text.size())
        return tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token), remedy);
    value = number;
}

void ValueReader::read(uint32_t& value) {
    const Token& token = tokens_.peek();
    int32_t number = 0;
    read(number);
    if (number < 0) return tokens_.fail(token.at, std::string(field_) + " cannot be negative", "use 0 or more");
    value = static_cast<uint32_t>(number);
}

template <class... T> void ValueReader::readList(T&... values) {
    if (!tokens_.expect('[', field_)) return;
    (read(values), ...);
    tokens_.expect(']', field_);
}

void ValueReader::read(Viewport& v) { readList(v.x, v.y, v.w, v.h); }
void ValueReader::read(Vector3& v) { readList(v.x, v.y, v.z); }
void ValueReader::read(Degrees2& v) { readList(v.x, v.y); }
void ValueReader::read(Range& r) { readList(r.start, r.end); }
void ValueReader::read(Zoom& z) { readList(z.x, z.y); }
void ValueReader::read(Bezel& b) { readList(b.left, b.right, b.bottom, b.top); }

void ValueReader::read(PixelKernel& k) {
    uint32_t x = 0, y = 0, w = 1, h = 1;
    readList(x, y, w, h);
    k = {static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(w), static_cast<int32_t>(h)};
}

void ValueReader::read(SubPixel& s) {
    uint32_t index = 0, size = 1;
    readList(index, size);
    s = {static_cast<int32_t>(index), static_cast<int32_t>(size)};
}

// A bracketed pair is in pixels, a single number is a range fraction.
void ValueReader::read(PixelsOrRange& value) {
    if (tokens_.peek().is('[')) {
        Pixels2 pixels;
        readList(pixels.x, pixels.y);
        value.pixels = pixels;
    } else {
        double range = 0;
        read(range);
        value.range = range;
    }
}

void ValueReader::read(Reference& value) {
    const Token& token = tokens_.peek();
    if (token.kind == TokenKind::String) return read(value.emplace<std::string>());
    if (token.kind == TokenKind::Number) return read(value.emplace<uint32_t>());
    tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token),
                 "use a name in double quotes, or an index from 0");
}

void ValueReader::read(LayoutReference& value) {
    const Token& token = tokens_.peek();
    if (token.kind == TokenKind::Word && sameButCase(token.text, "OFF")) {
        value = std::monostate{};
        tokens_.take();
        return;
    }
    Reference reference;
    read(reference);
    if (const auto* name = std::get_if<std::string>(&reference))
        value = *name;
    else
        value = std::get<uint32_t>(reference);
}

void ValueReader::read(ChannelReference& value) {
    if (tokens_.peek().kind == TokenKind::String) return read(value.emplace<std::string>());
    auto& path = value.emplace<ChannelPath>();
    if (!tokens_.expect('(', "a channel path")) return;
    while (!tokens_.ended() && !tokens_.peek().is(')')) {
        std::pair<PathStep, Reference> step;
        read(step.first);
        read(step.second);
        path.steps.push_back(std::move(step));
    }
    tokens_.expect(')', "the channel path");
}

void ValueReader::readAttribute(int32_t& value) {
    const Token& token = tokens_.peek();
    if (token.kind == TokenKind::Number) return read(value);
    const AttributeWord* word = token.kind == TokenKind::Word ? findAttributeWord(token.text) : nullptr;
    if (word == nullptr)
        return tokens_.fail(token.at, std::string(field_) + " cannot be " + shown(token),
                            "use a number or a word such as ON, OFF, AUTO");
    tokens_.take();
    value = word->value;
    if (word->old)
        tokens_.warn(token.at, std::string(token.text) + " is read in capitals",
                     "write " + attributeText(value, AttributeKind::Switch));
    if (word->takesNumber) {
        uint32_t number = 0;
        read(number);
        if (number > static_cast<uint32_t>(kMaxCores))
            return tokens_.fail(token.at, std::string(field_) + " selects core or socket " + std::to_string(number),
                                "count from 0, up to " + std::to_string(kMaxCores));
        value += static_cast<int32_t>(number);
    }
}

} // namespace mural::config
