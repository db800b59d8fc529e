#include "lamella/sim/node.h"

#include <gtest/gtest.h>

#include <limits>

namespace lamella::sim {
namespace {

Node node(auto value) { return {std::move(value), {}, {}}; }

TEST(Node, SetsAndFindsEntriesInOrder) {
    Node table;
    table.set("b", node(std::int64_t{1}));
    table.set("a", node(true));
    table.set("b", node(std::int64_t{2}));
    ASSERT_NE(table.table(), nullptr);
    ASSERT_EQ(table.table()->size(), 2u);
    EXPECT_EQ(table.table()->front().first, "b");
    EXPECT_EQ(std::get<std::int64_t>(table.find("b")->value), 2);
    EXPECT_EQ(table.find("c"), nullptr);
    EXPECT_EQ(table.find("a")->find("x"), nullptr);
}

TEST(Node, ShowsWhatWasFoundOnOneLine) {
    EXPECT_EQ(found_text(node(90.0)), "90");
    EXPECT_EQ(found_text(node(true)), "true");
    EXPECT_EQ(found_text(node(std::string("a\"b\\c\nd\te\x01\x7f"))), R"("a\"b\\c\nd\te\u0001\u007f")");
    EXPECT_EQ(found_text(node(Node::Array{node(std::int64_t{1}), node(std::string("x"))})), "[1, \"x\"]");
    EXPECT_EQ(found_text(node(Node::Table{})), "{...}");
    EXPECT_EQ(found_text(Node{}), "nothing");
    EXPECT_LT(found_text(node(std::string(10000, 'x'))).size(), 70u);
    EXPECT_LT(found_text(node(Node::Array(10000, node(std::int64_t{1})))).size(), 80u);
}

TEST(Node, CutsLongTextBetweenCharacters) {
    std::string text(59, 'x');
    for (int i = 0; i < 10; ++i) text += "\u00e9";  // two bytes each, the 60th byte is inside the first
    EXPECT_EQ(found_text(node(text)), "\"" + std::string(59, 'x') + "...\"");
}

TEST(Node, WritesNumbersExactlyAndAsFloats) {
    EXPECT_EQ(exact_text(1.0), "1.0");
    EXPECT_EQ(exact_text(-0.0), "-0.0");
    EXPECT_EQ(exact_text(0.1), "0.1");
    EXPECT_EQ(exact_text(1e-5), "1e-05");
    EXPECT_EQ(exact_text(1e300), "1e+300");
    const double awkward = 0.1 + 0.2;
    EXPECT_EQ(std::stod(exact_text(awkward)), awkward);
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(std::strtod(exact_text(least).c_str(), nullptr), least);
}

TEST(Node, QuotesKeysOnlyWhereNeeded) {
    EXPECT_EQ(key_text("gas_fraction-2"), "gas_fraction-2");
    EXPECT_EQ(key_text(""), "\"\"");
    EXPECT_EQ(key_text("a b"), "\"a b\"");
    EXPECT_EQ(join_path("", "bubble"), "bubble");
    EXPECT_EQ(join_path("bubble", "a.b"), "bubble.\"a.b\"");
}

}  // namespace
}  // namespace lamella::sim
