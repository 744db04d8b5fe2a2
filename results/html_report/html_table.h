#pragma once

#include <string>

#include "results/tables.h"

namespace results::html_report {

/// A table that sorts by its titles, with its notes below. @param id  of the element
std::string html_table(const Table& table, const std::string& id);

/// Which way is better, as an arrow with words; "" for none.
const char* arrow_of(Direction better);

}  // namespace results::html_report
