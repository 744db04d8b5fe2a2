#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

/// What run.json says of any kind of run, as pieces of a page. Every text is escaped here.
namespace results::html_report {

/// An entry of a list of facts; "" for an empty value.
std::string fact(const char* name, const std::string& value);
/// "running, as of 2026-..."; "" for a run that is complete.
std::string state_text(const nlohmann::ordered_json& info);
/// Twelve digits, and whether there were local changes.
std::string commit_text(const nlohmann::ordered_json& info);

/// A row and a table of words; the cells and titles are HTML.
std::string word_row(const std::vector<std::string>& cells);
std::string word_table(const std::vector<std::string>& titles, const std::string& rows);

/// Everything known of the machine and the build.
std::string machine_table(const nlohmann::ordered_json& info);
/// The command line, and the resolved suite folded away.
std::string command_and_suite(const nlohmann::ordered_json& info,
                              const std::string& resolved_suite);

}  // namespace results::html_report
