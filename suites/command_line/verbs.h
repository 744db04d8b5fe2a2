#pragma once

#include "suites/command_line/console.h"
#include "suites/command_line/verb_arguments.h"

/// The verbs. Each returns an exit code of exit_codes.h and throws base::InputError,
/// base::DeviceError or suites::Interrupted for the rest.
namespace suites::command_line {

int run_list(const ListArguments& arguments, Console& console);
int run_check(const CheckArguments& arguments, Console& console);
int run_run(const RunArguments& arguments, Console& console);
int run_render(const RenderArguments& arguments, Console& console);
int run_diff(const DiffArguments& arguments, Console& console);
int run_thresholds(const ThresholdsArguments& arguments, Console& console);
int run_ref(const RefArguments& arguments, Console& console);
int run_report(const ReportArguments& arguments, Console& console);
int run_eval(const EvalArguments& arguments, Console& console);
int run_claims(const ClaimsArguments& arguments, Console& console);
int run_papers(const PapersArguments& arguments, Console& console);
int run_accept(const AcceptArguments& arguments, Console& console);
int run_compare(const CompareArguments& arguments, Console& console);
int run_figure(const FigureArguments& arguments, Console& console);
int run_view(const ViewArguments& arguments, Console& console);
int run_table(const TableArguments& arguments, Console& console);
int run_cheapest(const CheapestArguments& arguments, Console& console);
int run_history(const HistoryArguments& arguments, Console& console);
int run_bisect(const BisectArguments& arguments, Console& console);
int run_merge(const MergeArguments& arguments, Console& console);
int run_doctor(const DoctorArguments& arguments, Console& console);
int run_schema(const SchemaArguments& arguments, Console& console);
int run_completions(const CompletionsArguments& arguments, Console& console);
int run_man(const ManArguments& arguments, Console& console);
int run_probe_device(const ProbeDeviceArguments& arguments, Console& console);
int run_worker(const WorkerArguments& arguments, Console& console);

}  // namespace suites::command_line
