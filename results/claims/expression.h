#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "perception/base/errors.h"
#include "results/row_selector.h"

namespace results::claims {

struct Function;

/// A measure as it was parsed (README.md has the grammar).
struct Expression {
  enum class Kind {
    number,
    operation,  ///< `parts` joined by `sign`; of one part its negation
    call,       ///< `function` of `parts`
    rows,       ///< `selector`
    quantity,   ///< of every row: `name`
    condition   ///< the first part compared with `number`
  };
  Kind kind = Kind::number;
  double number = 0.0;
  char sign = '+';  ///< + - * /
  RowCondition::Relation relation = RowCondition::Relation::equal;
  const Function* function = nullptr;
  RowSelector selector;
  std::string name;  ///< of a quantity
  std::vector<Expression> parts;
  std::string text;          ///< as it was written
  std::size_t position = 0;  ///< in the whole text
};

/// @param place  of the text
/// @throws base::InputError with the place of the first character that is not accepted, and what is
Expression parse_expression(std::string_view text, const base::Place& place);

/// Whether it gives several values: a series that nothing makes one number of.
bool gives_list(const Expression& expression);

}  // namespace results::claims
