#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "results/claims/evaluation.h"

namespace results::claims {

/// What an argument of a function is.
enum class ArgumentKind {
  rows,       ///< a row selector: val[vals=30]
  quantity,   ///< a name: next_frame_s
  formula,    ///< of every row: vals * faces
  axis,       ///< a formula, or a key whose values are texts: scene
  stages,     ///< a stage, or several with +
  condition,  ///< visible-difference < 0.02
  number,
  value,  ///< an expression
  values  ///< the same once or more often; the last one
};

/// A function of the language. A new one is a line of the table in function_table.cpp.
struct Function {
  std::string_view name;
  std::vector<ArgumentKind> arguments;
  const char* signature;
  const char* doc;
  Value (*evaluate)(const Expression& call, Evaluation& evaluation);
  double (*elementwise)(double) = nullptr;  ///< of a function of one value, instead of `evaluate`
  bool makes_list = false;                  ///< its value is a list
  bool reduces = false;                     ///< makes one number of lists
};

/// In the order to list them.
std::span<const Function> function_table();
/// Null if there is none of that name.
const Function* find_function(std::string_view name);

}  // namespace results::claims
