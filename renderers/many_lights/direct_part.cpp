#include "renderers/many_lights/direct_part.h"

#include "renderers/ray_tracing/direct_light_pass.h"

namespace renderers::many_lights {

std::uint64_t add_direct_light(const ray_tracing::RayScene& rays, const RenderJob& job,
                               const PictureSettings& settings, const DirectPart& part,
                               perception::Image& sum) {
  ray_tracing::DirectLightSettings direct;
  direct.pixel_rays =
      settings.camera_rays > 1 ? ray_tracing::PixelRays::spread : ray_tracing::PixelRays::fixed;
  direct.offset_px = part.offset_px;
  direct.camera_rays = settings.camera_rays;
  direct.light_samples = settings.light_samples;
  const ray_tracing::DirectLightPass pass(rays, direct);
  const ray_tracing::DirectLight light =
      pass.render({job.width_px, job.height_px, job.camera, part.seed, part.set});
  if (sum.is_empty()) {
    sum =
        perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  }
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += light.radiance.pixels[i];
  return light.counts.rays();
}

}  // namespace renderers::many_lights
