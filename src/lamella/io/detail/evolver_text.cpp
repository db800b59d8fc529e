#include "lamella/io/detail/evolver_text.h"

#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace lamella::io::detail {
namespace {

using Kind = EvolverToken::Kind;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '#'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

struct Function {
    std::string_view name;
    double (*value)(double);
};
constexpr Function kFunctions[] = {
    {"sqrt", std::sqrt}, {"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},   {"asin", std::asin},
    {"acos", std::acos}, {"atan", std::atan}, {"exp", std::exp},   {"log", std::log},   {"abs", std::fabs},
    {"sinh", std::sinh}, {"cosh", std::cosh}, {"tanh", std::tanh}, {"floor", std::floor}, {"ceil", std::ceil},
    {"sqr", [](double x) { return x * x; }}};

const Function* find_function(std::string_view name) {
    for (const Function& f : kFunctions)
        if (f.name == name) return &f;
    return nullptr;
}

std::optional<double> find_value(std::string_view name, const EvolverValues& values) {
    if (const auto it = values.find(name); it != values.end()) return it->second;
    if (name == "pi") return 3.14159265358979323846;
    if (name == "e") return 2.71828182845904523536;
    return std::nullopt;
}

/// sum = product (+|- product)...; product = signed (*|/ signed)...; signed = -signed | power; power = atom [^ signed]
class Expression {
public:
    Expression(EvolverLexer& lexer, const EvolverValues& values) : lexer_(lexer), values_(values) {}

    double sum() {
        double value = product();
        while (sign_goes_on()) value = lexer_.next().text == "+" ? value + product() : value - product();
        return value;
    }

private:
    static constexpr int kDeepest = 100;

    /// Counts how deep calls are nested while it lives.
    struct Depth {
        explicit Depth(Expression& expression) : of(expression) {
            if (++of.depth_ > kDeepest)
                of.lexer_.refuse(of.lexer_.peek().line,
                                 fmt::format("an expression with more than {} levels", kDeepest));
        }
        ~Depth() { --of.depth_; }
        Depth(const Depth&) = delete;
        Depth& operator=(const Depth&) = delete;
        Expression& of;
    };

    bool sign_goes_on() const {
        const EvolverToken& t = lexer_.peek();
        if (!t.is("+") && !t.is("-")) return false;
        return parentheses_ > 0 || !t.space_before || t.space_after;
    }

    double product() {
        double value = with_sign();
        while (lexer_.peek().is("*") || lexer_.peek().is("/"))
            value = lexer_.next().text == "*" ? value * with_sign() : value / with_sign();
        return value;
    }

    double with_sign() {
        const Depth depth(*this);
        if (lexer_.peek().is("-")) {
            lexer_.next();
            return -with_sign();
        }
        if (lexer_.peek().is("+")) {
            lexer_.next();
            return with_sign();
        }
        const double base = atom();
        if (!lexer_.peek().is("^") && !lexer_.peek().is("**")) return base;
        lexer_.next();
        return std::pow(base, with_sign());
    }

    double atom() {
        const EvolverToken t = lexer_.next();
        if (t.kind == Kind::kNumber) return t.number;
        if (t.is("(")) {
            ++parentheses_;
            const double value = sum();
            expect(")");
            --parentheses_;
            return value;
        }
        if (t.kind != Kind::kWord) lexer_.refuse(t.line, fmt::format("a number is missing before {}", t.shown()));
        if (const Function* f = find_function(t.text)) {
            if (!lexer_.peek().is("(")) lexer_.refuse(t.line, fmt::format("{} needs a parenthesis behind it", t.text));
            return f->value(atom());
        }
        if (const auto value = find_value(t.text, values_)) return *value;
        lexer_.refuse(t.line, fmt::format("{} is no number, parameter or function that lamella knows", t.shown()));
    }

    void expect(std::string_view what) {
        const EvolverToken t = lexer_.next();
        if (!t.is(what)) lexer_.refuse(t.line, fmt::format("{} is missing before {}", what, t.shown()));
    }

    EvolverLexer& lexer_;
    const EvolverValues& values_;
    int depth_ = 0;
    int parentheses_ = 0;
};

}  // namespace

std::string EvolverToken::shown() const {
    if (kind == Kind::kEnd) return "the end of the file";
    if (kind == Kind::kLineEnd) return "the end of the line";
    constexpr std::size_t kLongest = 40;
    return sim::quoted_text(text.size() > kLongest ? text.substr(0, kLongest) + "..." : text);
}

void EvolverLexer::skip_space() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
            ++at_;
        } else if (c == '\\') {  // joins lines; space may follow it
            std::size_t end = at_ + 1;
            while (end < text_.size() && (text_[end] == ' ' || text_[end] == '\t' || text_[end] == '\r')) ++end;
            if (end < text_.size() && text_[end] != '\n') refuse(line_, "a backslash in the middle of a line");
            at_ = std::min(end + 1, text_.size());
            ++line_;
        } else if (text_.substr(at_, 2) == "//") {
            at_ = std::min(text_.find('\n', at_), text_.size());
        } else if (text_.substr(at_, 2) == "/*") {
            const std::size_t end = text_.find("*/", at_ + 2);
            if (end == std::string_view::npos) refuse(line_, "a comment /* has no end");
            line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            at_ = end + 2;
        } else {
            return;
        }
    }
}

