// Datafiles of the Surface Evolver [Brakke92], the part that describes soap films: see docs/file-formats.md.

#include "lamella/io/detail/evolver_datafile.h"

#include "lamella/core/error.h"
#include "lamella/io/detail/evolver_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace lamella::io::detail {
namespace {

using Kind = EvolverToken::Kind;
using Numbers = std::unordered_map<std::int64_t, std::size_t>;  ///< of elements -> their places

constexpr std::int64_t kLargestNumber = 2'000'000'000;

/// A curve that carries vertices: three expressions of the parameter p1, kept where they stand.
struct Boundary {
    std::vector<EvolverLexer> coordinates;
};

class Parser {
public:
    Parser(std::string_view text, const std::string& name) : lexer_(text, name), name_(name) {}

    EvolverDatafile parse() {
        top();
        section("vertices", [this](std::int64_t number, int line) { vertex(number, line); });
        section("edges", [this](std::int64_t number, int line) { edge(number, line); });
        const bool facets = lexer_.peek().is("facets");
        section(facets ? "facets" : "faces", [this](std::int64_t number, int line) { face(number, line); });
        if (lexer_.peek().is("bodies")) section("bodies", [this](std::int64_t number, int line) { body(number, line); });
        lexer_.skip_blank_lines();
        const EvolverToken& end = lexer_.peek();  // behind "read" come commands
        if (!end.is("read") && end.kind != Kind::kEnd) refuse_word(end, "here");
        return std::move(file_);
    }

private:
    [[noreturn]] void refuse(int line, const std::string& what) const { lexer_.refuse(line, what); }
    [[noreturn]] void refuse_word(const EvolverToken& word, const std::string& where) const {
        refuse(word.line, fmt::format("{}: {} is not supported; docs/file-formats.md lists what is", where, word.shown()));
    }
    void expect_line_end(const std::string& behind) {
        if (!lexer_.peek().ends_line())
            refuse(lexer_.peek().line, fmt::format("{} is not expected behind {}", lexer_.peek().shown(), behind));
    }
    double expression() { return evolver_expression(lexer_, values_); }

    // Definitions and options.

    void top() {
        for (lexer_.skip_blank_lines(); !lexer_.peek().is("vertices"); lexer_.skip_blank_lines()) {
            const EvolverToken word = lexer_.next();
            if (word.kind == Kind::kEnd) refuse(word.line, "there is no section vertices");
            option(word);
        }
    }

    void option(const EvolverToken& word) {
        if (word.is("parameter")) parameter();
        else if (word.is("boundary")) boundary();
        else if (word.is("torus") || word.is("torus_filled")) file_.torus = true;
        else if (word.is("periods")) periods();
        else if (word.is("space_dimension")) only(word, 3);
        else if (word.is("surface_dimension")) only(word, 2);
        else if (word.is("soapfilm")) expect_line_end("soapfilm");
        else if (word.is("gravity_constant")) only(word, 0);
        else if (word.is("define")) extra_attribute(word);
        else if (word.is("evolver_version")) lexer_.skip_line();
        else if (word.is("view_matrix")) matrices(1);
        else if (word.is("view_transform_generators"))
            matrices(evolver_integer(lexer_, 0, 1000, "view_transform_generators"));
        else refuse_word(word, "definitions");
    }

    void only(const EvolverToken& word, std::int64_t value) {
        if (lexer_.peek().is("=") || lexer_.peek().is(":")) lexer_.next();
        const double found = expression();
        if (found != static_cast<double>(value))
            refuse(word.line, fmt::format("{} {}: only {} is supported", word.text, found, value));
    }

    void parameter() {
        const EvolverToken name = lexer_.next();
        if (name.kind != Kind::kWord) refuse(name.line, fmt::format("parameter: {} is no name", name.shown()));
        const EvolverToken equals = lexer_.next();
        if (!equals.is("=")) refuse(equals.line, fmt::format("parameter {}: = is missing", name.shown()));
        values_[name.text] = expression();
        expect_line_end("the value of a parameter");
    }

