// Malformed inputs by the thousand: each is read or refused in words, none of them crashes, hangs
// or ends in another exception. DISCERN_FUZZ_RUNS=N makes N of each kind, DISCERN_FUZZ_SEED others.
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <typeinfo>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/mutation.h"

namespace tests {
namespace {

int number_of(const char* variable, int fallback) {
  const char* text = std::getenv(variable);
  return text == nullptr ? fallback : std::atoi(text);
}

struct Outcome {
  bool is_refused = false;
  std::string trouble;  ///< "" if it was read, or refused in words
};

Outcome outcome_of(const FuzzTarget& target, const std::string& bytes) {
  try {
    target.read(bytes);
  } catch (const base::InputError& error) {
    const bool has_words = !std::string(error.what()).empty();
    return {true, has_words ? "" : "refused without a word"};
  } catch (const std::exception& error) {
    return {false, fmt::format("{}: {}", typeid(error).name(), error.what())};
  }
  return {};
}

class Fuzz : public testing::TestWithParam<const FuzzTarget*> {};

TEST_P(Fuzz, SeedsAreRead) {
  for (const std::string& seed : GetParam()->seeds()) {
    EXPECT_NO_THROW(GetParam()->read(seed)) << seed.substr(0, 400);
  }
}

TEST_P(Fuzz, MalformedInputsAreReadOrRefused) {
  const FuzzTarget& target = *GetParam();
  const auto seed = static_cast<unsigned>(number_of("DISCERN_FUZZ_SEED", 1));
  Mutator mutator(target.seeds(), seed);
  const int runs = number_of("DISCERN_FUZZ_RUNS", 150);
  int refused = 0;
  for (int i = 0; i < runs; ++i) {
    const std::string bytes = mutator.next();
    const Outcome outcome = outcome_of(target, bytes);
    ASSERT_EQ(outcome.trouble, "") << target.name << ", seed " << seed << ", input " << i << ":\n"
                                   << bytes;
    refused += outcome.is_refused ? 1 : 0;
  }
  // A mutator that changes nothing, or a reader that looks at nothing, would prove nothing.
  EXPECT_GT(refused, runs / 10) << target.name;
}

std::vector<const FuzzTarget*> all_targets() {
  std::vector<const FuzzTarget*> targets;
  for (const FuzzTarget& target : file_targets()) targets.push_back(&target);
  for (const FuzzTarget& target : suite_targets()) targets.push_back(&target);
  return targets;
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(all_targets()),
                         [](const auto& parameter) {
                           std::string name = parameter.param->name;
                           std::erase(name, '-');
                           return name;
                         });

/// What the build calls a fuzzer and what can be read are one list.
TEST(Fuzzers, EveryReaderHasOne) {
  std::set<std::string> known;
  for (const FuzzTarget* target : all_targets()) known.insert(target->name);
  std::set<std::string> built;
  std::istringstream names(DISCERN_FUZZERS);
  for (std::string name; names >> name;) built.insert(name);
  EXPECT_EQ(built, known);
}

TEST(Mutator, MakesTheSameInputsOfTheSameSeed) {
  Mutator a({"scene: box, size: 3", "scene: room"}, 5);
  Mutator b({"scene: box, size: 3", "scene: room"}, 5);
  Mutator c({"scene: box, size: 3", "scene: room"}, 6);
  bool differs = false;
  for (int i = 0; i < 50; ++i) {
    const std::string one = a.next();
    EXPECT_EQ(one, b.next());
    differs = differs || one != c.next();
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace tests
