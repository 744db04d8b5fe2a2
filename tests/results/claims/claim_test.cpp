// Reading of claims: fields, expressions and expectations, and what is said of mistakes.
#include "results/claims/claim.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/claims/expectation.h"
#include "results/claims/expression.h"
#include "results/claims/function_table.h"
#include "tests/expect_input_error.h"

namespace {

using results::claims::Claim;
using results::claims::Comparable;
using results::claims::Expectation;
using results::claims::Expression;
using tests::input_error_of;

std::vector<Claim> read(const std::string& yaml) {
  return results::claims::read_claims(base::parse_document(yaml, "s.yaml"));
}

/// The message for a claim with this measure and expectation; its place as "@N", the character of
/// the one that begins with `of`.
std::string error_in(const std::string& of, const std::string& measure, const std::string& expect) {
  const std::string yaml = fmt::format(
      "- {{id: a, item: Fig 1, says: b, measure: \"{}\", expect: '{}'}}", measure, expect);
  const std::string message = input_error_of([&] { read(yaml); });
  const std::string start = "s.yaml:1:";
  if (!message.starts_with(start)) return message;
  const std::size_t colon = message.find(':', start.size());
  const int column = std::stoi(message.substr(start.size(), colon - start.size()));
  return fmt::format("@{}{}", column - static_cast<int>(yaml.find(of)), message.substr(colon));
}

std::string measure_error(const std::string& measure) { return error_in(measure, measure, ">= 1"); }

std::string expect_error(const std::string& expect) {
  return error_in(expect, "count(val)", expect);
}

TEST(Claims, HaveTheFieldsOfTheSuite) {
  const std::vector<Claim> claims = read(R"yaml(
- {id: fit, item: "Sec. 7.1", says: "cost is linear", measure: "r2(val, shadow, faces)",
   expect: ">= 0.95", printed: "20.4 fps", comparable: "no: hardware time", profile: half
}
- id: order
  item: Fig 10
  says: it falls
  measure: ["median(a, relmse)", "median(b, relmse)"]
  expect: decreasing
  profile: [half, paper]
  comparable: share only
  criterion: ours
)yaml");
  ASSERT_EQ(claims.size(), 2U);
  EXPECT_EQ(claims[0].comparable, Comparable::no);
  EXPECT_EQ(claims[0].comparable_reason, "hardware time");
  EXPECT_EQ(claims[0].printed, "20.4 fps");
  EXPECT_EQ(claims[0].profiles, std::vector<std::string>{"half"});
  EXPECT_EQ(claims[1].measures,
            (std::vector<std::string>{"median(a, relmse)", "median(b, relmse)"}));
  EXPECT_EQ(claims[1].profiles, (std::vector<std::string>{"half", "paper"}));
  EXPECT_EQ(claims[1].comparable, Comparable::share_only);
  EXPECT_EQ(claims[1].criterion, "ours");
}

TEST(Claims, SurviveTheWayThroughJson) {
  const std::vector<Claim> claims = read(R"yaml(
- {id: a, item: i, says: s, measure: "count(val)", expect: "= 3", comparable: "no: lost scene"
}
- {id: b, item: i, says: s, measure: ["count(val)", "count(pt)"], expect: largest, profile: half,
   printed: "3", criterion: ours})yaml");
  const nlohmann::ordered_json json = results::claims::to_json(claims);
  EXPECT_EQ(json[0]["measure"], "count(val)");
  EXPECT_EQ(json[1]["measure"].size(), 2U);
  EXPECT_FALSE(json[0].contains("profile"));
  EXPECT_EQ(results::claims::to_json(results::claims::claims_from_json(json)), json);
  EXPECT_EQ(input_error_of([] {
              results::claims::claims_from_json(nlohmann::ordered_json::parse(R"([{"id":"a"}])"));
            }),
            "claim: field \"item\" is missing");
}

TEST(Claims, RefuseWrongFieldsWithTheirPlace) {
  const auto error = [](const std::string& yaml) { return input_error_of([&] { read(yaml); }); };
  EXPECT_EQ(error("- {id: a, item: i, says: s, expect: '>= 1'}"),
            "s.yaml:1:3: claim has no \"measure\"; it is required");
  EXPECT_EQ(error("- {id: a/b, item: i, says: s, measure: count(v), expect: '>= 1'}"),
            "s.yaml:1:8: claim id \"a/b\" cannot be a file name; accepted: letters, digits, . _ -");
  EXPECT_EQ(error("- {id: a, item: i, says: s, measure: count(v), expect: '>= 1'}\n"
                  "- {id: a, item: i, says: s, measure: count(v), expect: '>= 1'}"),
            "s.yaml:2:8: claim id \"a\" is used twice; it stands first in line 1");
  EXPECT_EQ(
      error("- {id: a, item: i, says: s, measure: count(v), expect: '>= 1', comparable: 'no'}"),
      "s.yaml:1:76: comparable \"no\" is not known; accepted: \"yes\", \"share only\", "
      "\"no: REASON\"");
  EXPECT_NE(error("- {id: a, item: i, says: s, measure: count(v), expect: '>= 1', expects: 2}")
                .find("s.yaml:1:64: unknown key \"expects\"; did you mean \"expect\"?"),
            std::string::npos);
}

TEST(ClaimExpressions, NameTheColumnOfTheCharacter) {
  EXPECT_EQ(measure_error("median(val)"),
            "@11: \"median(val)\": \")\" at character 11; accepted: , as in "
            "median(rows, formula)");
  EXPECT_EQ(measure_error("median(val, )"),
            "@13: \"median(val, )\": \")\" at character 13; accepted: "
            "median(rows, formula)");
  EXPECT_EQ(measure_error("median(val, a, b)"),
            "@14: \"median(val, a, b)\": \",\" at character 14; accepted: ) as in "
            "median(rows, formula)");
  EXPECT_EQ(measure_error("count(val[vals~3])").substr(0, 47),
            "@15: \"count(val[vals~3])\": \"~\" at character 15;");
  EXPECT_EQ(measure_error("count(val) 3"),
            "@12: \"count(val) 3\": \"3\" at character 12; accepted: + - * / or the end");
  EXPECT_EQ(measure_error("2 * "),
            "@5: \"2 * \": the end at character 5; accepted: a number, -, ( or a function, "
            "e.g. median(val, total_s)");
  EXPECT_EQ(measure_error("(count(val)"),
            "@12: \"(count(val)\": the end at character 12; accepted: ) or + - * /");
  EXPECT_EQ(measure_error("mediam(val, a)").substr(0, 70),
            "@1: \"mediam(val, a)\": unknown function \"mediam\"; did you mean \"median\"");
  EXPECT_EQ(measure_error("share_of(val, vals)"),
            "@19: \"share_of(val, vals)\": \")\" at character 19; accepted: = != < <= > >= "
            "and a number");
  EXPECT_EQ(measure_error("median(val, count(val))"),
            "@13: \"median(val, count(val))\": count is no function of a row's quantities; "
            "accepted there: abs, sqrt, log2");
  EXPECT_EQ(measure_error("share(val, 3)"),
            "@12: \"share(val, 3)\": \"3\" at character 12; accepted: the name of a "
            "quantity, e.g. total_s, gather/visibility, relmse");
}

TEST(ClaimExpressions, OfAPlainScalarStartAtItsFirstCharacter) {
  EXPECT_EQ(input_error_of([] {
              read("- id: a\n  item: i\n  says: s\n  measure: count(val) 3\n  expect: '>= 1'");
            }).substr(0, 12),
            "s.yaml:4:23:");
}

TEST(ClaimExpressions, BindAsUsual) {
  const auto parse = [](const char* text) { return results::claims::parse_expression(text, {}); };
  const Expression sum = parse("1 + 2 * count(val) - 3");
  EXPECT_EQ(sum.sign, '-');
  EXPECT_EQ(sum.parts[0].text, "1 + 2 * count(val)");
  EXPECT_EQ(sum.parts[0].parts[1].sign, '*');
  // A name of a quantity runs on over / and -; an operator has blanks around it.
  const Expression formula = parse("median(*, gather/visibility / visible-difference)").parts[1];
  EXPECT_EQ(formula.sign, '/');
  EXPECT_EQ(formula.parts[0].name, "gather/visibility");
  EXPECT_EQ(formula.parts[1].name, "visible-difference");
  EXPECT_EQ(parse("value(a, 'relmse,trim=0.1@full')").parts[1].name, "relmse,trim=0.1@full");
  EXPECT_TRUE(gives_list(parse("2 * abs(series(a, relmse, vals))")));
  EXPECT_FALSE(gives_list(parse("greatest(series(a, relmse, vals))")));
}

TEST(ClaimExpectations, AreBoundsOrWords) {
  const auto parse = [](const char* text) { return results::claims::parse_expectation(text, {}); };
  EXPECT_TRUE(parse(">= 0.95").includes(0.95));
  EXPECT_FALSE(parse("> 0.95").includes(0.95));
  EXPECT_TRUE(parse("<= 40%").includes(0.4));
  EXPECT_FALSE(parse("< 40%").includes(0.4));
  EXPECT_TRUE(parse("= 34.1 within 5%").includes(34.1 * 1.049));
  EXPECT_FALSE(parse("= 34.1 within 5%").includes(34.1 * 1.051));
  EXPECT_TRUE(parse("= 0.5 within 0.02").includes(0.519));
  EXPECT_FALSE(parse("= 0.5 within 0.02").includes(0.521));
  EXPECT_TRUE(parse("= 16").includes(16.0));
  EXPECT_FALSE(parse("= 16").includes(16.001));
  EXPECT_TRUE(parse("in 0.4..0.6").includes(0.6));
  EXPECT_FALSE(parse("in 0.4..0.6").includes(0.61));
  EXPECT_TRUE(parse("in -2 .. -1").includes(-1.5));
  EXPECT_EQ(parse("falls").kind, Expectation::Kind::falls);
}

TEST(ClaimExpectations, NameTheColumnOfTheCharacter) {
  const std::string forms =
      "accepted: >= 0.95, <= 40%, > 1, < 1, = 16, = 34.1 within 5%, = 0.5 within 0.02, in "
      "0.4..0.6, increasing, decreasing, rises, falls, largest, smallest, printed";
  EXPECT_EQ(expect_error(">= x"), "@4: \">= x\": \"x\" at character 4; " + forms);
  EXPECT_EQ(expect_error("about 3"), "@1: \"about 3\": \"a\" at character 1; " + forms);
  EXPECT_EQ(expect_error("in 0.6..0.4"), "@9: \"in 0.6..0.4\": \"0\" at character 9; " + forms);
  EXPECT_EQ(expect_error(">= 3 or so"), "@6: \">= 3 or so\": \"o\" at character 6; " + forms);
  EXPECT_EQ(expect_error("falls"),
            "@1: \"falls\" says nothing of a single value; accepted: a bound, or a measure "
            "that is series(...) or a list");
  EXPECT_EQ(expect_error("largest"),
            "@1: \"largest\" says nothing of a single value; accepted: a bound, or a "
            "measure that is share(...), series(...) or a list");
}

TEST(ClaimFunctions, AreAllDescribedByTheirSignature) {
  for (const results::claims::Function& function : results::claims::function_table()) {
    EXPECT_EQ(std::string(function.signature).find(std::string(function.name) + "("), 0U);
    EXPECT_NE(std::string(function.doc), "");
    EXPECT_NE(function.evaluate == nullptr, function.elementwise == nullptr) << function.name;
  }
}

}  // namespace
