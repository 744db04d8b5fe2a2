#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace renderers {

/// `new_view`: a further render of the same scene state with another camera.
enum class Phase { prepare, update, render, new_view };
std::string to_string(Phase phase);

/// Which clock a stage's GPU or wall time was read from.
enum class StageClock { steady, finish, gpu_query };
std::string to_string(StageClock clock);

/// Time and traffic of one named span of work, summed over its calls.
struct StageRecord {
  Phase phase = Phase::prepare;
  std::string path;  ///< "build/bvh": nested stages, first name from the stage vocabulary
  double wall_s = 0.0;
  double cpu_s = 0.0;   ///< CPU time of the whole process in the span
  double gpu_s = -1.0;  ///< negative: not measured
  StageClock clock = StageClock::steady;
  std::int64_t calls = 0;
  std::int64_t bytes_cpu = 0;
  std::int64_t bytes_gpu = 0;
};

/// Collects stages. Used by one thread; stages nest.
///
///     auto stage = timer.stage("build");          // "build"
///     { auto inner = timer.stage("bvh"); ... }    // "build/bvh"
class StageTimer {
 public:
  class Stage {
   public:
    Stage(StageTimer& timer, std::string_view name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    void add_bytes(std::int64_t cpu, std::int64_t gpu = 0);
    /// Time on the device within this span and the clock it was read from; spans of one path must
    /// use one clock.
    void add_gpu_s(double gpu_s, StageClock clock);

   private:
    StageTimer& timer_;
    std::size_t record_;
    std::size_t parent_path_length_;
    double wall_start_s_;
    double cpu_start_s_;
  };

  [[nodiscard]] Stage stage(std::string_view name) { return Stage(*this, name); }

  /// Set by the harness before prepare, update and render.
  void set_phase(Phase phase) { phase_ = phase; }

  /// Records in order of first start.
  const std::vector<StageRecord>& records() const { return records_; }
  /// Sum of the top-level stages of a phase, seconds.
  double top_level_s(Phase phase) const;
  /// Wall time of one stage by path over all phases, seconds; 0 if it never ran.
  double wall_of(std::string_view path) const;

 private:
  friend class Stage;
  std::size_t open(std::string_view name);
  Phase phase_ = Phase::prepare;
  std::string open_path_;
  std::vector<StageRecord> records_;
};

/// Seconds of the steady clock.
double steady_seconds();
/// CPU seconds of this process, all threads.
double process_cpu_seconds();

}  // namespace renderers