EvolverToken EvolverLexer::next() {
    EvolverToken last = std::move(token_);
    read_token();
    return last;
}

void EvolverLexer::read_token() {
    const std::size_t before = at_;
    skip_space();
    token_ = {};
    token_.line = line_;
    token_.space_before = at_ > before || at_ == 0 || text_[at_ - 1] == '\n';
    if (at_ >= text_.size()) return;
    const char c = text_[at_];
    if (c == '\n') {
        token_.kind = Kind::kLineEnd;
        ++line_;
        ++at_;
        return;
    }
    const std::size_t begin = at_;
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) {
        read_number();
    } else if (is_letter(c)) {
        while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
        token_.kind = Kind::kWord;
        for (const char letter : text_.substr(begin, at_ - begin)) token_.text += lower(letter);
    } else if (c == '"') {
        const std::size_t end = text_.find_first_of("\"\n", begin + 1);
        if (end == std::string_view::npos || text_[end] == '\n') refuse(line_, "a quote has no end");
        at_ = end + 1;
        token_.kind = Kind::kSymbol;
        token_.text = text_.substr(begin, at_ - begin);
    } else {
        if (c < ' ' || c > '~') refuse(line_, fmt::format("a byte {:#04x}, which no datafile has", static_cast<unsigned char>(c)));
        at_ += text_.substr(begin, 2) == "**" && text_.substr(begin, 3) != "***" ? 2 : 1;
        token_.kind = Kind::kSymbol;
        token_.text = text_.substr(begin, at_ - begin);
    }
    token_.space_after = at_ >= text_.size() || text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r';
}

void EvolverLexer::read_number() {
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), token_.number);
    token_.text = std::string(begin, end);
    token_.kind = Kind::kNumber;
    if (error != std::errc{} || !std::isfinite(token_.number))
        refuse(line_, fmt::format("{} is too large or too small for a number", token_.shown()));
    at_ += static_cast<std::size_t>(end - begin);
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
        refuse(line_, fmt::format("a number {} goes on with \"{}\"", token_.text, text_[at_]));
    token_.whole = token_.text.find_first_of(".eE") == std::string::npos;
}

void EvolverLexer::skip_line() {
    while (!peek().ends_line()) next();
}

void EvolverLexer::skip_blank_lines() {
    while (peek().kind == Kind::kLineEnd) next();
}

double evolver_expression(EvolverLexer& lexer, const EvolverValues& values) {
    const int line = lexer.peek().line;
    const double value = Expression(lexer, values).sum();
    if (!std::isfinite(value)) lexer.refuse(line, fmt::format("an expression gives {}, no finite number", value));
    return value;
}

bool begins_expression(const EvolverToken& token, const EvolverValues& values) {
    if (token.kind == Kind::kNumber || token.is("(") || token.is("-") || token.is("+")) return true;
    return token.kind == Kind::kWord && (find_function(token.text) != nullptr || find_value(token.text, values));
}

std::int64_t evolver_integer(EvolverLexer& lexer, std::int64_t low, std::int64_t high, const std::string& what) {
    const EvolverToken first = lexer.next();
    const bool negative = first.is("-");
    const EvolverToken number = negative || first.is("+") ? lexer.next() : first;
    const double value = negative ? -number.number : number.number;
    if (number.kind != Kind::kNumber || !number.whole || value < static_cast<double>(low) ||
        value > static_cast<double>(high))
        lexer.refuse(number.line, fmt::format("{}: {}{} is no whole number from {} to {}", what, negative ? "-" : "",
                                              number.shown(), low, high));
    return static_cast<std::int64_t>(value);
}

}  // namespace lamella::io::detail