    void boundary() {
        const int line = lexer_.peek().line;
        const auto number = evolver_integer(lexer_, 1, kLargestNumber, "boundary");
        const EvolverToken word = lexer_.next();
        if (!word.is("parameters")) refuse_word(word, fmt::format("boundary {}", number));
        if (evolver_integer(lexer_, 0, 1000, fmt::format("boundary {} parameters", number)) != 1)
            refuse(line, fmt::format("boundary {}: only curves of 1 parameter are supported, no surfaces", number));
        expect_line_end(fmt::format("boundary {}", number));
        Boundary curve;
        for (const char* coordinate : {"x1", "x2", "x3"}) {
            lexer_.skip_blank_lines();
            const EvolverToken name = lexer_.next();
            const EvolverToken colon = lexer_.next();
            if (!name.is(coordinate) || !(colon.is(":") || colon.is("=")))
                refuse(name.line, fmt::format("boundary {}: {}: is missing before {}", number, coordinate, name.shown()));
            curve.coordinates.push_back(lexer_);
            lexer_.skip_line();
        }
        if (!boundaries_.emplace(number, std::move(curve)).second)
            refuse(line, fmt::format("boundary {} is there twice", number));
    }

    void periods() {
        for (Vec3& period : file_.period)
            for (std::size_t k = 0; k < 3; ++k) {
                lexer_.skip_blank_lines();
                period[k] = expression();
            }
        expect_line_end("the periods");
    }

    /// Matrices say how to draw.
    void matrices(std::int64_t count) {
        for (std::int64_t k = 0; k < 16 * count; ++k) {
            lexer_.skip_blank_lines();
            expression();
        }
    }

    /// `define facet attribute region_back integer`: the labels that lamella writes.
    void extra_attribute(const EvolverToken& word) {
        for (const char* expected : {"facet", "attribute"})
            if (const EvolverToken t = lexer_.next(); !t.is(expected)) refuse_word(word, "definitions");
        const EvolverToken name = lexer_.next();
        if (!name.is("region_back") && !name.is("region_front"))
            refuse_word(name, "define facet attribute");
        if (const EvolverToken type = lexer_.next(); !type.is("integer")) refuse_word(type, "define facet attribute");
        expect_line_end("a definition");
    }

    // Elements: a line each, number first.

    template <class Element>
    void section(const std::string& title, Element&& element) {
        const EvolverToken head = lexer_.next();
        if (!head.is(title))
            refuse(head.line, fmt::format("{}: section {} is expected here", head.shown(), title));
        expect_line_end(title);
        for (lexer_.skip_blank_lines(); lexer_.peek().kind == Kind::kNumber; lexer_.skip_blank_lines()) {
            const int line = lexer_.peek().line;
            element(evolver_integer(lexer_, 1, kLargestNumber, title), line);
        }
    }

    void add_number(Numbers& numbers, std::int64_t number, std::size_t place, int line, const char* what) {
        if (!numbers.emplace(number, place).second) refuse(line, fmt::format("{} {} is there twice", what, number));
    }

    std::size_t find(const Numbers& numbers, std::int64_t number, const char* what, const std::string& in) {
        const auto it = numbers.find(number);
        if (it == numbers.end())
            refuse(lexer_.peek().line, fmt::format("{}: there is no {} {}", in, what, number));
        return it->second;
    }

    /// The attributes that vertices, edges and faces share. @returns  false: none of them
    bool common_attribute(const EvolverToken& word, bool& held) {
        if (word.is("fixed")) held = true;
        else if (word.is("color") || word.is("backcolor") || word.is("frontcolor") || word.is("original")) lexer_.next();
        else return false;
        return true;
    }

