#pragma once

// The words of a Surface Evolver datafile and its constant expressions.

#include "lamella/core/error.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace lamella::io::detail {

struct EvolverToken {
    enum class Kind { kNumber, kWord, kSymbol, kLineEnd, kEnd };
    Kind kind = Kind::kEnd;
    std::string text;             ///< words in lower case
    double number = 0.0;
    bool whole = false;           ///< a number without point and exponent
    int line = 1;
    bool space_before = false;
    bool space_after = false;

    bool is(std::string_view what) const { return kind != Kind::kLineEnd && text == what; }
    bool ends_line() const { return kind == Kind::kLineEnd || kind == Kind::kEnd; }
    /// For messages.
    std::string shown() const;
};

/// Reads a datafile token by token: `//` and `/* */` comments are left out, a backslash joins lines. A copy is a bookmark.
class EvolverLexer {
public:
    /// @throws InputError  as next()
    EvolverLexer(std::string_view text, const std::string& name) : text_(text), name_(&name) { next(); }

    const EvolverToken& peek() const { return token_; }
    /// Returns the token and goes on. @throws InputError  a comment or quote without end, a number that is too large,
    ///                                                    a character that no datafile has
    EvolverToken next();
    /// Goes on to the end of the line.
    void skip_line();
    void skip_blank_lines();
    [[noreturn]] void refuse(int line, const std::string& what) const { throw InputError({*name_, line, 0}, what); }

private:
    void skip_space();
    void read_token();
    void read_number();

    std::string_view text_;
    const std::string* name_;
    std::size_t at_ = 0;
    int line_ = 1;
    EvolverToken token_;
};

using EvolverValues = std::map<std::string, double, std::less<>>;

/// Evaluates the constant expression that the lexer stands at: numbers, + - * / ^ **, parentheses, pi, e, the usual
/// functions, and `values` by name. As in the Evolver, a + or - with space before it and none behind begins the next
/// expression of a list; inside of parentheses it is an operator.
/// @throws InputError  something else, a result that is not finite, more than 100 parentheses in each other
double evolver_expression(EvolverLexer& lexer, const EvolverValues& values);

/// Whether an expression can begin with this token.
bool begins_expression(const EvolverToken& token, const EvolverValues& values);

/// A whole number from `low` to `high`. @throws InputError  "WHAT: 3.5 is no whole number from ..."
std::int64_t evolver_integer(EvolverLexer& lexer, std::int64_t low, std::int64_t high, const std::string& what);

}  // namespace lamella::io::detail
