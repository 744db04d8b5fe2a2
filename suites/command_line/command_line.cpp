#include "suites/command_line/command_line.h"

#include <filesystem>
#include <new>
#include <ostream>
#include <variant>

#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "renderers/contract/devices.h"
#include "results/run_record.h"
#include "suites/command_line/argument_parser.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/printable_text.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

namespace {

/// Calls the verb of the arguments' type.
struct Dispatch {
  Console& console;
  int operator()(const TextArguments& a) const {
    console.out << a.text;
    return kAsExpected;
  }
  int operator()(const ListArguments& a) const { return run_list(a, console); }
  int operator()(const CheckArguments& a) const { return run_check(a, console); }
  int operator()(const RunArguments& a) const { return run_run(a, console); }
  int operator()(const RenderArguments& a) const { return run_render(a, console); }
  int operator()(const DiffArguments& a) const { return run_diff(a, console); }
  int operator()(const ThresholdsArguments& a) const { return run_thresholds(a, console); }
  int operator()(const RefArguments& a) const { return run_ref(a, console); }
  int operator()(const ReportArguments& a) const { return run_report(a, console); }
  int operator()(const EvalArguments& a) const { return run_eval(a, console); }
  int operator()(const ClaimsArguments& a) const { return run_claims(a, console); }
  int operator()(const PapersArguments& a) const { return run_papers(a, console); }
  int operator()(const AcceptArguments& a) const { return run_accept(a, console); }
  int operator()(const CompareArguments& a) const { return run_compare(a, console); }
  int operator()(const ViewArguments& a) const { return run_view(a, console); }
  int operator()(const TableArguments& a) const { return run_table(a, console); }
  int operator()(const CheapestArguments& a) const { return run_cheapest(a, console); }
  int operator()(const HistoryArguments& a) const { return run_history(a, console); }
  int operator()(const BisectArguments& a) const { return run_bisect(a, console); }
  int operator()(const MergeArguments& a) const { return run_merge(a, console); }
  int operator()(const DoctorArguments& a) const { return run_doctor(a, console); }
  int operator()(const FigureArguments& a) const { return run_figure(a, console); }
  int operator()(const SchemaArguments& a) const { return run_schema(a, console); }
  int operator()(const CompletionsArguments& a) const { return run_completions(a, console); }
  int operator()(const ManArguments& a) const { return run_man(a, console); }
  int operator()(const ProbeDeviceArguments& a) const { return run_probe_device(a, console); }
  int operator()(const WorkerArguments& a) const { return run_worker(a, console); }
};

/// Says on the right stream why nothing came of it.
int fail(Console& console, bool as_json, int code, const std::string& reason) {
  if (as_json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", code == kInterrupted ? "interrupted" : "error"},
                         {"reason", reason},
                         {"exit_code", code}});
  } else {
    print_error(console, reason);
  }
  return code;
}

/// The library's own text names its function first.
std::string reason_of(const std::filesystem::filesystem_error& error) {
  return error.path1().string() + ": " + error.code().message();
}

int run_guarded(const std::vector<std::string>& words, Console& console) {
  const bool as_json = asks_for_json(words);
  try {
    VerbArguments arguments = parse_arguments(words);
    if (auto* run = std::get_if<RunArguments>(&arguments)) run->command = quoted_command(words);
    return std::visit(Dispatch{console}, arguments);
  } catch (const base::InputError& error) {
    return fail(console, as_json, kInputError, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(console, as_json, kInputError, reason_of(error));
  } catch (const Interrupted& error) {
    return fail(console, as_json, kInterrupted, error.what());
  } catch (const base::DeviceError& error) {
    return fail(console, as_json, kNothingMeasured, error.what());
  } catch (const renderers::DeviceMemoryError& error) {
    return fail(console, as_json, kNothingMeasured, std::string("out of memory: ") + error.what());
  } catch (const std::bad_alloc&) {
    return fail(console, as_json, kNothingMeasured, "out of memory");
  } catch (const std::exception& error) {
    return fail(console, as_json, kNothingMeasured, std::string("internal: ") + error.what());
  }
}

}  // namespace

int run_command_line(const std::vector<std::string>& words, Console& console) {
  handle_interrupts(asks_for_json(words) ? OnInterrupt::end_now_with_json : OnInterrupt::end_now);
  // Files of strangers name much of what a verb prints; JSON means the same.
  PrintableBuffer buffer(console.out);
  std::ostream out(&buffer);
  Console plain{out, console.err, console.err_is_terminal, console.err_has_color,
                console.err_columns};
  const int code = run_guarded(words, plain);
  out.flush();
  if (!out) {
    return fail(console, false, kInputError, "cannot write to the standard output");
  }
  return code;
}

}  // namespace suites::command_line
