#include "renderers/opengl/gpu_stage.h"

#include "renderers/opengl/gl_functions.h"

namespace renderers::opengl {

namespace {

/// So that the stage's clock starts on an idle device.
Context& finished(Context& context) {
  context.finish();
  return context;
}

constexpr double kNanosecond_s = 1e-9;

}  // namespace

GpuStage::GpuStage(Context& context, StageTimer& timer, std::string_view name)
    : context_(finished(context)), stage_(timer.stage(name)), start_s_(steady_seconds()) {
  if (context_.is_software()) return;
  const Functions& gl = context_.use();
  gl.CreateQueries(GL_TIMESTAMP, 2, queries_);
  gl.QueryCounter(queries_[0], GL_TIMESTAMP);
}

GpuStage::~GpuStage() {
  if (context_.is_software()) {
    context_.finish();
    stage_.add_gpu_s(steady_seconds() - start_s_, StageClock::finish);
    return;
  }
  const Functions& gl = context_.use();
  gl.QueryCounter(queries_[1], GL_TIMESTAMP);
  context_.finish();
  GLuint64 start_ns = 0;
  GLuint64 end_ns = 0;
  gl.GetQueryObjectui64v(queries_[0], GL_QUERY_RESULT, &start_ns);
  gl.GetQueryObjectui64v(queries_[1], GL_QUERY_RESULT, &end_ns);
  gl.DeleteQueries(2, queries_);
  stage_.add_gpu_s(kNanosecond_s * static_cast<double>(end_ns - start_ns), StageClock::gpu_query);
}

}  // namespace renderers::opengl
