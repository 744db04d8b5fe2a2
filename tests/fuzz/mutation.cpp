#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace tests {

namespace {

constexpr std::size_t kMostChanges = 6;
constexpr std::size_t kLongestPiece = 64;

bool is_word_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

/// What readers of numbers forget.
constexpr std::array kNumbers{"0",    "-1",     "1e309",      "-0",         "nan",
                              "inf",  "1e-320", "2147483648", "4294967296", "18446744073709551616",
                              "0x10", "1e9",    "0.0000001",  "99999",      "true",
                              "~",    "",       "[]",         "{}",         "\"\""};

}  // namespace

std::vector<std::string> words_of(const std::vector<std::string>& texts) {
  std::vector<std::string> words;
  for (const std::string& text : texts) {
    std::string word;
    for (const char c : text + " ") {
      if (is_word_letter(c)) {
        word += c;
      } else if (!word.empty()) {
        words.push_back(std::exchange(word, ""));
      }
    }
  }
  std::ranges::sort(words);
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

Mutator::Mutator(std::vector<std::string> seeds, unsigned seed)
    : seeds_(std::move(seeds)), words_(words_of(seeds_)), engine_(seed) {}

// Not a distribution of the library: those may differ from machine to machine.
std::size_t Mutator::below(std::size_t bound) { return bound == 0 ? 0 : engine_() % bound; }

std::string Mutator::next() {
  std::string bytes = seeds_[below(seeds_.size())];
  if (below(8) == 0) {  // the beginning of one, the end of another
    const std::string& other = seeds_[below(seeds_.size())];
    bytes = bytes.substr(0, below(bytes.size() + 1)) + other.substr(below(other.size() + 1));
  }
  const std::size_t changes = 1 + below(kMostChanges);
  for (std::size_t i = 0; i < changes; ++i) change_once(bytes);
  return bytes;
}

void Mutator::change_once(std::string& bytes) {
  const std::size_t at = below(bytes.size() + 1);
  const std::size_t length = std::min(1 + below(kLongestPiece), bytes.size() - at);
  switch (below(8)) {
    case 0:  // a bit
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:  // a byte
      if (at < bytes.size()) bytes[at] = static_cast<char>(below(256));
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:  // a piece twice
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 4:  // a piece elsewhere
      bytes.insert(below(bytes.size() + 1), bytes.substr(at, length));
      break;
    case 5:  // the end is missing
      if (below(4) == 0) bytes.resize(at);
      break;
    case 6:
      change_number(bytes);
      break;
    default:
      put_word(bytes);
  }
}

void Mutator::change_number(std::string& bytes) {
  const std::size_t from = below(bytes.size() + 1);
  const std::size_t begin = bytes.find_first_of("0123456789", from);
  if (begin == std::string::npos) return;
  const std::size_t end = bytes.find_first_not_of("0123456789.", begin);
  const std::size_t length = (end == std::string::npos ? bytes.size() : end) - begin;
  bytes.replace(begin, length, kNumbers[below(kNumbers.size())]);
}

void Mutator::put_word(std::string& bytes) {
  if (words_.empty()) return;
  const std::string& word = words_[below(words_.size())];
  std::size_t begin = below(bytes.size() + 1);
  while (begin < bytes.size() && !is_word_letter(bytes[begin])) ++begin;
  std::size_t end = begin;
  while (end < bytes.size() && is_word_letter(bytes[end])) ++end;
  if (below(4) == 0) {
    bytes.insert(begin, word + " ");
  } else {
    bytes.replace(begin, end - begin, word);
  }
}

}  // namespace tests