    void vertex(std::int64_t number, int line) {
        const std::string in = fmt::format("vertex {}", number);
        EvolverDatafile::Vertex vertex{number, {}, false};
        std::vector<double> numbers;
        while (begins_expression(lexer_.peek(), values_) && numbers.size() < 4) numbers.push_back(expression());
        const bool on_curve = lexer_.peek().is("boundary");
        if (numbers.size() != (on_curve ? 1U : 3U)) {
            const EvolverToken& next = lexer_.peek();
            if (!next.ends_line() && !next.is("fixed") && !on_curve) refuse_word(next, in);
            refuse(line, fmt::format("{}: {} numbers; {} expected", in, numbers.size(),
                                     on_curve ? "1 is" : "3 coordinates are"));
        }
        if (on_curve) {
            lexer_.next();
            const Boundary& curve = find_boundary(in);
            vertex.at = on_boundary(curve, numbers[0]);
            on_curve_[file_.vertices.size()] = {&curve, numbers[0]};
            vertex.held = true;  // sliding along the curve that it lies on changes no film
        } else {
            vertex.at = {{numbers[0], numbers[1], numbers[2]}};
        }
        while (!lexer_.peek().ends_line())
            if (const EvolverToken word = lexer_.next(); !common_attribute(word, vertex.held)) refuse_word(word, in);
        add_number(vertices_, number, file_.vertices.size(), line, "vertex");
        file_.vertices.push_back(vertex);
    }

    const Boundary& find_boundary(const std::string& in) {
        const auto number = evolver_integer(lexer_, 1, kLargestNumber, in + " boundary");
        const auto it = boundaries_.find(number);
        if (it == boundaries_.end()) refuse(lexer_.peek().line, fmt::format("{}: there is no boundary {}", in, number));
        return it->second;
    }

    Vec3 on_boundary(const Boundary& curve, double parameter) const {
        EvolverValues values = values_;
        values["p1"] = parameter;
        Vec3 at;
        for (std::size_t k = 0; k < 3; ++k) {
            EvolverLexer formula = curve.coordinates[k];
            at[k] = evolver_expression(formula, values);
            if (!formula.peek().ends_line())
                refuse(formula.peek().line, fmt::format("{} is not expected behind an expression", formula.peek().shown()));
        }
        return at;
    }

    /// Places on the curve between the ends of an edge, so close that it turns by no more than about 30 degrees from one to
    /// the next. The parameter of a closed curve may jump by a turn between the ends.
    std::vector<Vec3> inner_places(const EvolverDatafile::Edge& edge, const Boundary& curve) const {
        const auto tail = on_curve_.find(edge.tail), head = on_curve_.find(edge.head);
        if (tail == on_curve_.end() || head == on_curve_.end()) return {};
        if (tail->second.curve != &curve || head->second.curve != &curve) return {};
        constexpr double kTurn = 6.28318530717958647692;
        const Vec3 a = file_.vertices[edge.tail].at, b = file_.vertices[edge.head].at;
        const double p = tail->second.parameter;
        double step = head->second.parameter - p;
        for (const double other : {step - kTurn, step + kTurn})
            if (std::abs(other) < std::abs(step) && norm(on_boundary(curve, p + other) - b) < 1e-6 * norm(b - a)) step = other;
        const Vec3 middle = on_boundary(curve, p + 0.5 * step);
        const Vec3 first = middle - a, second = b - middle;
        const double turn = 2.0 * std::atan2(norm(cross(first, second)), dot(first, second));
        constexpr double kLargest = 0.55;
        const int pieces = std::max(1, static_cast<int>(std::ceil(turn / kLargest)));
        std::vector<Vec3> places;
        for (int k = 1; k < pieces; ++k) places.push_back(on_boundary(curve, p + step * k / pieces));
        return places;
    }

