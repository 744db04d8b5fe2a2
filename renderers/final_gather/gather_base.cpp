#include "renderers/final_gather/gather_base.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/element_hierarchy/solver_parameters.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

void GatherBase::prepare(const scene::Scene& scene, StageTimer& timer) {
  const base::ThreadLimit limit(devices_.threads);
  shown_.reset();
  vertices_.reset();
  solution_.reset();
  {
    const auto stage = timer.stage("build");
    rays_ =
        std::make_unique<ray_tracing::RayScene>(scene, timer, ray_tracing::RayQueries::all_hits);
  }
  const auto stage = timer.stage("transport");
  solution_ = element_hierarchy::solve_radiosity(*rays_, gather_settings_.solver, timer);
  if (!solution_) return;
  const auto inner = timer.stage("vertices");
  vertices_ = std::make_unique<element_hierarchy::PatchVertices>(*solution_->tree);
  shown_ = std::make_unique<element_hierarchy::ShownLight>(*solution_, *vertices_);
}

CameraSamples GatherBase::camera_samples(const RenderJob& job, StageTimer& timer) const {
  const auto stage = timer.stage("gather");
  const auto inner = timer.stage("borders");
  return CameraSamples(*rays_, job, gather_settings_.camera);
}

GatherPicture GatherBase::picture(const CameraSamples& samples, const RenderJob& job,
                                  const TransferSettings& transfer,
                                  const PointGather& gather) const {
  const element_hierarchy::CameraSurface surface(*rays_, shown_.get());
  const EnvironmentGather environment(*rays_, gather_settings_.environment_samples, transfer);
  return gather_picture({*rays_, solution_.get(), surface, environment}, samples, job, gather);
}

TransferSettings GatherBase::transfer_of(const RenderJob& job) const {
  TransferSettings transfer = gather_settings_.transfer;
  transfer.points.seed =
      ray_tracing::hash_combine(job.seed, static_cast<std::uint64_t>(job.frame_index) + 7);
  return transfer;
}

Frame GatherBase::frame_of(GatherPicture picture, const CameraSamples& samples,
                           const RenderJob& job) const {
  Frame frame;
  const auto pixels = static_cast<double>(samples.pixel_count());
  const auto camera = static_cast<double>(samples.total());
  const double solution_rays = solution_ ? static_cast<double>(solution_->record.rays) : 0.0;
  frame.counters = element_hierarchy::solution_counters(solution_.get());
  frame.counters.insert(
      frame.counters.end(),
      {{"visibility_samples", picture.visibility_rays},
       {"form_factor_samples", picture.form_factor_evaluations},
       {"visibility_samples_per_pixel", picture.visibility_rays / pixels},
       {"form_factor_samples_per_pixel", picture.form_factor_evaluations / pixels},
       {"visibility_samples_per_camera_ray", picture.visibility_rays / camera},
       {"form_factor_samples_per_camera_ray", picture.form_factor_evaluations / camera},
       {"camera_rays_per_pixel", camera / pixels},
       {"rays", picture.visibility_rays + solution_rays +
                    static_cast<double>(picture.other_rays + samples.rays_traced()) - camera}});
  frame.radiance = std::move(picture.radiance);
  for (perception::NamedImage& image : show_surfaces(*rays_, job)) {
    frame.aovs.push_back(std::move(image));
  }
  frame.aovs.push_back({"irradiance", std::move(picture.irradiance)});
  frame.aovs.push_back({"visibility_samples", std::move(picture.visibility_samples)});
  frame.aovs.push_back({"form_factor_samples", std::move(picture.form_factor_samples)});
  frame.aovs.push_back({"resampled", std::move(picture.resampled)});
  frame.aovs.push_back({"classes", std::move(picture.classes)});
  frame.aovs.push_back({"camera_rays", std::move(picture.camera_rays)});
  if (!solution_) frame.notes.push_back("no light reaches a surface");
  if (solution_ && !solution_->record.has_converged) {
    frame.notes.push_back("the radiosity solution has not converged; see counter residuals");
  }
  return frame;
}

std::vector<perception::NamedImage> show_surfaces(const ray_tracing::RayScene& rays,
                                                  const RenderJob& job) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  std::vector<perception::NamedImage> images;
  for (const char* name : {"albedo", "normal"}) {
    images.push_back({name, perception::make_rgb_image(job.width_px, job.height_px,
                                                       perception::Encoding::scene_linear)});
  }
  const auto width = static_cast<std::size_t>(job.width_px);
  const std::size_t pixels = images.front().image.pixel_count();
  base::parallel_for(pixels, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ray_tracing::Ray ray = camera.through(static_cast<float>(i % width) + 0.5F,
                                                  static_cast<float>(i / width) + 0.5F);
      ray_tracing::Hit hit;
      if (!rays.intersect(ray, hit)) continue;
      const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
      const glm::vec3 albedo = ray_tracing::diffuse_albedo(rays.scene(), hit);
      const glm::vec3 normal = side * hit.shading_normal;
      const auto at = static_cast<std::ptrdiff_t>(3 * i);
      std::copy_n(&albedo.x, 3, images[0].image.pixels.begin() + at);
      std::copy_n(&normal.x, 3, images[1].image.pixels.begin() + at);
    }
  });
  return images;
}

RendererInfo gather_info() {
  RendererInfo info;
  info.source =
      "Scheel, Stamminger, Seidel 2002, \"Grid Based Final Gather for Radiosity on Complex "
      "Clustered Scenes\", CGF 21(3)";
  info.claims = [](const base::Parameters&, const scene::Scene&) {
    return Claims{Transport::diffuse, Part::all, std::nullopt};
  };
  info.possible_claims = {{Transport::diffuse, Part::all, std::nullopt}};
  info.supports = {Feature::point_light, Feature::spot_light, Feature::area_light,
                   Feature::environment, Feature::texture,    Feature::glossy,
                   Feature::animation};
  info.uses_seed = true;
  return info;
}

}  // namespace renderers::final_gather
