#include <array>

#include "perception/base/errors.h"
#include "suites/suite_file.h"
#include "suites/worker_protocol.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/seed_files.h"

namespace tests {

namespace {

Seeds suites_of_the_catalog() {
  return files_of(suites::catalog_folder(),
                  {"quick.yaml", "nightly.yaml", "papers/convergence.yaml"});
}

void read_suite(const std::string& bytes) {
  suites::parse_suite(base::parse_document(bytes, "suite.yaml"), "suite.yaml", "");
}

Seeds worker_lines() {
  suites::OpenJob open;
  open.scene_file = "box.yaml";
  open.size_px = {64, 48};
  open.renderer = "path";
  open.preset = "best";
  open.parameters = {{"max_depth", base::ParameterValue(std::int64_t{8})}};
  suites::RenderOrder order;
  order.samples = 16;
  order.image = "images/frame.exr";
  suites::Rendered rendered;
  rendered.record.scene = "box";
  rendered.record.stages.resize(2);
  return {to_line(suites::Job(open)),
          to_line(suites::Job(order)),
          to_line(suites::Job(suites::CloseJob{})),
          to_line(suites::Reply(suites::Opened{0.1, "ab"})),
          to_line(suites::Reply(rendered)),
          to_line(suites::Reply(suites::Refused{"no"}))};
}

/// A line is a job or a reply; each reader must take the other's for what it is.
void read_worker_line(const std::string& bytes) {
  try {
    suites::job_from_line(bytes);
  } catch (const base::InputError&) {
    suites::reply_from_line(bytes);
  }
}

constexpr std::array kTargets{
    FuzzTarget{"suite", suites_of_the_catalog, read_suite},
    FuzzTarget{"worker-line", worker_lines, read_worker_line},
};

}  // namespace

std::span<const FuzzTarget> suite_targets() { return kTargets; }

}  // namespace tests
