#pragma once

#include <random>
#include <string>
#include <vector>

namespace tests {

/// Runs of letters, digits, - and _ in texts, each once, in order.
std::vector<std::string> words_of(const std::vector<std::string>& texts);

/// Makes malformed inputs of well-formed ones: bits, bytes, pieces and numbers changed, two inputs
/// spliced, words of one put into the other. The same seed gives the same inputs everywhere.
class Mutator {
 public:
  /// @param seeds  at least one
  Mutator(std::vector<std::string> seeds, unsigned seed);

  std::string next();

 private:
  std::size_t below(std::size_t bound);
  void change_once(std::string& bytes);
  void change_number(std::string& bytes);
  void put_word(std::string& bytes);

  std::vector<std::string> seeds_;
  std::vector<std::string> words_;  ///< of all seeds
  std::mt19937 engine_;
};

}  // namespace tests