    void edge(std::int64_t number, int line) {
        const std::string in = fmt::format("edge {}", number);
        EvolverDatafile::Edge edge{number, 0, 0, {}, false, {}};
        for (std::size_t* end : {&edge.tail, &edge.head})
            *end = find(vertices_, evolver_integer(lexer_, 1, kLargestNumber, in), "vertex", in);
        if (edge.tail == edge.head) refuse(line, fmt::format("{} joins vertex {} with itself", in,
                                                             file_.vertices[edge.tail].number));
        if (file_.torus)
            for (int& wrap : edge.wrap) {
                const EvolverToken sign = lexer_.next();
                if (!sign.is("*") && !sign.is("+") && !sign.is("-"))
                    refuse(sign.line, fmt::format("{}: {} where * + or - says how the edge wraps around the torus", in,
                                                  sign.shown()));
                wrap = sign.is("+") ? 1 : sign.is("-") ? -1 : 0;
            }
        while (!lexer_.peek().ends_line()) {
            const EvolverToken word = lexer_.next();
            if (word.is("boundary")) {
                edge.inner = inner_places(edge, find_boundary(in));
                edge.held = true;
            } else if (!common_attribute(word, edge.held)) {
                refuse_word(word, in);
            }
        }
        add_number(edges_, number, file_.edges.size(), line, "edge");
        file_.edges.push_back(std::move(edge));
    }

    /// Element numbers with signs, up to the first word.
    template <class Use>
    void signed_numbers(const std::string& in, Use&& use) {
        while (lexer_.peek().kind == Kind::kNumber || lexer_.peek().is("-") || lexer_.peek().is("+")) {
            const std::int64_t number = evolver_integer(lexer_, -kLargestNumber, kLargestNumber, in);
            use(number < 0 ? -number : number, number > 0);
        }
    }

    void face(std::int64_t number, int line) {
        const std::string in = fmt::format("face {}", number);
        EvolverDatafile::Face face{number, line, {}, false, 1.0, {}, {}};
        signed_numbers(in, [&](std::int64_t edge, bool forward) {
            face.loop.push_back({find(edges_, edge, "edge", in), forward});
        });
        while (!lexer_.peek().ends_line()) {
            const EvolverToken word = lexer_.next();
            if (word.is("tension") || word.is("density")) face.tension = tension(in);
            else if (word.is("region_back")) face.back = evolver_integer(lexer_, 0, kMostRegions, in);
            else if (word.is("region_front")) face.front = evolver_integer(lexer_, 0, kMostRegions, in);
            else if (!common_attribute(word, face.held)) refuse_word(word, in);
        }
        add_number(faces_, number, file_.faces.size(), line, "face");
        file_.faces.push_back(std::move(face));
    }

    double tension(const std::string& in) {
        const int line = lexer_.peek().line;
        const double value = expression();
        if (!(value > 0.0)) refuse(line, fmt::format("{}: tension {} is not positive", in, value));
        return value;
    }

    void body(std::int64_t number, int line) {
        const std::string in = fmt::format("body {}", number);
        if (number > kMostRegions) refuse(line, fmt::format("{}: the largest number of a body is {}", in, kMostRegions));
        EvolverDatafile::Body body{number, line, {}, {}};
        signed_numbers(in, [&](std::int64_t face, bool outward) {
            body.faces.push_back({find(faces_, face, "face", in), outward});
        });
        if (body.faces.empty()) refuse(line, fmt::format("{} has no faces", in));
        bool held = false;
        while (!lexer_.peek().ends_line()) {
            const EvolverToken word = lexer_.next();
            if (word.is("volume")) body.volume = expression();
            else if (word.is("fixed") || !common_attribute(word, held)) refuse_word(word, in);
        }
        if (body.volume && !(*body.volume > 0.0))
            refuse(line, fmt::format("{}: volume {} is not positive", in, *body.volume));
        add_number(bodies_, number, file_.bodies.size(), line, "body");
        file_.bodies.push_back(std::move(body));
    }

    EvolverLexer lexer_;
    std::string name_;
    EvolverDatafile file_;
    EvolverValues values_;
    std::map<std::int64_t, Boundary> boundaries_;
    struct OnCurve {
        const Boundary* curve;
        double parameter;
    };
    std::unordered_map<std::size_t, OnCurve> on_curve_;  ///< places of vertices
    Numbers vertices_, edges_, faces_, bodies_;
};

}  // namespace

EvolverDatafile parse_evolver_datafile(std::string_view text, const std::string& name) {
    return Parser(text, name).parse();
}

}  // namespace lamella::io::detail
