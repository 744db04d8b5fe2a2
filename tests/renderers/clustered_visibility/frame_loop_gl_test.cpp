#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "renderers/clustered_visibility/clustered_picture.h"
#include "renderers/clustered_visibility/clustered_visibility_settings.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/gl_functions.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

namespace cv = clustered_visibility;

/// Calls of the entry points that allocate on the device, compile, or read back.
struct Calls {
  int stores = 0;
  int programs = 0;
  int reads = 0;
};
Calls counted;
opengl::Functions real;

void APIENTRY count_create_buffers(GLsizei count, GLuint* ids) {
  ++counted.stores;
  real.CreateBuffers(count, ids);
}
void APIENTRY count_create_textures(GLenum target, GLsizei count, GLuint* ids) {
  ++counted.stores;
  real.CreateTextures(target, count, ids);
}
GLuint APIENTRY count_create_program() {
  ++counted.programs;
  return real.CreateProgram();
}
void APIENTRY count_read_buffer(GLuint id, GLintptr offset, GLsizeiptr size, void* data) {
  ++counted.reads;
  real.GetNamedBufferSubData(id, offset, size, data);
}
void APIENTRY count_read_texture(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                                 GLsizei height, GLsizei depth, GLenum format, GLenum type,
                                 GLsizei size, void* data) {
  ++counted.reads;
  real.GetTextureSubImage(id, level, x, y, z, width, height, depth, format, type, size, data);
}

/// Counts the calls of a context while this lives.
class CallCount {
 public:
  explicit CallCount(opengl::Context& context)
      : functions_(const_cast<opengl::Functions&>(context.use())) {
    counted = {};
    real = functions_;
    functions_.CreateBuffers = count_create_buffers;
    functions_.CreateTextures = count_create_textures;
    functions_.CreateProgram = count_create_program;
    functions_.GetNamedBufferSubData = count_read_buffer;
    functions_.GetTextureSubImage = count_read_texture;
  }
  ~CallCount() { functions_ = real; }
  CallCount(const CallCount&) = delete;
  CallCount& operator=(const CallCount&) = delete;

 private:
  opengl::Functions& functions_;
};

void draw_frame(cv::ClusteredPicture& picture, const scene::Scene& scene) {
  StageTimer timer;
  RenderJob job;
  job.width_px = job.height_px = 24;
  job.camera = scene.camera;
  picture.load(scene, timer);
  picture.make_lights(0.0, nullptr, timer);
  picture.draw(job, 0.0, nullptr, timer);
}

/// Calls of the third frame of a sequence in which an object and the light move.
Calls calls_of_a_later_frame(const std::shared_ptr<opengl::Context>& context,
                             const std::vector<std::string>& settings) {
  std::vector<std::string> all{"light_map_px=32", "shadow_map_px=32", "vpls=64",
                               "vals=6",          "part=indirect",    "terms=1"};
  all.insert(all.end(), settings.begin(), settings.end());
  const cv::Settings typed = cv::settings_of(parameters_of("clustered-visibility", all));
  cv::ClusteredPicture picture(context, typed);
  std::vector<scene::Scene> frames(3, spot_in_box());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const float shift = 0.05F * static_cast<float>(i);
    frames[i].lights.front().position.x += shift;
    frames[i].objects.back().to_world[3].x += shift;
  }
  draw_frame(picture, frames[0]);
  draw_frame(picture, frames[1]);
  {
    const CallCount count(*context);
    draw_frame(picture, frames[2]);
  }
  context->check("the frames");
  EXPECT_FALSE(picture.read_radiance().empty());
  return counted;
}

class FrameLoop : public GlTest {};

TEST_F(FrameLoop, AllocatesCompilesAndReadsNothing) {
  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {"visibility=cssm", "warm_start=true"},
           {"visibility=msm", "interleave=1"},
           {"visibility=pcf", "depth=hemicube"},
           {"visibility=cssm", "prefilter=sat"},
           {"visibility=hard", "depth=vertex", "cluster_sums=scatter", "bounces=2"}}) {
    const Calls calls = calls_of_a_later_frame(context(), settings);
    EXPECT_EQ(calls.stores, 0) << settings.front();
    EXPECT_EQ(calls.programs, 0) << settings.front();
    EXPECT_EQ(calls.reads, 0) << settings.front();
  }
}

TEST_F(FrameLoop, OfAnAdaptiveNumberReadsItsPreviewsAlone) {
  const Calls calls = calls_of_a_later_frame(context(), {"adaptive=true", "adaptive_tolerance=0"});
  EXPECT_EQ(calls.stores, 0);
  EXPECT_EQ(calls.reads, 2) << "of four and of six area lights";
}

}  // namespace
}  // namespace renderers::test
