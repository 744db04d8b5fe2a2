#include "suites/checkpoint_writer.h"

#include <fmt/format.h>

#include "perception/image_file.h"
#include "suites/stage_sums.h"

namespace suites {

void CheckpointWriter::store(const perception::Image& radiance, std::int64_t samples) {
  const double now_s = renderers::steady_seconds();
  const auto stage = timer_.stage(kCheckpointStage);
  results::Checkpoint checkpoint;
  // The clock of total_s: neither this sink nor any readback so far is in it.
  const double read_s = readback_s(without_checkpoints(timer_.records()));
  checkpoint.elapsed_s = ready_s_ + now_s - start_s_ - spent_s_ - read_s;
  checkpoint.samples = samples;
  checkpoint.image = fmt::format("checkpoint-{:03}.exr", checkpoints_.size());
  perception::ImageFile file;
  file.parts.push_back({"radiance", radiance});
  file.attributes.number[perception::kLuminanceScaleAttribute] =
      request_.scene->luminance_scale_cd_m2;
  try {
    perception::write_exr(request_.checkpoint_folder / checkpoint.image, file);
    checkpoints_.push_back(std::move(checkpoint));
  } catch (const base::InputError& error) {
    storage_error_ = error.what();  // the folder's fault: the renderer goes on
  }
  spent_s_ += renderers::steady_seconds() - now_s;
}

}  // namespace suites
